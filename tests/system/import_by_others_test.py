"""Recordings that other programs make of the simulated street: a model by COLMAP from its images alone, EXIF data by ExifTool,
a video by FFmpeg, positions of other datums by PROJ. Each becomes a drive, and is mapped and localized on."""
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from commands import MAPPER, SIMULATOR, edit_json, rows_of, run
from recorded_street import EPOCH_S, RecordedStreet, converted, turned


def call(*words, **options):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                   env={**os.environ, "QT_QPA_PLATFORM": "offscreen"}, **options)


class ByOthers(RecordedStreet):
    def positions_of(self, drive):
        """East, north and up of each frame, in the street's frame."""
        rows = rows_of(drive / "trajectory.csv")
        degrees = [(float(row["longitude_deg"]), float(row["latitude_deg"]), float(row["altitude_m"])) for row in rows]
        back = converted(degrees, "+step", "+proj=unitconvert", "+xy_in=deg", "+xy_out=rad", "+step", "+proj=cart",
                         "+ellps=WGS84", "+step", "+proj=topocentric", "+ellps=WGS84", f"+lat_0={self.origin[0]}",
                         f"+lon_0={self.origin[1]}", f"+h_0={self.origin[2]}")
        return rows, back

    def expect_near(self, within_m, within_deg):
        rows, places = self.positions_of(self.drive)
        by_name = {row["filename"]: pose for row, pose in zip(self.rows, self.at_frames)}
        for row, place in zip(rows, places):
            pose = by_name[row["filename"]]
            self.assertLess(math.dist(place, pose.enu_m), within_m, row)
            self.assertLess(abs(turned(float(row["heading_deg"]), pose.heading_deg)), within_deg, row)



