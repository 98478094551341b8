"""Bags of ROS 1 and 2 become drives: the simulated street's mapping drive, written as bags by other programs, comes
back as it was, and is mapped and localized on."""
import json
import math
import pathlib
import random
import shutil
import sqlite3
import struct
import unittest

import zstandard
from PIL import Image

from bag_writers import Message, Ros1, Ros2
from commands import CLIENT, MAPPER, STREET, CommandTest, rows_of, run
from recorded_street import converted, turned

STREET_MAP = STREET / "street-map"
EPOCH_NS = 1_700_000_000 * 10**9  # added to the street's times
BETWEEN = 10                      # poses from one frame to the next


class Pose:
    def __init__(self, time_ns, enu_m, heading_deg):
        self.time_ns, self.enu_m, self.heading_deg = time_ns, enu_m, heading_deg

    def rotation(self, pitch_deg=0.0, roll_deg=0.0):
        """x, y, z, w from the body (x forward, y left, z up) to east, north, up. REP 103's pitch turns the nose down."""
        roll, pitch, yaw = (math.radians(angle) / 2 for angle in (roll_deg, -pitch_deg, 90 - self.heading_deg))
        (sr, sp, sy), (cr, cp, cy) = map(math.sin, (roll, pitch, yaw)), map(math.cos, (roll, pitch, yaw))
        return (sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
                cr * cp * cy + sr * sp * sy)


class Street:
    """The mapping drive of the street, with poses between its frames."""

    def __init__(self):
        self.description = json.loads((STREET_MAP / "drive.json").read_text())
        self.rows = rows_of(STREET_MAP / "trajectory.csv")
        self.files = [STREET_MAP / self.description["images"] / row["filename"] for row in self.rows]
        self.at_frames = [Pose(EPOCH_NS + round(float(row["timestamp_s"]) * 1e9),
                               [float(row[axis]) for axis in ("east_m", "north_m", "up_m")], float(row["heading_deg"]))
                          for row in self.rows]
        self.poses = []
        for before, after in zip(self.at_frames, self.at_frames[1:]):
            for step in range(BETWEEN):
                part = step / BETWEEN
                self.poses.append(Pose(before.time_ns + round(part * (after.time_ns - before.time_ns)),
                                       [a + part * (b - a) for a, b in zip(before.enu_m, after.enu_m)],
                                       before.heading_deg + part * turned(before.heading_deg, after.heading_deg)))
        self.poses.append(self.at_frames[-1])
        origin = self.description["origin"]
        self.origin = (origin["latitude_deg"], origin["longitude_deg"], origin["altitude_m"])
        self.lat_lon_h = self.degrees_of(self.poses)

    def degrees_of(self, poses):
        degrees = converted([pose.enu_m for pose in poses],
                            "+step", "+inv", "+proj=topocentric", "+ellps=WGS84", f"+lat_0={self.origin[0]}",
                            f"+lon_0={self.origin[1]}", f"+h_0={self.origin[2]}",
                            "+step", "+inv", "+proj=cart", "+ellps=WGS84",
                            "+step", "+proj=unitconvert", "+xy_in=rad", "+xy_out=deg")
        return [(latitude, longitude, height) for longitude, latitude, height in degrees]

    # What sensors record of it.

    def images(self, topic="/camera/image_raw", count=None):
        messages = []
        for pose, file in list(zip(self.at_frames, self.files))[:count]:
            grey = Image.open(file).convert("L")
            messages.append(Message(topic, "image", pose.time_ns, height=grey.height, width=grey.width, encoding="mono8",
                                    step=grey.width, data=grey.tobytes()))
        return messages

    def compressed(self, topic="/camera/image_raw/compressed"):
        return [Message(topic, "compressed", pose.time_ns, format="mono8;compressed", data=file.read_bytes())
                for pose, file in zip(self.at_frames, self.files)]

    def infos(self, topic="/camera/camera_info", model="plumb_bob", D=(), K=None, P=None):
        camera = self.description["camera"]
        (fx, fy), (cx, cy) = camera["focal_px"], camera["principal_px"]
        K = K or [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0]
        return [Message(topic, "info", pose.time_ns, height=camera["height_px"], width=camera["width_px"], model=model,
                        D=[float(value) for value in D], K=[float(value) for value in K],
                        P=[float(value) for value in P or [0] * 12]) for pose in self.at_frames]

    def fixes(self, topic="/fix"):
        return [Message(topic, "fix", pose.time_ns, position=place) for pose, place in zip(self.poses, self.lat_lon_h)]

    def imus(self, topic="/imu/data", pitch_deg=0.0, roll_deg=0.0, **words):
        """At another rate than the receiver's."""
        return [Message(topic, "imu", pose.time_ns, rotation=pose.rotation(pitch_deg, roll_deg), **words)
                for pose in self.poses[::2]]

    def odometry(self, topic="/odom"):
        return [Message(topic, "odometry", pose.time_ns, position=[float(value) for value in pose.enu_m],
                        rotation=pose.rotation()) for pose in self.poses]


