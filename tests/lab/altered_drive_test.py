"""Each alteration of a drive changes what it says and nothing else."""
import csv
import io
import json
import math
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import numpy as np
from PIL import Image

from laboratory.runs import ALTER_DRIVE
from made_up import write_drive


def rows_of(path):
    with path.open(newline="") as table:
        return list(csv.DictReader(table))


def jpeg(grey):
    stream = io.BytesIO()
    Image.fromarray(np.asarray(grey, np.uint8)).save(stream, "JPEG", quality=95)
    return stream.getvalue()


def board():
    """Squares of 8 pixels, dark and light."""
    rows, columns = np.indices((64, 96)) // 8
    return np.where((rows + columns) % 2, 180, 60)


class AlteredDrive(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.query = self.folder / "query"

    def altered(self, *arguments):
        out = self.folder / "out"
        subprocess.run([ALTER_DRIVE, self.query, out, *map(str, arguments)], check=True)
        return out

    def description(self, drive):
        return json.loads((drive / "drive.json").read_text())

    def test_poses_recorded_worse_change_only_what_they_name(self):
        write_drive(self.query, frames=200, step_m=1.7)
        before = rows_of(self.query / "trajectory.csv")
        changes = {"heading": {"heading_deg": 5}, "altitude": {"up_m": 1}, "position": {"east_m": 0.3, "north_m": 0.3, "up_m": 0.3}}
        for kind, sigmas in changes.items():
            after = rows_of(self.altered("--record", kind) / "trajectory.csv")
            for name in before[0]:
                if name not in sigmas:
                    self.assertEqual([row[name] for row in after], [row[name] for row in before], (kind, name))
                    continue
                off = np.array([float(a[name]) - float(b[name]) for a, b in zip(after, before)])
                self.assertAlmostEqual(off.std() / sigmas[name], 1, delta=0.2, msg=(kind, name))
            shutil.rmtree(self.folder / "out")

    def test_five_decimals_of_a_degree_are_about_a_metre(self):
        write_drive(self.query, frames=200, step_m=1.7)
        out = self.altered("--record", "decimals")
        self.assertEqual(self.description(out)["frame"], "geographic")
        self.assertNotIn("origin", self.description(out))
        off_m = [float(row["latitude_deg"]) * 110574 - 1.7 * i for i, row in enumerate(rows_of(out / "trajectory.csv"))]
        self.assertLess(np.abs(off_m).max(), 0.56)
        self.assertAlmostEqual(np.std(off_m), 1.1 / math.sqrt(12), delta=0.05)

    def test_every_fifth_frame(self):
        write_drive(self.query, frames=23)
        out = self.altered("--record", "fifth")
        self.assertEqual([row["filename"] for row in rows_of(out / "trajectory.csv")],
                         ["0.jpg", "5.jpg", "10.jpg", "15.jpg", "20.jpg"])
        self.assertEqual(len(list((out / "frames").iterdir())), 5)

    def test_calibration_only_the_camera_is_another(self):
        write_drive(self.query)
        before = (self.query / "drive.json").read_text()
        out = self.altered("--yaw-deg", 2, "--focal-factor", 1.05)
        camera = self.description(out)["camera"]
        self.assertEqual(camera["focal_px"], [420, 210])
        x_px, y_px = camera["principal_px"]
        self.assertAlmostEqual(x_px, 300 + 420 * math.tan(math.radians(2)))
        self.assertEqual((y_px, camera["width_px"], self.description(out)["name"]), (250, 600, "a"))
        for name in ("frames/0.jpg", "trajectory.csv", "gps.csv", "odometry.csv"):
            self.assertEqual((out / name).read_bytes(), (self.query / name).read_bytes(), name)
        self.assertEqual((self.query / "drive.json").read_text(), before)

    def test_a_part_has_its_frames_only(self):
        write_drive(self.query, frames=10)
        out = self.altered("--part", 0.3, 0.7)
        names = [row["filename"] for row in rows_of(out / "trajectory.csv")]
        self.assertEqual(names, ["3.jpg", "4.jpg", "5.jpg", "6.jpg"])
        self.assertEqual(sorted(each.name for each in (out / "frames").iterdir()), names)

    def test_after_a_leap_times_go_on_and_the_receiver_is_silent(self):
        write_drive(self.query, frames=60)
        out = self.altered("--leap-m", 10)
        frames = rows_of(out / "trajectory.csv")
        north_m = np.array([float(row["north_m"]) for row in frames])
        time_s = np.array([float(row["timestamp_s"]) for row in frames])
        leap = int(np.argmax(np.diff(north_m)))
        self.assertEqual(leap, 20)
        # 50 m/s beyond the vehicle's own 10 m/s are not exceeded, whatever the leap.
        self.assertAlmostEqual(time_s[leap + 1] - time_s[leap], 0.2)
        self.assertAlmostEqual(north_m[leap + 1] - north_m[leap], 10 + 2)
        np.testing.assert_allclose(np.delete(np.diff(time_s), leap), 0.1, atol=1e-9)
        np.testing.assert_allclose(np.delete(np.diff(north_m), leap), 1)
        self.assertEqual(len(rows_of(out / "gps.csv")), 1)
        np.testing.assert_allclose([float(row["timestamp_s"]) for row in rows_of(out / "odometry.csv")], time_s)

    def test_a_leap_beyond_the_end_ends_before_it(self):
        write_drive(self.query, frames=30)
        frames = rows_of(self.altered("--leap-m", 100) / "trajectory.csv")
        self.assertEqual([row["filename"] for row in frames[-6:]], [f"{index}.jpg" for index in range(24, 30)])
        self.assertEqual(len(frames), 11 + 6)

    def test_laid_onto_another_road_the_images_stay(self):
        write_drive(self.query, frames=30)
        write_drive(self.folder / "other", frames=10, step_m=7)
        description = {**self.description(self.query), "origin": {"latitude_deg": 40, "longitude_deg": 8, "altitude_m": 5}}
        (self.folder / "other/drive.json").write_text(json.dumps(description))
        out = self.altered("--onto", self.folder / "other")
        self.assertEqual(self.description(out)["origin"]["latitude_deg"], 40)
        frames, receiver = rows_of(out / "trajectory.csv"), rows_of(out / "gps.csv")
        self.assertEqual([row["filename"] for row in frames], [f"{index}.jpg" for index in range(30)])
        self.assertEqual([row["north_m"] for row in frames[::3]], [f"{7 * index:.3f}" for index in range(10)])
        self.assertEqual([row["timestamp_s"] for row in receiver], ["0.0000", "1.0000", "2.0000"])
        self.assertAlmostEqual(float(receiver[2]["latitude_deg"]), 40 + 42 / 111_200, places=6)

    def test_each_kind_spoils_in_its_own_way(self):
        write_drive(self.query, images=[jpeg(board())])
        spoilt = {}
        for kind in ("blur", "soft", "noise", "half", "dark"):
            self.folder = self.folder / kind
            self.folder.mkdir()
            out = self.altered("--spoil", kind)
            with Image.open(out / "frames/0.jpg") as image:
                spoilt[kind] = np.asarray(image, float)
            self.assertEqual((out / "trajectory.csv").read_bytes(), (self.query / "trajectory.csv").read_bytes())
            camera = self.description(out)["camera"]
            self.assertEqual(camera["width_px"], 300 if kind == "half" else 600)
        self.assertEqual({kind: image.shape for kind, image in spoilt.items() if image.shape != (64, 96)}, {"half": (32, 48)})
        self.assertEqual((camera["focal_px"], camera["principal_px"]), ([400, 200], [300, 250]))
        plain = board()
        self.assertAlmostEqual(spoilt["dark"].mean(), plain.mean() / 3, delta=1)
        for kind in ("blur", "soft", "noise"):
            self.assertAlmostEqual(spoilt[kind].mean(), plain.mean(), delta=2)
        self.assertGreater(np.abs(spoilt["noise"] - plain).mean(), 6)
        across, down = (np.abs(np.diff(spoilt["blur"], axis=axis)).max() for axis in (1, 0))
        self.assertLess(across, 0.5 * down)  # moved to the side
        for axis in (0, 1):
            self.assertLess(np.abs(np.diff(spoilt["soft"], axis=axis)).max(), 60)

    def test_half_the_resolution_is_a_camera_of_half_the_focal_length(self):
        write_drive(self.query, images=[jpeg(board())])
        camera = self.description(self.altered("--spoil", "half"))["camera"]
        self.assertEqual((camera["width_px"], camera["height_px"], camera["focal_px"]), (300, 200, [200, 100]))
        self.assertEqual(camera["principal_px"], [149.75, 124.75])


if __name__ == "__main__":
    unittest.main(verbosity=2)
