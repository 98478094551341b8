"""A road across longitude 180 is mapped, served, localized on and exported like any other."""
import csv
import json
import math

import commands
from commands import CLIENT, CommandTest, MAPPER, STREET, Server, edit_json, rows_of, run

METRES_A_DEGREE = 111200  # of latitude


def wrapped(longitude_deg):
    return (longitude_deg + 180) % 360 - 180


def rewrite(table, change):
    """Changes each row of a table."""
    rows = rows_of(table)
    for row in rows:
        change(row)
    with open(table, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


class Longitude180(CommandTest):
    def eastward(self, name, folder, origin_deg):
        """A copy of a drive of the street, which runs north, that runs east from longitude `origin_deg`."""
        drive = self.copy_of(STREET / name, folder)
        origin = json.loads((drive / "drive.json").read_text())["origin"]
        edit_json(drive / "drive.json", lambda description: description["origin"].update(longitude_deg=origin_deg))

        def turn(row):
            east_m, north_m = float(row["east_m"]), float(row["north_m"])
            row.update(east_m=repr(north_m), north_m=repr(-east_m), heading_deg=repr(float(row["heading_deg"]) + 90))
        rewrite(drive / "trajectory.csv", turn)

        def turn_fix(row):
            shrink = math.cos(math.radians(origin["latitude_deg"]))
            east_m = (float(row["longitude_deg"]) - origin["longitude_deg"]) * METRES_A_DEGREE * shrink
            north_m = (float(row["latitude_deg"]) - origin["latitude_deg"]) * METRES_A_DEGREE
            row["latitude_deg"] = repr(origin["latitude_deg"] - east_m / METRES_A_DEGREE)
            row["longitude_deg"] = repr(wrapped(origin_deg + north_m / METRES_A_DEGREE / shrink))
        if (drive / "gps.csv").exists():
            rewrite(drive / "gps.csv", turn_fix)
        return drive

    def localized(self, drive, *source):
        out = self.folder / "fixes.csv"
        self.expect_done(run(CLIENT, "localize", *source, "--drive", drive, "--out", out))
        return rows_of(out)

    def roads(self, map_file):
        out = self.folder / "roads.geojson"
        self.expect_done(run(MAPPER, "export", "--map", map_file, "--layer", "segments", "--geojson", out))
        return json.loads(out.read_text())["features"][0]["geometry"]

    def test_a_street_across_it(self):
        here = self.folder / "here.map"
        self.expect_done(self.build(self.eastward("street-map", "map-here", 8), here))
        line = self.roads(here)
        self.assertEqual(line["type"], "LineString")
        middle_deg = (line["coordinates"][0][0] + line["coordinates"][-1][0]) / 2
        start_deg = wrapped(180 - (middle_deg - 8))

        maps = self.folder / "maps"
        maps.mkdir()
        there = maps / "there.map"
        self.expect_done(self.build(self.eastward("street-map", "map-there", start_deg), there))
        cut = self.roads(there)
        self.assertEqual(cut["type"], "MultiLineString")
        before, after = cut["coordinates"]
        self.assertEqual(before[-1][0], 180)
        self.assertEqual(after[0], [-180] + before[-1][1:])

        expected = self.localized(self.eastward("street-query", "query-here", 8), "--map", here)
        self.assertIn("tracking", [fix["status"] for fix in expected])
        query = self.eastward("street-query", "query-there", start_deg)
        with Server(maps) as server:
            served = self.localized(query, "--server", server.url, "--cache", self.folder / "cache")
        for fixes in (self.localized(query, "--map", there), served):
            self.assertEqual([fix["status"] for fix in fixes], [fix["status"] for fix in expected])
            for fix, other in zip(fixes, expected):
                if other["along_m"]:
                    self.assertAlmostEqual(float(fix["along_m"]), float(other["along_m"]), delta=0.02)
                    self.assertAlmostEqual(wrapped(float(fix["longitude_deg"]) - start_deg),
                                           float(other["longitude_deg"]) - 8, delta=1e-6)


commands.main() if __name__ == "__main__" else None
