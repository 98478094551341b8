"""Cameras with lenses, mounted beside the point whose positions are recorded: mapped and localized as a pinhole is."""
import json
import shutil
import unittest

from commands import CLIENT, MAPPER, SIMULATOR, CommandTest, rows_of, run

MOUNTING = {"forward_m": 1.2, "right_m": 0.3, "up_m": 0.2, "yaw_deg": 3, "pitch_deg": 0, "roll_deg": 0}
BROWN = {"model": "brown-conrady", "k1": -0.28, "k2": 0.07, "p1": 0.0005, "p2": -0.0003, "k3": 0}
# Of 120 m of this street a pinhole gives 4.1 and 5.3 mm.
MOST_M = 0.015


class Camera(CommandTest):
    def drives(self, *options):
        out = self.folder / "drives"
        self.expect_done(run(SIMULATOR, "--out", out, "--route", "street", "--length-m", 40, "--seed", 3,
                             "--camera-px", 400, 320, *options))
        return out / "street-map", out / "street-query"

    def evaluated(self, map_drive, query):
        file, out = self.folder / "street.map", self.folder / "out"
        built = run(MAPPER, "build", "--drive", map_drive, "--map", file)
        self.expect_done(built)
        self.expect_done(run(CLIENT, "evaluate", "--map", file, "--drive", query, "--out", out, "--method", "milepost"))
        summary, = json.loads((out / "summary.json").read_text())
        return summary, built.stderr

    def expect_exact(self, map_drive, query):
        summary, warnings = self.evaluated(map_drive, query)
        self.assertEqual(warnings, "")
        self.assertEqual(summary["localized_frames"], summary["frames"])
        self.assertLess(summary["mean_error_m"], MOST_M)
        self.assertLess(summary["mean_lateral_error_m"], MOST_M)
        self.assertLess(summary["mean_heading_error_deg"], 0.3)

    def without_lens(self, drive):
        """The same drive, said to be a pinhole's."""
        bare = self.folder / "bare" / drive.name
        shutil.copytree(drive, bare)
        description = json.loads((bare / "drive.json").read_text())
        del description["camera"]["distortion"]
        (bare / "drive.json").write_text(json.dumps(description))
        return bare

    def test_brown_conrady_on_a_mounting(self):
        map_drive, query = self.drives("--lens", BROWN["model"], "--distortion", *list(BROWN.values())[1:],
                                       "--mounting", *MOUNTING.values(), "--record-tilts")
        description = json.loads((map_drive / "drive.json").read_text())
        self.assertEqual({key: description["camera"]["distortion"][key] for key in BROWN}, BROWN)
        self.assertEqual(description["mounting"], MOUNTING)
        self.assertIn("pitch_deg", rows_of(map_drive / "trajectory.csv")[0])
        self.expect_exact(map_drive, query)
        summary, _ = self.evaluated(self.without_lens(map_drive), self.without_lens(query))
        self.assertGreater(summary["mean_error_m"], MOST_M)

    def test_fisheye(self):
        self.expect_exact(*self.drives("--lens", "kannala-brandt", "--distortion", -0.013, 0.02))


if __name__ == "__main__":
    unittest.main(verbosity=2)