class OnTheStreet(ByOthers):
    def with_exif(self):
        """The street's images with their places, times and directions by ExifTool; heights above the sea."""
        images = self.folder / "exif"
        shutil.copytree(self.frames, images)
        degrees = converted([pose.enu_m for pose in self.at_frames], *self.degrees_from_enu)
        text = "".join(f"{latitude:.11f} {longitude:.11f} {height:.5f}\n" for longitude, latitude, height in degrees)
        sea = subprocess.run(["cs2cs", "-d", "6", "EPSG:4979", "EPSG:4326+5773"], input=text, capture_output=True, text=True,
                             check=True)
        table = ["SourceFile,EXIF:GPSLatitude,EXIF:GPSLatitudeRef,EXIF:GPSLongitude,EXIF:GPSLongitudeRef,EXIF:GPSAltitude,"
                 "EXIF:GPSAltitudeRef,EXIF:GPSImgDirection,EXIF:GPSImgDirectionRef,EXIF:DateTimeOriginal,"
                 "EXIF:SubSecTimeOriginal,EXIF:OffsetTimeOriginal"]
        for row, pose, (longitude, latitude, _), line in zip(self.rows, self.at_frames, degrees, sea.stdout.splitlines()):
            at = subprocess.run(["date", "-u", "-d", f"@{int(pose.time_s) + 7200}", "+%Y:%m:%d %H:%M:%S"], capture_output=True,
                                text=True, check=True).stdout.strip()
            table.append(f"{images / row['filename']},{latitude:.11f},N,{longitude:.11f},E,{line.split()[2]},0,"
                         f"{pose.heading_deg % 360:.5f},T,{at},{round(pose.time_s % 1 * 10000):04},+02:00")
        file = self.folder / "exif.csv"
        file.write_text("\n".join(table) + "\n")
        call("exiftool", "-q", "-overwrite_original", "-n", f"-csv={file}", images)
        return images

    def test_exif(self):
        images = self.with_exif()
        result = self.run_import("exif", "--images", images, "--camera", self.camera)
        self.expect_done(result)
        self.expect_near(0.03, 0.01)
        for row, pose in zip(rows_of(self.drive / "trajectory.csv"), self.at_frames):
            self.assertAlmostEqual(float(row["timestamp_s"]), pose.time_s, delta=1e-3)
        self.expect_localizes(0.02)

        call("exiftool", "-q", "-overwrite_original", "-EXIF:GPSImgDirection=", "-EXIF:SubSecTimeOriginal=", images)
        self.drive = self.folder / "whole-seconds"
        self.expect_refused(self.run_import("exif", "--images", images, "--camera", self.camera), 1, "timestamp_s")
        self.drive = self.folder / "no-places"
        self.expect_refused(self.run_import("exif", "--images", self.frames, "--camera", self.camera), 1, "EXIF data have no time")

    def video(self, *words):
        """Five frames a second; the drive was as fast."""
        for i, pose in enumerate(self.at_frames):
            pose.time_s = EPOCH_S + 1000 + i / 5
        self.poses = self.at_frames
        self.lon_lat_h = converted([pose.enu_m for pose in self.poses], *self.degrees_from_enu)
        file = self.folder / "street.mp4"
        call("ffmpeg", "-loglevel", "error", "-framerate", 5, "-i", self.frames / "%06d.jpg", "-c:v", "libx264", "-crf", 4,
             "-pix_fmt", "yuv420p", *words, "-y", file)
        return file

    def test_video(self):
        plain = self.video()
        begin_s = self.at_frames[0].time_s
        words = ("--trajectory", self.degrees_table(), "--camera", self.camera)
        self.expect_done(self.run_import("csv", "--images", plain, *words, "--time-offset-s", begin_s))
        rows = rows_of(self.drive / "trajectory.csv")
        self.assertEqual(len(rows), len(self.rows))
        for row, pose in zip(rows, self.at_frames):
            self.assertAlmostEqual(float(row["timestamp_s"]), pose.time_s, delta=2e-3)
        self.expect_localizes(0.02)

        self.drive = self.folder / "with-its-date"
        dated = self.video("-metadata", "creation_time=2023-11-14T22:13:20Z")  # EPOCH_S
        self.expect_done(self.run_import("csv", "--images", dated, *words, "--time-offset-s", f"{begin_s - EPOCH_S:.6f}",
                                         "--rate-hz", 2))
        self.assertLess(len(rows_of(self.drive / "trajectory.csv")), 0.7 * len(self.rows))

        self.drive = self.folder / "none"
        cut = self.folder / "cut.mp4"
        cut.write_bytes(plain.read_bytes()[:2000])
        self.expect_refused(self.run_import("csv", "--images", cut, *words), 1, "cut.mp4")
        self.expect_refused(self.run_import("csv", "--images", words[1], *words), 1, "trajectory.csv", "no video")
        self.assertFalse(self.drive.exists())

    def test_a_turned_video(self):
        """A camera that stood on its side: the frames are turned as a player turns them."""
        upright = self.video()
        side = self.folder / "side.mp4"
        call("ffmpeg", "-loglevel", "error", "-i", upright, "-vf", "transpose=1", "-c:v", "libx264", "-crf", 4,
             self.folder / "turned.mp4")
        call("ffmpeg", "-loglevel", "error", "-i", self.folder / "turned.mp4", "-c", "copy", "-metadata:s:v", "rotate=90", side)
        self.expect_done(self.run_import("csv", "--images", side, "--trajectory", self.degrees_table(), "--camera", self.camera,
                                         "--time-offset-s", self.at_frames[0].time_s))
        self.expect_localizes(0.08)  # coded twice

    def test_other_datums_give_the_same_map(self):
        """A drive in WGS84 as of ITRF2014, and the same in ETRS89/UTM with heights above the sea: one map, to 5 mm."""
        text = "".join(f"{latitude:.11f} {longitude:.11f} {height:.5f} 2020.5\n" for longitude, latitude, height in self.lon_lat_h)

        def through(lines, *words):
            result = subprocess.run(["cs2cs", "-d", "10", *words], input=lines, capture_output=True, text=True, check=True)
            return [line.split() for line in result.stdout.splitlines()]

        europe = through(text, "EPSG:7912", "EPSG:7931")  # ITRF2014 to ETRF2000
        self.assertGreater(abs(float(europe[0][0]) - self.lon_lat_h[0][1]) * 111_200, 0.3)
        utm = through("".join(" ".join(each[:3]) + "\n" for each in europe), "EPSG:4937", "EPSG:25832+5773")
        table = self.table(("time", "x", "y", "z", "heading"), [(f"{pose.time_s:.6f}", *point[:3], pose.heading_deg)
                                                                for pose, point in zip(self.poses, utm)], "sea.csv")
        datum = ("--to-datum", "ITRF2014@2020.5")
        self.expect_done(self.run_import("csv", *self.with_images(table), "--crs", "EPSG:25832+5773", "--datum", "ETRF2000", *datum))
        self.expect_frames(within_m=0.005)
        sea = self.drive
        self.drive = self.folder / "degrees"
        self.expect_done(self.run_import("csv", *self.with_images(self.degrees_table()), "--datum", "ITRF2014@2020.5"))
        lines = {}
        for drive in (sea, self.drive):
            file = self.folder / f"{drive.name}.map"
            edit_json(drive / "drive.json", lambda description: description.update(name="street"))
            self.expect_done(self.build(drive, file))
            shown = run(MAPPER, "inspect", "--map", file)
            self.assertIn("positions in ITRF2014@2020.5", shown.stdout)
            exported = self.folder / f"{drive.name}.geojson"
            self.expect_done(run(MAPPER, "export", "--map", file, "--layer", "segments", "--geojson", exported))
            lines[drive.name] = [point for feature in json.loads(exported.read_text())["features"]
                                 if feature["geometry"]["type"] == "LineString" for point in feature["geometry"]["coordinates"]]
        for (east, north, *up), (east2, north2, *up2) in zip(*lines.values(), strict=True):
            self.assertLess(math.hypot((east - east2) * 73_000, (north - north2) * 111_200), 0.005)
            for a, b in zip(up, up2):
                self.assertLess(abs(a - b), 0.005)

        mixed = self.folder / "mixed.map"
        self.drive = self.folder / "europe"
        self.expect_done(self.run_import("csv", *self.with_images(table), "--crs", "EPSG:25832+5773", "--datum", "ETRF2000"))
        words = ("--drive", sea, "--drive", self.drive)
        for more in ((), ("--dry-run",)):
            self.expect_refused(run(MAPPER, "build", *words, "--map", mixed, *more), 1, "drive.json", "ETRF2000",
                                "ITRF2014@2020.5", "--to-datum")
        self.assertFalse(mixed.exists())


