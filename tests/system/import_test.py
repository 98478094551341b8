"""Recordings of other programs become drives: the simulated street's mapping drive, written in each layout by other
programs (cct of PROJ, gpsbabel) where Debian has one, comes back as it was, and is mapped and localized on."""
import datetime
import json
import math
import struct
import subprocess
import unittest

from commands import STREET, rows_of
from recorded_street import EPOCH_S, RecordedStreet, converted



class Import(RecordedStreet):
    def test_a_table_is_mapped_and_localized_on(self):
        self.expect_imported(self.run_import("csv", *self.with_images(self.degrees_table())))
        self.expect_frames()
        self.expect_localizes(0.010)

    def test_a_table_as_spreadsheets_write_it(self):
        rows = [(f"{pose.time_s:.6f}".replace(".", ","), f'"{latitude:.11f}"'.replace(".", ","),
                 f"{longitude:.11f}".replace(".", ","), f" {height:.5f} ".replace(".", ","),
                 f"{pose.heading_deg:.5f}".replace(".", ","), "x")
                for pose, (longitude, latitude, height) in zip(self.poses, self.lon_lat_h)]
        table = self.table(("GPS time", "Lat", '"Lon"', "H", "Yaw", "note"), rows, separator=";")
        self.expect_imported(self.run_import("csv", *self.with_images(table), "--columns", "time=GPS time", "latitude=Lat",
                                             "longitude=Lon", "height=H", "heading=Yaw"))
        self.expect_frames()

    def test_projected_and_geocentric_coordinates(self):
        utm = converted(self.lon_lat_h, "+step", "+proj=unitconvert", "+xy_in=deg", "+xy_out=rad",
                        "+step", "+proj=utm", "+zone=32", "+ellps=GRS80")
        geocentric = converted([pose.enu_m for pose in self.poses], *self.geocentric_from_enu)
        for crs, points in (("EPSG:25832", utm), ("EPSG:4978", geocentric)):
            with self.subTest(crs):
                self.drive = self.folder / crs.replace(":", "-")
                date = datetime.datetime.fromtimestamp
                table = self.table(("time", "x", "y", "z", "heading"),
                                   [(date(pose.time_s, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%fZ"), *point,
                                     pose.heading_deg) for pose, point in zip(self.poses, points)])
                result = self.run_import("csv", *self.with_images(table), "--crs", crs)
                self.expect_done(result)
                self.expect_frames()
        self.drive = self.folder / "none"
        self.expect_refused(self.run_import("csv", *self.with_images(table), "--crs", "EPSG:1"), 1, "--crs", "EPSG:1")
        self.assertFalse(self.drive.exists())

    def test_heights_above_the_sea(self):
        """EGM96, whose grid comes with Debian's PROJ: 48 m below the heights above the ellipsoid here."""
        text = "".join(f"{latitude:.11f} {longitude:.11f} {height:.5f}\n" for longitude, latitude, height in self.lon_lat_h)
        result = subprocess.run(["cs2cs", "-d", "6", "EPSG:4979", "EPSG:25832+5773"], input=text, capture_output=True, text=True,
                                check=True)
        points = [line.split() for line in result.stdout.splitlines()]
        self.assertAlmostEqual(float(points[0][2]) - self.lon_lat_h[0][2], -48, delta=1)
        table = self.table(("time", "x", "y", "z", "heading"), [(f"{pose.time_s:.6f}", *point, pose.heading_deg)
                                                                for pose, point in zip(self.poses, points)])
        self.expect_imported(self.run_import("csv", *self.with_images(table), "--crs", "EPSG:25832+5773"))
        self.expect_frames(within_m=0.005)

    def test_sbet(self):
        # No program of Debian writes this one.
        day_s = EPOCH_S - EPOCH_S % 86400
        records = [struct.pack("<17d", pose.time_s - day_s, math.radians(latitude), math.radians(longitude), height, 0, 0, 0,
                               math.radians(1), math.radians(2), math.radians(pose.heading_deg + 30), math.radians(30),
                               *[0] * 6) for pose, (longitude, latitude, height) in zip(self.poses, self.lon_lat_h)]
        file = self.folder / "sbet.out"
        file.write_bytes(b"".join(records))
        self.expect_imported(self.run_import("sbet", *self.with_images(file), "--day-s", day_s))
        self.expect_frames()
        self.expect_localizes(0.2)  # the tilts that it states are wrong
        row = rows_of(self.drive / "trajectory.csv")[3]
        self.assertAlmostEqual(float(row["roll_deg"]), 1, places=5)
        self.assertAlmostEqual(float(row["pitch_deg"]), 2, places=5)
        file.write_bytes(b"".join(records)[:-8])
        self.drive = self.folder / "cut"
        self.expect_refused(self.run_import("sbet", *self.with_images(file)), 1, "sbet.out", "no multiple of 136")

    def by_gpsbabel(self, kind, name):
        date = datetime.datetime.fromtimestamp
        table = self.table(("utc_d", "utc_t", "lat", "lon", "alt", "fix"),
                           [(*date(pose.time_s, datetime.timezone.utc).strftime("%Y/%m/%d %H:%M:%S.%f").split(),
                             f"{latitude:.10f}", f"{longitude:.10f}", f"{height:.4f}", "3d")
                            for pose, (longitude, latitude, height) in zip(self.poses, self.lon_lat_h)])
        file = self.folder / name
        subprocess.run(["gpsbabel", "-t", "-i", "unicsv,utc=0", "-f", table, "-o", kind, "-F", file], check=True)
        return file

    def test_gpx_tells_headings_by_the_motion(self):
        result = self.run_import("gpx", *self.with_images(self.by_gpsbabel("gpx", "track.gpx")))
        self.expect_done(result)
        self.expect_frames(within_m=0.01, within_deg=4)
        self.assertTrue((self.drive / "gps.csv").exists())
        self.expect_localizes(0.03)

    def test_nmea(self):
        result = self.run_import("nmea", *self.with_images(self.by_gpsbabel("nmea", "track.nmea")))
        self.expect_done(result)
        self.expect_frames(within_m=2, within_deg=180)  # it writes three decimals of a minute: 1.9 m
        self.expect_localizes(2.5)

    def rotation(self, heading_deg):
        """East, north, up from a level camera's right, down, forward."""
        h = math.radians(heading_deg)
        return [[math.cos(h), 0, math.sin(h)], [-math.sin(h), 0, math.cos(h)], [0, -1, 0]]

    def test_tum(self):
        lines = ["# timestamp tx ty tz qx qy qz qw"]
        for pose in self.poses:
            m = self.rotation(pose.heading_deg)
            # By the trace, which is above -1 for these.
            w = math.sqrt(max(0, 1 + m[0][0] + m[1][1] + m[2][2])) / 2
            x, y, z = (m[2][1] - m[1][2]) / (4 * w), (m[0][2] - m[2][0]) / (4 * w), (m[1][0] - m[0][1]) / (4 * w)
            lines.append(" ".join(f"{value:.9f}" for value in (pose.time_s, *pose.enu_m, x, y, z, w)))
        file = self.folder / "groundtruth.txt"
        file.write_text("\n".join(lines) + "\n")
        named = self.folder / "rgb.txt"
        named.write_text("# color images\n" + "".join(
            f"{pose.time_s:.6f} rgb/{row['filename']}\n" for row, pose in zip(self.rows, self.at_frames)))
        self.times = named
        self.expect_imported(self.run_import("tum", *self.with_images(file), "--origin", ",".join(map(str, self.origin))))
        self.expect_frames()
        self.expect_localizes(0.010)
        self.drive = self.folder / "lost"
        self.expect_refused(self.run_import("tum", *self.with_images(file)), 1, "--origin")

    def test_kitti_odometry(self):
        sequence = self.folder / "00"
        sequence.mkdir()
        (sequence / "image_0").symlink_to(self.frames.resolve())
        (sequence / "times.txt").write_text("".join(f"{pose.time_s:.6f}\n"
                                                    for pose in self.at_frames))
        (fx, fy), (cx, cy) = self.description["camera"]["focal_px"], self.description["camera"]["principal_px"]
        (sequence / "calib.txt").write_text(f"P0: {fx} 0 {cx} 0 0 {fy} {cy} 0 0 0 1 0\n")
        first = self.at_frames[0]
        to_first = self.rotation(first.heading_deg)  # its transpose turns the world into the first camera
        poses = self.folder / "00.txt"
        with poses.open("w") as file:
            for pose in self.at_frames:
                turn = self.rotation(pose.heading_deg)
                way = [b - a for a, b in zip(first.enu_m, pose.enu_m)]
                rows = [[sum(to_first[k][i] * turn[k][j] for k in range(3)) for j in range(3)]
                        + [sum(to_first[k][i] * way[k] for k in range(3))] for i in range(3)]
                file.write(" ".join(f"{value:.9e}" for row in rows for value in row) + "\n")
        (longitude, latitude, height), = converted([first.enu_m], *self.degrees_from_enu)
        self.expect_imported(self.run_import("kitti-odometry", "--folder", sequence, "--trajectory", poses, "--origin",
                                             f"{latitude:.11f},{longitude:.11f},{height:.5f}", "--origin-heading-deg",
                                             first.heading_deg))
        self.expect_frames()
        camera = json.loads((self.drive / "drive.json").read_text())["camera"]
        self.assertEqual(camera, self.description["camera"])
        self.expect_localizes(0.010)

    def test_kitti_raw(self):
        folder = self.folder / "2023_11_14" / "2023_11_14_drive_0001_sync"
        stamp = "%Y-%m-%d %H:%M:%S.%f"
        for part, poses in (("oxts", self.poses), ("image_00", self.at_frames)):
            (folder / part).mkdir(parents=True)
            (folder / part / "timestamps.txt").write_text("".join(
                datetime.datetime.fromtimestamp(pose.time_s, datetime.timezone.utc).strftime(stamp) + "000\n" for pose in poses))
        (folder / "image_00" / "data").symlink_to(self.frames.resolve())
        (folder / "oxts" / "data").mkdir()
        for i, (pose, (longitude, latitude, height)) in enumerate(zip(self.poses, self.lon_lat_h)):
            yaw = math.radians(90 - pose.heading_deg)
            (folder / "oxts" / "data" / f"{i:010}.txt").write_text(
                f"{latitude:.11f} {longitude:.11f} {height:.5f} 0 0 {yaw:.9f} " + "0 " * 24 + "\n")
        (fx, fy), (cx, cy) = self.description["camera"]["focal_px"], self.description["camera"]["principal_px"]
        calibration = folder.parent
        (calibration / "calib_cam_to_cam.txt").write_text(
            f"calib_time: 09-Jan-2012 13:57:47\nR_rect_00: 1 0 0 0 1 0 0 0 1\nP_rect_00: {fx} 0 {cx} 0 0 {fy} {cy} 0 0 0 1 0\n")
        (calibration / "calib_imu_to_velo.txt").write_text("R: 1 0 0 0 1 0 0 0 1\nT: -0.8 0.3 -0.8\n")
        (calibration / "calib_velo_to_cam.txt").write_text("R: 0 -1 0 0 0 -1 1 0 0\nT: 0 -0.08 -0.27\n")
        self.expect_imported(self.run_import("kitti-raw", "--folder", folder))
        self.expect_frames()
        mounting = json.loads((self.drive / "drive.json").read_text())["mounting"]
        for key, value in {"forward_m": 1.07, "right_m": 0.3, "up_m": 0.72, "yaw_deg": 0}.items():
            self.assertAlmostEqual(mounting[key], value, places=6, msg=key)
        # The street's positions are the camera's: with another calibration they are.
        (calibration / "calib_imu_to_velo.txt").write_text("R: 1 0 0 0 1 0 0 0 1\nT: 0 0 0\n")
        (calibration / "calib_velo_to_cam.txt").write_text("R: 0 -1 0 0 0 -1 1 0 0\nT: 0 0 0\n")
        self.drive = self.folder / "at-the-camera"
        self.expect_done(self.run_import("kitti-raw", "--folder", folder))
        self.expect_localizes(0.010)

    def test_images_stamped_with_whole_seconds(self):
        self.times = self.folder / "seconds.csv"
        self.times.write_text("filename,timestamp_s\n" + "".join(
            f"{row['filename']},{math.floor(pose.time_s)}\n" for row, pose in zip(self.rows, self.at_frames)))
        table = self.degrees_table()
        self.expect_refused(self.run_import("csv", *self.with_images(table)), 1, "timestamp_s")
        self.assertFalse((self.drive / "drive.json").exists())
        self.expect_done(self.run_import("csv", *self.with_images(table), "--spread-seconds"))
        for row, pose in zip(rows_of(self.drive / "trajectory.csv"), self.at_frames):
            self.assertLess(abs(float(row["timestamp_s"]) - pose.time_s), 0.35)

    def test_clocks_that_differ(self):
        self.times.write_text("filename,timestamp_s\n" + "".join(
            f"{row['filename']},{pose.time_s - 1000.5:.6f}\n" for row, pose in zip(self.rows, self.at_frames)))
        table = self.degrees_table()
        self.expect_refused(self.run_import("csv", *self.with_images(table)), 1, "no image has a pose", "--time-offset-s")
        self.expect_imported(self.run_import("csv", *self.with_images(table), "--time-offset-s", 1000.5))
        self.expect_frames()

    def test_gaps_are_named(self):
        begin_s = self.at_frames[10].time_s + 0.01
        kept = [(pose, place) for pose, place in zip(self.poses, self.lon_lat_h) if not begin_s < pose.time_s < begin_s + 1.5]
        self.poses, self.lon_lat_h = [pose for pose, _ in kept], [place for _, place in kept]
        result = self.run_import("csv", *self.with_images(self.degrees_table()))
        self.expect_done(result)
        self.assertRegex(result.stderr, rf"warning: .*\d+ of {len(self.rows)} images have no pose and are left out")
        self.assertRegex(result.stderr, r"warning: .*no pose between \d+\.\d+ and \d+\.\d+ s, 1\.[5-9] s long")

    def test_a_mounting_and_copies(self):
        self.expect_done(self.run_import("csv", *self.with_images(self.degrees_table()), "--mounting", 1.2, 0, 0.5, 2, 0, 0,
                                         "--copy", "--name", "tuesday", "--receiver-sigma-m", 3))
        description = json.loads((self.drive / "drive.json").read_text())
        self.assertEqual(description["name"], "tuesday")
        self.assertEqual(description["mounting"]["forward_m"], 1.2)
        rows = rows_of(self.drive / "trajectory.csv")
        expected = converted([pose.enu_m for pose in self.at_frames], *self.degrees_from_enu)
        self.assertAlmostEqual(float(rows[5]["latitude_deg"]), expected[5][1], delta=2e-8)  # of the reference point
        self.assertFalse((self.drive / "frames" / rows[0]["filename"]).is_symlink())
        self.assertEqual({row["sigma_m"] for row in rows_of(self.drive / "gps.csv")}, {"3"})

    def test_wrong_calls(self):
        table = self.degrees_table()
        self.expect_refused(self.run_import("sbet", "--images", self.frames), 2, "--trajectory", "sbet")
        self.expect_refused(self.run_import("csv", "--trajectory", table, "--images", self.frames, "--times", self.times), 1,
                            "--camera")
        self.expect_refused(self.run_import("csv", *self.with_images(table), "--columns", "when=time"), 1, "'when=time'")
        self.expect_refused(self.run_import("csv", *self.with_images(self.table(("time", "x"), [(1, 2)], "short.csv"))), 1,
                            "short.csv", "no column 'longitude'")
        self.drive.mkdir()
        (self.drive / "notes.txt").write_text("mine")
        self.expect_refused(self.run_import("csv", *self.with_images(table)), 1, "is not empty")
        self.assertEqual([entry.name for entry in self.drive.iterdir()], ["notes.txt"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
