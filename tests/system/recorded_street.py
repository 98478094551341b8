"""The simulated street's mapping drive as other programs might have recorded it."""
import json
import math
import subprocess

from commands import CLIENT, MAPPER, STREET, CommandTest, rows_of, run

EPOCH_S = 1_700_000_000  # added to the street's times where a layout has dates
BETWEEN = 10             # poses from one frame to the next


def converted(points, *pipeline):
    """Points through PROJ's own program."""
    text = "".join("%.12f %.12f %.9f\n" % tuple(point) for point in points)
    result = subprocess.run(["cct", "-d", "12", "+proj=pipeline", *pipeline], input=text, capture_output=True, text=True,
                            check=True)
    return [tuple(float(word) for word in line.split()[:3]) for line in result.stdout.splitlines()]


def turned(from_deg, to_deg):
    return (to_deg - from_deg + 180) % 360 - 180


class Pose:
    def __init__(self, time_s, enu_m, heading_deg):
        self.time_s, self.enu_m, self.heading_deg = time_s, enu_m, heading_deg


class RecordedStreet(CommandTest):
    source, query = STREET / "street-map", STREET / "street-query"

    def setUp(self):
        super().setUp()
        self.description = json.loads((self.source / "drive.json").read_text())
        self.frames = self.source / self.description["images"]
        self.rows = rows_of(self.source / "trajectory.csv")
        at_frames = [Pose(float(row["timestamp_s"]) + EPOCH_S, [float(row[axis]) for axis in ("east_m", "north_m", "up_m")],
                          float(row["heading_deg"])) for row in self.rows]
        self.at_frames = at_frames
        self.poses = []
        for before, after in zip(at_frames, at_frames[1:]):
            for step in range(BETWEEN):
                part = step / BETWEEN
                self.poses.append(Pose(before.time_s + part * (after.time_s - before.time_s),
                                       [a + part * (b - a) for a, b in zip(before.enu_m, after.enu_m)],
                                       before.heading_deg + part * turned(before.heading_deg, after.heading_deg)))
        self.poses.append(at_frames[-1])
        origin = self.description["origin"]
        self.origin = (origin["latitude_deg"], origin["longitude_deg"], origin["altitude_m"])
        self.geocentric_from_enu = ("+step", "+inv", "+proj=topocentric", "+ellps=WGS84", f"+lat_0={self.origin[0]}",
                                    f"+lon_0={self.origin[1]}", f"+h_0={self.origin[2]}")
        self.degrees_from_enu = (*self.geocentric_from_enu, "+step", "+inv", "+proj=cart", "+ellps=WGS84",
                                 "+step", "+proj=unitconvert", "+xy_in=rad", "+xy_out=deg")
        self.lon_lat_h = converted([pose.enu_m for pose in self.poses], *self.degrees_from_enu)
        self.camera = self.folder / "camera.json"
        self.camera.write_text(json.dumps({"camera": self.description["camera"]}))
        self.times = self.folder / "times.csv"
        self.times.write_text("filename,timestamp_s\n" + "".join(
            f"{row['filename']},{pose.time_s:.6f}\n" for row, pose in zip(self.rows, at_frames)))
        self.drive = self.folder / "imported"

    def run_import(self, layout, *words):
        return run(MAPPER, "import", layout, "--drive", self.drive, *words)

    def with_images(self, trajectory):
        return ("--trajectory", trajectory, "--images", self.frames, "--times", self.times, "--camera", self.camera)

    def table(self, header, rows, name="trajectory.csv", separator=","):
        file = self.folder / name
        file.write_text("".join(separator.join(map(str, row)) + "\n" for row in (header, *rows)))
        return file

    def expect_frames(self, within_m=0.002, within_deg=0.01, after_s=0.0):
        """The drive has the street's frames where and when they were."""
        expected = converted([pose.enu_m for pose in self.at_frames], *self.degrees_from_enu)
        rows = rows_of(self.drive / "trajectory.csv")
        self.assertEqual([row["filename"] for row in rows], [row["filename"] for row in self.rows])
        for row, pose, (longitude, latitude, height) in zip(rows, self.at_frames, expected):
            self.assertAlmostEqual(float(row["timestamp_s"]) - after_s, pose.time_s, delta=1e-4)
            north_m = (float(row["latitude_deg"]) - latitude) * 111_200
            east_m = (float(row["longitude_deg"]) - longitude) * 111_320 * math.cos(math.radians(latitude))
            self.assertLess(math.hypot(east_m, north_m, float(row["altitude_m"]) - height), within_m, row)
            self.assertLess(abs(turned(float(row["heading_deg"]), pose.heading_deg)), within_deg, row)
            frame = self.drive / "frames" / row["filename"]
            self.assertTrue(frame.is_symlink())
            self.assertEqual(frame.resolve(), (self.frames / row["filename"]).resolve())

    def expect_localizes(self, within_m, *words):
        """A map of the imported drive: another drive is found on it, in the mean within so many metres."""
        file, out = self.folder / f"{self.drive.name}.map", self.folder / f"{self.drive.name}-out"
        self.expect_done(self.build(self.drive, file, *words))
        self.expect_done(run(CLIENT, "evaluate", "--map", file, "--drive", self.query, "--out", out,
                             "--method", "milepost"))
        summary, = json.loads((out / "summary.json").read_text())
        self.assertLess(summary["mean_error_m"], within_m)
        self.assertLess(summary["mean_lateral_error_m"], within_m)

    def expect_imported(self, result):
        self.expect_done(result)
        self.assertEqual(result.stderr, "")
        self.assertRegex(result.stdout, rf"imported: {len(self.rows)} frames in \d+\.\d s\n$")

    def degrees_table(self, **words):
        return self.table(("time", "latitude", "longitude", "height", "heading"),
                          [(f"{pose.time_s:.6f}", f"{latitude:.11f}", f"{longitude:.11f}", f"{height:.5f}",
                            f"{pose.heading_deg:.5f}")
                           for pose, (longitude, latitude, height) in zip(self.poses, self.lon_lat_h)], **words)
