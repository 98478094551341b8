"""A map is accepted by surveyed marks: points of the simulated street, whose camera poses are exact, with the places where
images show them."""
import json
import math
import pathlib
import re
import subprocess
import tempfile
import unittest

from commands import MAPPER, SIMULATOR, edit_lines, run
from recorded_street import RecordedStreet, converted

AHEAD_M = (5, 20)  # of a mark, in the frames that see it
SIGHTS = re.compile(r"check points: (\d+) of (\d+) placed, off by ([0-9.]+) m in plan and ([0-9.]+) m upwards "
                    r"\(root mean squares\), at most ([0-9.]+) m in plan: (\w+) by ([\w-]+)\n")


def in_camera(mark_m, pose, row):
    """Right, down and ahead of the camera (FRAMES.md 7)."""
    east, north, up = (a - b for a, b in zip(mark_m, pose.enu_m))
    h, p, r = (math.radians(angle) for angle in (pose.heading_deg, float(row["pitch_deg"]), float(row["roll_deg"])))
    right, down, ahead = east * math.cos(h) - north * math.sin(h), -up, east * math.sin(h) + north * math.cos(h)
    down, ahead = down * math.cos(p) + ahead * math.sin(p), -down * math.sin(p) + ahead * math.cos(p)
    return right * math.cos(r) + down * math.sin(r), -right * math.sin(r) + down * math.cos(r), ahead


class Acceptance(RecordedStreet):
    @classmethod
    def setUpClass(cls):
        rendered = tempfile.TemporaryDirectory()
        cls.addClassCleanup(rendered.cleanup)
        subprocess.run([SIMULATOR, "--out", rendered.name, "--drive", "street-map", "--length-m", "60", "--seed", "3",
                        "--camera-px", "480", "400", "--record-tilts"], check=True, stdout=subprocess.DEVNULL)
        cls.source = pathlib.Path(rendered.name) / "street-map"

    def setUp(self):
        super().setUp()
        self.file = self.folder / "street.map"
        self.marks = []
        for number, place in enumerate(self.at_frames[8:-8:6]):
            h = math.radians(place.heading_deg)
            side = 4 if number % 2 else -4
            self.marks.append((f"M{number}", [place.enu_m[0] + side * math.cos(h), place.enu_m[1] - side * math.sin(h),
                                              place.enu_m[2] + 1]))

    def sights(self, mark_m):
        """File name and pixel in each frame that the mark is ahead of."""
        (fx, fy), (cx, cy) = self.description["camera"]["focal_px"], self.description["camera"]["principal_px"]
        width, height = self.description["camera"]["width_px"], self.description["camera"]["height_px"]
        for row, pose in zip(self.rows, self.at_frames):
            right, down, ahead = in_camera(mark_m, pose, row)
            if AHEAD_M[0] < ahead < AHEAD_M[1]:
                x, y = cx + fx * right / ahead, cy + fy * down / ahead
                if 0 <= x < width and 0 <= y < height:
                    yield row["filename"], x, y

    def table_of(self, header, position_of):
        lines = [f"mark,{header},filename,x_px,y_px"]
        for name, mark_m in self.marks:
            for filename, x, y in self.sights(mark_m):
                lines.append(f"{name},{position_of(mark_m)},{filename},{x:.3f},{y:.3f}")
        file = self.folder / "marks.csv"
        file.write_text("\n".join(lines) + "\n")
        return file

    def degrees(self, mark_m):
        (longitude, latitude, height), = converted([mark_m], *self.degrees_from_enu)
        return f"{latitude:.11f},{longitude:.11f},{height:.5f}"

    def degrees_table(self):
        return self.table_of("latitude_deg,longitude_deg,altitude_m", self.degrees)

    def told(self, result):
        self.expect_done(result)
        found = SIGHTS.search(result.stdout)
        self.assertIsNotNone(found, result.stdout)
        return found

    def test_an_exact_map_has_the_marks_where_they_are(self):
        table = self.degrees_table()
        found = self.told(self.build(self.source, self.file, "--check-points", table, "--max-check-m", 0.05))
        self.assertEqual(found[1], found[2])
        self.assertEqual(int(found[1]), len(self.marks))
        self.assertLess(float(found[3]), 0.05)
        self.assertLess(float(found[4]), 0.02)
        told = json.loads(self.build(self.source, self.file, "--check-points", table, "--json").stdout)["check_points"]
        self.assertEqual([point["mark"] for point in told], [name for name, _ in self.marks])
        off_m = [math.hypot(point["east_m"], point["north_m"]) for point in told]
        self.assertAlmostEqual(max(off_m), float(found[5]), delta=1e-3)
        self.assertEqual(told[off_m.index(max(off_m))]["mark"], found[6])
        self.expect_done(run(MAPPER, "verify", "--map", self.file))

    def test_marks_of_another_reference_system(self):
        def utm(mark_m):
            result = subprocess.run(["cs2cs", "-d", "5", "EPSG:4979", "EPSG:32632"], input=self.degrees(mark_m).replace(",", " "),
                                    capture_output=True, text=True, check=True)
            return ",".join(result.stdout.split()[:3])
        table = self.table_of("x,y,z", utm)
        found = self.told(self.build(self.source, self.file, "--check-points", table, "--check-crs", "EPSG:32632"))
        self.assertLess(float(found[3]), 0.05)
        self.assertLess(float(found[4]), 0.02)

    def test_a_drive_that_is_off_is_refused(self):
        table = self.degrees_table()
        drive = self.copy_of(self.source)

        def east(line):
            cells = line.split(",")
            cells[2] = str(float(cells[2]) + 0.3)
            return ",".join(cells)
        edit_lines(drive / "trajectory.csv", lambda lines: lines.__setitem__(slice(1, None), [east(line) for line in lines[1:]]))
        found = self.told(self.build(drive, self.file, "--check-points", table))
        self.assertAlmostEqual(float(found[3]), 0.3, delta=0.02)
        old = self.file.read_bytes()
        self.expect_refused(self.build(drive, self.file, "--check-points", table, "--max-check-m", 0.1), 1, "street.map",
                            "max-check-m", "M")
        self.assertEqual(self.file.read_bytes(), old)

    def test_wrong_calls(self):
        table = self.degrees_table()
        self.expect_refused(self.build(self.source, self.file, "--max-check-m", 0.1), 2, "--check-points")
        self.expect_refused(self.build(self.source, self.file, "--check-points", self.folder / "none.csv"), 1, "none.csv")
        table.write_text(table.read_text().replace("M0,", "M0,9", 1))
        self.expect_refused(self.build(self.source, self.file, "--check-points", table), 1, "marks.csv, line 2")
        self.assertFalse(self.file.exists())


if __name__ == "__main__":
    unittest.main(verbosity=2)