def by_time(*topics):
    return sorted((message for topic in topics for message in topic), key=lambda message: message.time_ns)


class BagTests:
    """The tests of both generations; `bags` writes theirs."""

    @classmethod
    def setUpClass(cls):
        cls.street = Street()

    def setUp(self):
        super().setUp()
        self.drive = self.folder / "imported"

    def write(self, *topics, name="street", **words):
        file = self.folder / (name + self.bags.ending)
        self.bags.write(file, by_time(*topics), **words)
        return file

    def run_import(self, bag, *words):
        return run(MAPPER, "import", self.bags.layout, "--trajectory", bag, "--drive", self.drive, *words)

    def expect_not_imported(self, bag, *parts, words=(), where=None):
        self.expect_refused(self.run_import(bag, *words), 1, where or pathlib.Path(bag).name, *parts)
        self.assertFalse(self.drive.exists() and list(self.drive.iterdir()))

    def expect_street(self, result, within_m=0.001, within_deg=0.001):
        """The drive has the street's frames where, when and as they were."""
        self.expect_done(result)
        rows, street = rows_of(self.drive / "trajectory.csv"), self.street
        self.assertEqual(len(rows), len(street.rows))
        for row, pose, place, file in zip(rows, street.at_frames, street.degrees_of(street.at_frames), street.files):
            self.assertAlmostEqual(float(row["timestamp_s"]), pose.time_ns / 1e9, delta=1e-5)
            north_m = (float(row["latitude_deg"]) - place[0]) * 111_200
            east_m = (float(row["longitude_deg"]) - place[1]) * 111_320 * math.cos(math.radians(place[0]))
            self.assertLess(math.hypot(east_m, north_m, float(row["altitude_m"]) - place[2]), within_m, row)
            self.assertLess(abs(turned(float(row["heading_deg"]), pose.heading_deg)), within_deg, row)
            frame = self.drive / "frames" / row["filename"]
            self.assertFalse(frame.is_symlink())
            self.assertEqual(Image.open(frame).convert("L").tobytes(), Image.open(file).convert("L").tobytes())

    def small(self, *others):
        """A bag's topics with few images, for what does not depend on them."""
        return self.street.images(count=2), self.street.fixes(), self.street.infos(), *others

    def test_a_receiver_and_an_imu_are_mapped_and_localized_on(self):
        street = self.street
        result = self.run_import(self.write(street.images(), street.infos(), street.fixes(), street.imus()))
        self.expect_street(result)
        self.assertEqual(result.stderr, "")
        self.assertEqual(json.loads((self.drive / "drive.json").read_text())["camera"], street.description["camera"])
        self.assertTrue((self.drive / "gps.csv").exists())
        file, out = self.folder / "street.map", self.folder / "out"
        self.expect_done(self.build(self.drive, file))
        self.expect_done(run(CLIENT, "evaluate", "--map", file, "--drive", STREET / "street-query", "--out", out,
                             "--method", "milepost"))
        summary, = json.loads((out / "summary.json").read_text())
        self.assertLess(summary["mean_error_m"], 0.010)
        self.assertLess(summary["mean_lateral_error_m"], 0.010)

    def test_odometry_alone_lies_where_origin_says(self):
        street = self.street
        bag = self.write(street.compressed(), street.infos(), street.odometry())
        self.expect_not_imported(bag, "is required", where="--origin")
        origin = ("--origin", ",".join(map(str, street.origin)))
        self.expect_street(self.run_import(bag, *origin))
        for row, file in zip(rows_of(self.drive / "trajectory.csv"), street.files):
            self.assertEqual((self.drive / "frames" / row["filename"]).read_bytes(), file.read_bytes())
            self.assertEqual(pathlib.Path(row["filename"]).suffix, file.suffix)
        self.assertFalse((self.drive / "gps.csv").exists())
        before = rows_of(self.drive / "trajectory.csv")
        self.drive = self.folder / "turned"
        self.expect_done(self.run_import(bag, *origin, "--origin-heading-deg", 30))
        after = rows_of(self.drive / "trajectory.csv")
        for a, b in zip(before, after):
            self.assertAlmostEqual(turned(float(a["heading_deg"]), float(b["heading_deg"])), 30, places=4)

    def test_tilts_are_those_of_rep_103(self):
        result = self.run_import(self.write(*self.small(self.street.imus(pitch_deg=2.0, roll_deg=1.0))))
        self.expect_done(result)
        row = rows_of(self.drive / "trajectory.csv")[1]
        self.assertAlmostEqual(float(row["pitch_deg"]), 2, places=4)
        self.assertAlmostEqual(float(row["roll_deg"]), 1, places=4)
        self.assertLess(abs(turned(float(row["heading_deg"]), self.street.at_frames[1].heading_deg)), 0.001)

    def test_headings_by_the_motion(self):
        street = self.street
        for name, others, words in (("none", (), ()), ("unwanted", (street.odometry(),), ("--topics", "orientation=none")),
                                    ("not-estimated", (street.imus(covariance=-1),), ())):
            with self.subTest(name):
                self.drive = self.folder / name
                self.expect_street(self.run_import(
                    self.write(street.images(), street.fixes(), street.infos(), *others, name=name), *words), within_deg=4)
                self.assertNotIn("roll_deg", rows_of(self.drive / "trajectory.csv")[0])
        self.drive = self.folder / "named"
        self.expect_not_imported(self.folder / ("not-estimated" + self.bags.ending), "/imu/data", "holds an orientation",
                                 words=("--topics", "orientation=/imu/data"))

    def test_fixes_that_are_none_are_left_out(self):
        street = self.street
        fixes = street.fixes()
        for i, message in enumerate(fixes):
            if i % BETWEEN == 3:
                message.fields.update(status=-1, position=(0.0, 0.0, 0.0))
            elif i % BETWEEN == 5:
                message.fields.update(position=(math.nan,) * 3)
        self.expect_street(self.run_import(self.write(street.images(), street.infos(), street.imus(), fixes)))
        for message in fixes:
            message.fields.update(status=-1)
        self.drive = self.folder / "none"
        self.expect_not_imported(self.write(street.images(count=2), fixes, name="none"), "/fix", "holds a position")

    def test_topics_are_chosen(self):
        street = self.street
        bag = self.write(street.images("/left/image_raw", count=2), street.infos("/left/camera_info"),
                         street.images("/right/image_raw", count=3), street.infos("/right/camera_info", K=[
                             400, 0, 300, 0, 400, 250, 0, 0, 1]), street.fixes("/fix"), street.imus(), street.odometry())
        self.expect_not_imported(bag, "several topics", "/left/image_raw (sensor_msgs/Image)", "/right/image_raw",
                                 "--topics image=NAME")
        left = ("--topics", "image=/left/image_raw")
        self.expect_not_imported(bag, "several topics", "/imu/data", "/odom", "--topics orientation=NAME", words=left)
        self.expect_not_imported(bag, "has no topic '/up'", "/left/image_raw", words=("--topics", "image=/up"))
        self.expect_not_imported(bag, "has no topic '/fix'", words=("--topics", "image=/fix"))
        self.expect_not_imported(bag, "'cam=/left' is not WHAT=NAME", words=("--topics", "cam=/left"), where="--topics")
        self.expect_done(self.run_import(bag, "--topics", "image=/right/image_raw", "orientation=/imu/data"))
        self.assertEqual(len(rows_of(self.drive / "trajectory.csv")), 3)
        self.assertEqual(json.loads((self.drive / "drive.json").read_text())["camera"]["focal_px"], [400, 400])
        self.drive = self.folder / "by-odometry"
        self.expect_done(self.run_import(bag, *left, "position=/odom", "camera_info=/right/camera_info", "--origin",
                                         ",".join(map(str, street.origin))))
        self.assertFalse((self.drive / "gps.csv").exists())
        self.assertEqual(json.loads((self.drive / "drive.json").read_text())["camera"]["focal_px"], [400, 400])

    def test_cameras(self):
        street = self.street
        fisheye = self.write(street.images(count=2), street.fixes(), street.infos(model="equidistant", D=(0.01, 0, 0, 0)),
                             name="fisheye")
        self.expect_done(self.run_import(fisheye))
        self.assertEqual(json.loads((self.drive / "drive.json").read_text())["camera"]["distortion"],
                         {"model": "kannala-brandt", "k1": 0.01, "k2": 0, "k3": 0, "k4": 0})
        self.drive = self.folder / "rectified"
        rectified = self.write(street.images("/camera/image_rect", count=2), street.fixes(), street.infos(
            D=(-0.1, 0, 0, 0, 0), P=(350, 0, 299, 0, 0, 351, 249, 0, 0, 0, 1, 0)), name="rectified")
        self.expect_done(self.run_import(rectified))
        camera = json.loads((self.drive / "drive.json").read_text())["camera"]
        self.assertEqual((camera["focal_px"], camera["principal_px"]), ([350, 351], [299, 249]))
        self.assertNotIn("distortion", camera)
        self.drive = self.folder / "told"
        unknown = self.write(street.images(count=2), street.fixes(), street.infos(model="double_sphere", D=(0.1,)),
                             name="unknown")
        self.expect_not_imported(unknown, "/camera/camera_info", "double_sphere", "--camera")
        file = self.folder / "camera.json"
        file.write_text(json.dumps({"camera": street.description["camera"]}))
        self.expect_done(self.run_import(unknown, "--camera", file))
        self.drive = self.folder / "uncalibrated"
        self.expect_not_imported(self.write(street.images(count=2), street.fixes(), street.infos(K=[0] * 9), name="zero"),
                                 "is required", where="--camera")

    def test_wrong_recordings(self):
        street = self.street
        yuv = street.images(count=2)
        yuv[1].fields["encoding"] = "yuv422"
        self.expect_not_imported(self.write(yuv, street.fixes(), name="yuv"), "/camera/image_raw, message 2", "'yuv422'")
        short = street.images(count=2)
        short[0].fields["data"] = short[0].fields["data"][:-1]
        self.expect_not_imported(self.write(short, street.fixes(), name="short"), "message 1", "bytes of pixels")
        depth = street.compressed()
        depth[0].fields["data"] = b"\0" * 12 + depth[0].fields["data"]
        self.expect_not_imported(self.write(depth, street.fixes(), name="depth"), "message 1", "no JPEG, PNG, TIFF or WebP")
        self.expect_not_imported(self.write(street.images(count=2), name="still"), "no topic of sensor_msgs/NavSatFix")
        self.expect_not_imported(self.write(street.fixes(), name="blind"), "no topic of sensor_msgs/Image")
        self.expect_not_imported(self.write(name="empty"), "no topic of sensor_msgs/Image")
        self.expect_not_imported(self.folder / ("none" + self.bags.ending), "there is no such file")
        text = self.folder / ("text" + self.bags.ending)
        text.write_text("a text\n" * 1000)
        self.expect_not_imported(text, "is no bag")
        text.write_bytes(b"")
        self.expect_not_imported(text, "is no bag")
        folder = self.folder / "a-folder"
        folder.mkdir()
        self.expect_not_imported(folder, "name the")

    def expect_sound_or_refused(self, bag, damages):
        """Each damage of a bag is refused in one line, or makes no difference that the bag could tell."""
        content = bag.read_bytes()
        damaged = self.folder / ("damaged" + self.bags.ending)
        refused = 0
        for damage in damages:
            damaged.write_bytes(damage(content))
            result = self.run_import(damaged)
            if result.returncode == 0:
                shutil.rmtree(self.drive)
                continue
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            self.assertFalse(self.drive.exists() and list(self.drive.iterdir()), result.stderr)
            refused += 1
        return refused


