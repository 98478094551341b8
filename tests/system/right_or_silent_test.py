"""The vehicle on maps of a part of its road, in good light and bad: its fixes are right, or there are none.

A fix is confidently wrong that is off by more than a metre and five of its own sigmas, in plan. The recordings
are skipped, saying so, where they are missing: they cannot be part of the project.
"""
import json
import math
import pathlib
import unittest

import commands
from commands import CLIENT, CommandTest, SHARED, STREET, rows_of, run

ALTER_DRIVE = pathlib.Path(__file__).parents[1] / "lab/laboratory/altered_drive.py"
PARTS = ((0.3, 0.7), (0.1, 0.5))  # of a mapping drive's frames
METRES_OF_A_DEGREE = 111_200  # of latitude
SPOILT = ("plain", "soft", "dark")



def off_m(fix, truth, origin):
    """Horizontal distance of a fix from the frame's true position, in the drive's local frame."""
    north_m = (float(fix["latitude_deg"]) - origin["latitude_deg"]) * METRES_OF_A_DEGREE
    east_m = ((float(fix["longitude_deg"]) - origin["longitude_deg"]) * METRES_OF_A_DEGREE *
              math.cos(math.radians(origin["latitude_deg"])))
    return math.hypot(east_m - float(truth["east_m"]), north_m - float(truth["north_m"]))


class RightOrSilent(CommandTest):
    def altered(self, drive, name, *words):
        folder = self.folder / name
        self.expect_done(run(ALTER_DRIVE, drive, folder, *words))
        return folder

    def drive_on_parts(self, map_drive, queries, kinds, tolerance_m):
        """How many fixes there were, on maps of the parts; none confidently wrong, most of them tracked."""
        fixes = 0
        for part in PARTS:
            name = f"{map_drive.name}-{part[0]:.0%}"
            mapped = self.altered(map_drive, name, "--part", *part)
            map_file = self.folder / f"{name}.map"
            self.expect_done(self.build(mapped, map_file))
            line = [(float(row["east_m"]), float(row["north_m"])) for row in rows_of(mapped / "trajectory.csv")]
            for query in queries:
                for kind in kinds:
                    drive = query if kind == "plain" else self.altered(
                        query, f"{query.name}-{name}-{kind}", "--spoil", kind)
                    fixes += self.drive_on_part(map_file, line, drive, f"{query.name} on {name}, {kind}", tolerance_m)
        return fixes

    def drive_on_part(self, map_file, line, drive, what, tolerance_m):
        out = self.folder / "fixes.csv"
        self.expect_done(run(CLIENT, "localize", "--map", map_file, "--drive", drive, "--out", out))
        origin = json.loads((drive / "drive.json").read_text(encoding="utf-8"))["origin"]
        located = on_map = tracked = 0
        beyond = set()
        for fix, truth in zip(rows_of(out), rows_of(drive / "trajectory.csv"), strict=True):
            here = (float(truth["east_m"]), float(truth["north_m"]))
            nearest_m = min(math.dist(here, point) for point in line)
            on_map += nearest_m < 3
            if nearest_m > 20:
                beyond.add(fix["status"])
            if not fix["latitude_deg"]:
                continue
            located += 1
            sigma_m = math.hypot(float(fix["sigma_m"]), float(fix["lateral_sigma_m"] or 0))
            wrong = off_m(fix, truth, origin) - tolerance_m > max(1, 5 * sigma_m)
            self.assertFalse(wrong, f"{what}: {fix['filename']} is {off_m(fix, truth, origin):.1f} m off at {sigma_m:.2f}")
            tracked += nearest_m < 3 and fix["status"] == "tracking"
        print(f"{what}: {tracked} of {on_map} frames on the map are tracked")
        self.assertGreaterEqual(tracked, 0.7 * on_map, what)
        self.assertNotIn("tracking", beyond, what)
        return located

    def test_in_the_opposite_direction_nothing_is_claimed(self):
        map_file, out = self.folder / "street.map", self.folder / "fixes.csv"
        self.expect_done(self.build(STREET / "street-map", map_file))
        self.expect_done(run(CLIENT, "localize", "--map", map_file, "--drive", STREET / "street-query-back", "--out", out))
        fixes = rows_of(out)
        self.assertGreater(len(fixes), 20)
        for fix in fixes:
            self.assertNotEqual(fix["status"], "tracking", fix)
            self.assertGreater(float(fix["sigma_m"] or "inf"), 1, fix)

    def test_a_street_of_which_a_part_is_mapped(self):
        self.assertGreater(self.drive_on_parts(STREET / "street-map", [STREET / "street-query"], ["plain"], 0), 10)

    @unittest.skipUnless((SHARED / "drives").is_dir(), f"there are no recorded drives in {SHARED / 'drives'}")
    def test_recordings_of_which_a_part_is_mapped(self):
        drives = SHARED / "drives"
        for name, kinds in (("kitti-00", SPOILT), ("kitti-05", ["plain"]), ("kitti-06", SPOILT)):
            queries = sorted(pathlib.Path(drives).glob(f"{name}-query*"))
            # A degree of latitude differs by 0.1 % from the one above, over 150 m.
            self.assertGreater(self.drive_on_parts(drives / f"{name}-map", queries, kinds, 0.5), 20)


commands.main() if __name__ == "__main__" else None
