"""Global localization without a GNSS receiver: footprints -> walls -> server -> client, on the simulated street."""
import json
import math
import re

import commands
from commands import CLIENT, CommandTest, MAPPER, SIMULATOR, STREET, Server, report_data, rows_of, run

COLUMNS = ["timestamp_s", "filename", "status", "latitude_deg", "longitude_deg", "heading_deg", "sigma_m", "latency_ms"]
MORE_COLUMNS = ["mass", "explained"]
FOUND = {"tracking", "predicted"}
M_PER_DEG = 111200


class Find(CommandTest):
    def setUp(self):
        super().setUp()
        self.maps = self.folder / "maps"
        self.maps.mkdir()
        self.map = self.maps / "street.map"
        self.footprints = self.folder / "walls.geojson"
        self.query = STREET / "street-query"
        self.fixes = self.folder / "found.csv"
        # The town of the street drives.
        self.expect_done(run(SIMULATOR, "--seed", 3, "--walls", self.footprints))

    def make_walls(self):
        self.expect_done(run(MAPPER, "aerial", "--footprints", self.footprints, "--map", self.map))

    def find(self, *words):
        return run(CLIENT, "find", "--drive", self.query, "--out", self.fixes, *words)

    def truth(self):
        """Latitude, longitude and heading of every frame: the simulator's drives share one local origin."""
        drive = json.loads((self.query / "drive.json").read_text())
        origin = drive["origin"]
        east_m_per_deg = M_PER_DEG * math.cos(math.radians(origin["latitude_deg"]))
        return [(origin["latitude_deg"] + float(row["north_m"]) / M_PER_DEG,
                 origin["longitude_deg"] + float(row["east_m"]) / (east_m_per_deg * 1.0023), float(row["heading_deg"]))
                for row in rows_of(self.query / "trajectory.csv")]

    def with_datum(self, name, datum):
        drive = self.copy_of(STREET / name, name)
        description = json.loads((drive / "drive.json").read_text())
        (drive / "drive.json").write_text(json.dumps({**description, "datum": datum}))
        return drive

    def errors_m(self, rows):
        errors = []
        for row, (latitude, longitude, _) in zip(rows, self.truth()):
            north = (float(row["latitude_deg"]) - latitude) * M_PER_DEG
            east = (float(row["longitude_deg"]) - longitude) * M_PER_DEG * math.cos(math.radians(latitude))
            errors.append(math.hypot(north, east))
        return errors

    def start_words(self):
        latitude, longitude, heading = self.truth()[0]
        return ["--start", f"{latitude:.7f},{longitude:.7f}", "--start-sigma-m", 1, "--start-heading-deg", heading]

    def test_a_known_start_is_kept_and_the_table_is_as_designed(self):
        self.make_walls()
        self.expect_done(self.find("--map", self.map, *self.start_words()))
        rows = rows_of(self.fixes)
        self.assertEqual(list(rows[0]), COLUMNS + MORE_COLUMNS)
        drive_rows = rows_of(self.query / "trajectory.csv")
        self.assertEqual([row["filename"] for row in rows], [row["filename"] for row in drive_rows])
        errors = self.errors_m(rows)
        self.assertLess(sum(errors) / len(errors), 4)
        found = [error for error, row in zip(errors, rows) if row["status"] in FOUND]
        self.assertTrue(found, "the vehicle was not found")
        self.assertLess(max(found), 6)
        for row, (_, _, heading) in zip(rows, self.truth()):
            if row["status"] in FOUND:
                self.assertLess(abs((float(row["heading_deg"]) - heading + 180) % 360 - 180), 6)

    def test_the_server_gives_what_the_file_gives(self):
        self.make_walls()
        self.expect_done(self.find("--map", self.map, *self.start_words()))
        names = [name for name in COLUMNS + MORE_COLUMNS if name != "latency_ms"]
        from_file = [[row[name] for name in names] for row in rows_of(self.fixes)]
        with Server(self.maps) as server:
            cache = self.folder / "cache"
            self.expect_done(self.find("--server", server.url, "--cache", cache, *self.start_words()))
        from_server = [[row[name] for name in names] for row in rows_of(self.fixes)]
        self.assertEqual(from_server, from_file)

    def test_what_is_found_starts_the_route_localizer(self):
        self.expect_done(self.build(self.with_datum("street-map", "ITRF2014@2020.5"), self.map))
        self.make_walls()
        localized = self.folder / "localized.csv"
        found = self.find("--map", self.map, *self.start_words(), "--localize-out", localized)
        self.expect_done(found)
        self.assertRegex(found.stdout, r" frames tracked, positions of ITRF2014@2020.5\n$")
        rows = rows_of(localized)
        found = [row["status"] in FOUND for row in rows_of(self.fixes)]
        self.assertIn(True, found)
        first = found.index(True)
        self.assertTrue(all(row["along_m"] == "" for row in rows[:first]))
        tracked = [row for row in rows if row["status"] == "tracking"]
        self.assertGreater(len(tracked), 3)
        for row in tracked[1:]:
            self.assertLess(float(row["sigma_m"]), 0.3)
        # A report compares with the recorded positions, which are of another datum.
        self.query = self.with_datum("street-query", "ETRF2000")
        self.expect_refused(self.find("--map", self.map, "--report", self.folder / "report.html"), 1,
                            "of ETRF2000, those of map 'street' of ITRF2014@2020.5")

    def test_the_report_is_a_page_of_its_own(self):
        self.make_walls()
        report = self.folder / "report.html"
        self.expect_done(self.find("--map", self.map, "--report", report, *self.start_words()))
        page = report.read_text()
        self.assertTrue(page.startswith("<!DOCTYPE html>"), page[:40])
        data = report_data(page)
        self.assertEqual(data["title"], "street-query")
        self.assertEqual(len(data["columns"]["error_m"]), len(self.truth()))
        self.assertEqual(re.findall(r'(?:src|href)="|http://(?!www.w3.org/2000/svg)', page), [])

    def test_walls_across_180_are_as_good_as_others(self):
        town = json.loads(self.footprints.read_text())
        middle = self.truth()[len(self.truth()) // 2][1]

        def moved(coordinates):
            if isinstance(coordinates[0], list):
                return [moved(part) for part in coordinates]
            return [coordinates[0] - middle + 180, *coordinates[1:]]

        for feature in town["features"]:
            feature["geometry"]["coordinates"] = moved(feature["geometry"]["coordinates"])
        self.footprints.write_text(json.dumps(town))
        self.make_walls()
        words = self.start_words()
        latitude, longitude, _ = self.truth()[0]
        words[1] = f"{latitude:.7f},{(longitude - middle) % 360 - 180:.7f}"
        self.expect_done(self.find("--map", self.map, "--report", self.folder / "report.html", *words))
        rows = rows_of(self.fixes)
        sides = {float(row["longitude_deg"]) > 0 for row in rows}
        self.assertEqual(sides, {True, False})
        for row in rows:
            row["longitude_deg"] = (float(row["longitude_deg"]) + 360) % 360 - 180 + middle
        errors = self.errors_m(rows)
        self.assertLess(sum(errors) / len(errors), 4)

    def test_all_walls_of_a_map_across_180_are_looked_at(self):
        rings = [[[[east, -16.5], [east + 1e-5, -16.5], [east, -16.4999], [east, -16.5]]]
                 for east in (179.98, 179.9999, -179.9999, -179.98)]
        self.footprints.write_text(json.dumps({"type": "MultiPolygon", "coordinates": rings}))
        self.make_walls()
        self.expect_done(self.find("--map", self.map, "--particles", 1000, "--method", "orientations"))
        self.assertGreater(float(rows_of(self.fixes)[0]["sigma_m"]), 500)  # of a belief over 4 km

    def test_the_papers_method_runs_too(self):
        self.make_walls()
        self.expect_done(self.find("--map", self.map, "--method", "orientations", "--particles", 300, *self.start_words()))
        self.assertEqual(len(rows_of(self.fixes)), len(self.truth()))

    def test_no_walls_and_no_odometry_are_told_in_a_line(self):
        self.expect_done(self.build(STREET / "street-map", self.map))
        result = self.find("--map", self.map)
        self.expect_refused(result, 1, "no map has the layer walls")
        self.make_walls()
        result = self.find("--map", self.map, "--area", "1,1,1.1,1.1")
        self.expect_refused(result, 1, "there are no walls in the area")
        result = self.find("--map", self.map, "--map-name", "town")
        self.expect_refused(result, 1, "no map 'town' with walls, but street")
        copy = self.copy_of(self.query)
        (copy / "odometry.csv").unlink()
        result = run(CLIENT, "find", "--drive", copy, "--map", self.map, "--out", self.fixes)
        self.expect_refused(result, 1, "odometry.csv: the drive has no odometry")

    def test_wrong_words_are_refused(self):
        for words in (["--map", "m", "--particles", 0], ["--map", "m", "--method", "stars"], ["--map", "m", "--area", "1,2,3"],
                      ["--map", "m", "--start-sigma-m", 3], ["--map", "m", "--start", "91,8"],
                      ["--map", "m", "--start", "nan,8"], []):
            self.assertEqual(self.find(*words).returncode, 2, words)
        for words, message in ((["--area", "9,49,8,50"], "--area: not a box"),
                               (["--area", "179.9,-17,-179.9,-16"], "across longitude 180"), (["--area", "8,49,9,nan"], "--area: not a box"),
                               (["--area", "8,49,9,50", "--start", "49.5,7.9"], "--start: lies outside of --area"),
                               (["--area", "8,49,9,50", "--start", "48.9,8.5"], "--start: lies outside of --area")):
            self.expect_refused(self.find("--map", "m", *words), 2, message)


commands.main() if __name__ == "__main__" else None