class RoundACorner(ByOthers):
    """On a drive that turns: positions on a straight line would not tell how a model is rolled, nor turns the clock."""

    @classmethod
    def setUpClass(cls):
        cls.rendered = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.rendered.cleanup)
        folder = pathlib.Path(cls.rendered.name)
        call(SIMULATOR, "--out", folder, "--drive", "town-loop-map", "town-loop-query", "--length-m", 70, "--camera-px", 480, 400,
             "--seed", 3)
        cls.source, cls.query = folder / "town-loop-map", folder / "town-loop-query"

    def reconstruct(self):
        """The street from its images by COLMAP, aligned to east, north and up by the positions alone."""
        work = self.folder / "colmap"
        (work / "sparse").mkdir(parents=True)
        (fx, fy), (cx, cy) = self.description["camera"]["focal_px"], self.description["camera"]["principal_px"]
        database = ("--database_path", work / "database.db")
        call("colmap", "feature_extractor", *database, "--image_path", self.frames, "--ImageReader.single_camera", 1,
             "--ImageReader.camera_model", "PINHOLE", "--ImageReader.camera_params", f"{fx},{fy},{cx + 0.5},{cy + 0.5}",
             "--SiftExtraction.use_gpu", 0, "--SiftExtraction.max_num_features", 1000, "--SiftExtraction.first_octave", 0)
        call("colmap", "sequential_matcher", *database, "--SiftMatching.use_gpu", 0, "--SequentialMatching.overlap", 4,
             "--SequentialMatching.quadratic_overlap", 0)
        call("colmap", "mapper", *database, "--image_path", self.frames, "--output_path", work / "sparse",
             "--Mapper.ba_refine_focal_length", 0, "--Mapper.ba_refine_extra_params", 0, "--Mapper.init_min_tri_angle", 3,
             "--Mapper.init_max_forward_motion", 1, "--Mapper.init_min_num_inliers", 50)
        places = work / "places.txt"
        places.write_text("".join(f"{row['filename']} {' '.join(map(str, pose.enu_m))}\n"
                                  for row, pose in zip(self.rows, self.at_frames)))
        for kind, is_ecef in (("aligned", False), ("geocentric", True)):
            (work / kind).mkdir()
            if is_ecef:
                at = converted([pose.enu_m for pose in self.at_frames], *self.geocentric_from_enu)
                places.write_text("".join(f"{row['filename']} {' '.join(f'{x:.6f}' for x in place)}\n"
                                          for row, place in zip(self.rows, at)))
            call("colmap", "model_aligner", "--input_path", work / "sparse" / "0", "--output_path", work / kind,
                 "--ref_images_path", places, "--ref_is_gps", 0, "--alignment_type", "custom", "--robust_alignment", 1,
                 "--robust_alignment_max_error", 0.5)
        return work

    def test_colmap(self):
        work = self.reconstruct()
        words = ("--images", self.frames, "--times", self.times)
        origin = ("--origin", ",".join(map(str, self.origin)))
        self.expect_done(self.run_import("colmap", "--folder", work / "aligned", *words, *origin))
        self.expect_near(0.5, 1)
        camera = json.loads((self.drive / "drive.json").read_text())["camera"]
        self.assertEqual(camera, self.description["camera"])
        self.expect_localizes(0.3)
        binary = (self.drive / "trajectory.csv").read_text()

        (work / "text").mkdir()
        call("colmap", "model_converter", "--input_path", work / "aligned", "--output_path", work / "text", "--output_type",
             "TXT")
        self.drive = self.folder / "text"
        self.expect_done(self.run_import("colmap", "--folder", work / "text", *words, *origin))
        self.assertEqual((self.drive / "trajectory.csv").read_text(), binary)

        self.drive = self.folder / "geocentric"
        self.expect_done(self.run_import("colmap", "--folder", work / "geocentric", *words, "--crs", "EPSG:4978"))
        self.expect_near(0.5, 1)
        self.assertEqual(json.loads((self.drive / "drive.json").read_text())["datum"], "WGS 84")

        self.drive = self.folder / "none"
        self.expect_refused(self.run_import("colmap", "--folder", work / "aligned", *words), 1, "--origin", "--crs EPSG:4978")
        self.expect_refused(self.run_import("colmap", "--folder", work, *words, *origin), 1, "images.bin")
        self.expect_refused(self.run_import("colmap", "--folder", work / "aligned", *words, "--crs", "EPSG:25832"), 1, "geocentric")

    def test_the_clock_is_found_by_the_motion(self):
        shift_s = 37.3
        self.times.write_text("filename,timestamp_s\n" + "".join(
            f"{row['filename']},{pose.time_s - shift_s:.6f}\n" for row, pose in zip(self.rows, self.at_frames)))
        words = (*self.with_images(self.degrees_table()), "--estimate-offset-s")
        result = self.run_import("csv", *words, 60)
        self.expect_done(result)
        found_s = float(re.search(r"moved by (-?[0-9.]+) s more, by which they go with the turns", result.stderr)[1])
        self.assertAlmostEqual(found_s, shift_s, delta=0.15)
        self.drive = self.folder / "not-found"
        self.expect_refused(self.run_import("csv", *words, 20), 1, "--estimate-offset-s", "--time-offset-s")
        self.assertFalse((self.drive / "drive.json").exists())


if __name__ == "__main__":
    unittest.main(verbosity=2)
