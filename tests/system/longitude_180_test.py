"""A road across longitude 180 is mapped, served, localized on and exported like any other."""
import csv
import json

import commands
from commands import CLIENT, CommandTest, MAPPER, STREET, Server, edit_json, rows_of, run


def wrapped(longitude_deg):
    return (longitude_deg + 180) % 360 - 180


class Longitude180(CommandTest):
    def moved(self, name, by_deg):
        """A copy of a drive of the street, moved to the east."""
        drive = self.copy_of(STREET / name, name)

        def move(description):
            origin = description["origin"]
            origin["longitude_deg"] = wrapped(origin["longitude_deg"] + by_deg)
        edit_json(drive / "drive.json", move)
        gps = drive / "gps.csv"
        if gps.exists():
            rows = rows_of(gps)
            for row in rows:
                row["longitude_deg"] = repr(wrapped(float(row["longitude_deg"]) + by_deg))
            with open(gps, "w", newline="") as table:
                writer = csv.DictWriter(table, rows[0].keys(), lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows)
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
        self.expect_done(self.build(STREET / "street-map", here))
        longitudes = [position[0] for position in self.roads(here)["coordinates"]]
        self.assertGreater(max(longitudes) - min(longitudes), 1e-5, "the street runs along a meridian")
        by_deg = 180 - (max(longitudes) + min(longitudes)) / 2

        maps = self.folder / "maps"
        maps.mkdir()
        there = maps / "there.map"
        self.expect_done(self.build(self.moved("street-map", by_deg), there))
        geometry = self.roads(there)
        self.assertEqual(geometry["type"], "MultiLineString")
        west, east = geometry["coordinates"]
        self.assertEqual(abs(west[-1][0]), 180)
        self.assertEqual(east[0][0], -west[-1][0])
        self.assertEqual(east[0][1:], west[-1][1:])

        expected = self.localized(STREET / "street-query", "--map", here)
        query = self.moved("street-query", by_deg)
        with Server(maps) as server:
            served = self.localized(query, "--server", server.url, "--cache", self.folder / "cache")
        for fixes in (self.localized(query, "--map", there), served):
            self.assertEqual(len(fixes), len(expected))
            for fix, other in zip(fixes, expected):
                self.assertEqual(fix["status"], other["status"])
                if other["along_m"]:
                    self.assertAlmostEqual(float(fix["along_m"]), float(other["along_m"]), delta=0.01)
                    self.assertAlmostEqual(wrapped(float(fix["longitude_deg"]) - by_deg), float(other["longitude_deg"]),
                                           delta=1e-6)


commands.main() if __name__ == "__main__" else None