def with_bytes(content, at, new):
    return content[:at] + new + content[at + len(new):]


class ImportRos1(BagTests, CommandTest):
    bags = Ros1

    def test_compressions(self):
        for compression in ("bz2", "lz4"):
            with self.subTest(compression):
                self.drive = self.folder / compression
                street = self.street
                self.expect_street(self.run_import(self.write(street.images(), street.infos(), street.fixes(), street.imus(),
                                                              name=compression, compression=compression)))

    def test_truncated(self):
        bag = self.write(*self.small(), chunk_threshold=20_000)
        content = bag.read_bytes()
        draw = random.Random(1)
        lengths = [13, 20, 100, len(content) - 1, *(draw.randrange(14, len(content)) for _ in range(20))]
        refused = self.expect_sound_or_refused(bag, [lambda content, n=n: content[:n] for n in lengths])
        self.assertEqual(refused, len(lengths))

    def test_damaged(self):
        for compression in ("none", "bz2", "lz4"):
            bag = self.write(*self.small(), name=compression, compression=compression, chunk_threshold=20_000)
            content = bag.read_bytes()
            draw, damages = random.Random(2), []
            for _ in range(30):
                at, byte = draw.randrange(13, len(content)), bytes([draw.randrange(256)])
                damages.append(lambda content, at=at, byte=byte: with_bytes(content, at, byte))
            refused = self.expect_sound_or_refused(bag, damages)
            if compression != "none":  # both have checksums
                self.assertGreater(refused, len(damages) // 3)
                bag.write_bytes(with_bytes(content, content.find(b"size=") + 60, b"\xff" * 8))
                self.expect_not_imported(bag, "chunk at byte 4117", "cannot be decompressed")

    def test_lengths_that_lie(self):
        bag = self.write(*self.small())
        content = bag.read_bytes()
        size = content.find(b"size=") + 5
        for at, part in ((13, "damaged"), (content.find(b"compression=none") - 4, "has a damaged record"),
                         (size, "more than 1 GiB"), (size + 8, "damaged"), (content.find(b"index_pos=") + 10, "is truncated")):
            with self.subTest(at):
                bag.write_bytes(with_bytes(content, at, struct.pack("<I", 0xFFFFFFF0)))
                self.expect_not_imported(bag, part)

    def test_not_closed_or_of_another_kind(self):
        bag = self.write(*self.small())
        content = bag.read_bytes()
        bag.write_bytes(with_bytes(content, content.find(b"index_pos=") + 10, bytes(8)))
        self.expect_not_imported(bag, "was not closed", "rosbag reindex")
        bag.write_bytes(content.replace(b"#ROSBAG V2.0", b"#ROSBAG V1.2"))
        self.expect_not_imported(bag, "no bag of format 2.0")
        bag.write_bytes(content.replace(b"compression=none", b"compression=blob"))
        self.expect_not_imported(bag, "'blob'")


class ImportRos2(BagTests, CommandTest):
    bags = Ros2

    def split(self, **words):
        """A folder of two files, as rosbag2 splits a recording; the second begins with a topic of its own."""
        street = self.street
        folder = self.folder / "bag"
        folder.mkdir()
        messages = by_time(street.infos(), street.images(), street.fixes(), street.imus())
        Ros2.write(folder / "bag_0.db3", messages[:300], **words)
        Ros2.write(folder / "bag_1.db3", messages[300:], **words)
        (folder / "metadata.yaml").write_text("rosbag2_bagfile_information:\n  version: 4\n")
        return folder

    def test_a_folder_of_files(self):
        self.expect_street(self.run_import(self.split()))

    def test_big_endian(self):
        self.expect_street(self.run_import(self.split(order="big")))

    def test_compressed_messages(self):
        self.expect_street(self.run_import(self.split(packed=zstandard.ZstdCompressor().compress)))
        bag = self.write(*self.small(), name="cut", packed=lambda blob: zstandard.ZstdCompressor().compress(blob)[:-5])
        self.drive = self.folder / "cut"
        self.expect_not_imported(bag, "message 1", "cannot be decompressed")

    def test_kinds_that_are_not_read(self):
        folder = self.folder / "packed"
        folder.mkdir()
        (folder / "packed_0.db3.zstd").write_bytes(zstandard.ZstdCompressor().compress(b"content"))
        self.expect_not_imported(folder, "packed_0.db3.zstd", "zstd -d")
        (folder / "packed_0.db3.zstd").rename(folder / "packed_0.mcap")
        self.expect_not_imported(folder, "packed_0.mcap", "ros2 bag convert")
        bag = self.write(*self.small())
        (self.folder / "street.db3-wal").write_bytes(b"log")
        self.expect_not_imported(bag, "was not closed", "sqlite3")
        (self.folder / "street.db3-wal").unlink()
        database = sqlite3.connect(bag)
        database.execute("UPDATE topics SET serialization_format = 'json' WHERE name = '/fix'")
        database.commit()
        database.close()
        self.expect_not_imported(bag, "/fix", "'json'")
        other = self.folder / "other.db3"
        database = sqlite3.connect(other)
        database.execute("CREATE TABLE topics(id)")
        database.commit()
        database.close()
        self.expect_not_imported(other, "is no bag of ROS 2")

    def test_messages_of_another_length(self):
        for name, packed, parts in (("cut", lambda blob: blob[:-9], ("message 1", "cut short")),
                                    ("long", lambda blob: blob + bytes(8), ("message 1", "bytes too many")),
                                    ("pl", lambda blob: b"\0\3" + blob[2:], ("message 1", "CDR")),
                                    ("none", lambda blob: b"", ("message 1", "CDR"))):
            with self.subTest(name):
                self.expect_not_imported(self.write(*self.small(), name=name, packed=packed), *parts)

    def test_truncated_and_damaged(self):
        bag = self.write(*self.small())
        content = bag.read_bytes()
        draw = random.Random(3)
        cut = self.folder / "cut.db3"
        for length in (1500, 4096, len(content) // 2, len(content) - 4096):
            cut.write_bytes(content[:length])
            self.expect_not_imported(cut, "is no bag in SQLite, or damaged (database disk image is malformed)")
        damages = []
        for _ in range(40):
            at, new = draw.randrange(len(content)), bytes(draw.randrange(256) for _ in range(8))
            damages.append(lambda content, at=at, new=new: with_bytes(content, at, new))
        self.expect_sound_or_refused(bag, damages)


if __name__ == "__main__":
    unittest.main(verbosity=2)
