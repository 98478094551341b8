"""Bags of ROS, written by other programs than the mapper reads them with: of ROS 1 by Debian's rosbag, of ROS 2 with
messages that eProsima's Fast CDR serialises (cdr-encoder), in the tables that rosbag2 makes.

A message is a dictionary of the fields that matter, with its kind and its time: see the methods of Ros1 and Ros2."""
import os
import sqlite3
import struct
import subprocess

import rosbag
import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, Imu, NavSatFix

CDR_ENCODER = os.environ.get("MILEPOST_CDR_ENCODER", "")


class Message:
    def __init__(self, topic, kind, time_ns, **fields):
        self.topic, self.kind, self.time_ns, self.fields = topic, kind, time_ns, fields


class Ros1:
    layout, ending = "ros1", ".bag"

    @staticmethod
    def message(message):
        f = message.fields
        m = {"image": Image, "compressed": CompressedImage, "info": CameraInfo, "fix": NavSatFix, "imu": Imu,
             "odometry": Odometry}[message.kind]()
        m.header.stamp = rospy.Time(message.time_ns // 10**9, message.time_ns % 10**9)
        m.header.frame_id = "frame"
        if message.kind == "image":
            m.height, m.width, m.encoding, m.step, m.data = (f[key] for key in ("height", "width", "encoding", "step", "data"))
        elif message.kind == "compressed":
            m.format, m.data = f["format"], f["data"]
        elif message.kind == "info":
            m.height, m.width, m.distortion_model, m.D, m.K, m.P = (
                f[key] for key in ("height", "width", "model", "D", "K", "P"))
        elif message.kind == "fix":
            m.status.status = f.get("status", 0)
            m.latitude, m.longitude, m.altitude = f["position"]
        else:
            pose = m.pose.pose if message.kind == "odometry" else m
            for axis, value in zip("xyzw", f["rotation"]):
                setattr(pose.orientation, axis, value)
            if message.kind == "imu":
                m.orientation_covariance[0] = f.get("covariance", 0)
            else:
                m.child_frame_id = "base_link"
                for axis, value in zip("xyz", f["position"]):
                    setattr(pose.position, axis, value)
        return m

    @classmethod
    def write(cls, file, messages, compression="none", chunk_threshold=768 * 1024):
        with rosbag.Bag(str(file), "w", compression=compression, chunk_threshold=chunk_threshold) as bag:
            for message in messages:
                # Recorded after it was stamped.
                bag.write(message.topic, cls.message(message),
                          rospy.Time(message.time_ns // 10**9 + 1, message.time_ns % 10**9))


class Ros2:
    layout, ending = "ros2", ".db3"
    types = {"image": "sensor_msgs/msg/Image", "compressed": "sensor_msgs/msg/CompressedImage",
             "info": "sensor_msgs/msg/CameraInfo", "fix": "sensor_msgs/msg/NavSatFix", "imu": "sensor_msgs/msg/Imu",
             "odometry": "nav_msgs/msg/Odometry"}

    @staticmethod
    def fields(message):
        """The fields in the order of the message's definition, as cdr-encoder reads them."""
        f = message.fields
        yield from (f"i32:{message.time_ns // 10**9}", f"u32:{message.time_ns % 10**9}", "text:frame")

        def numbers(values):
            return [f"f64:{value!r}" for value in values]

        if message.kind == "image":
            yield from (f"u32:{f['height']}", f"u32:{f['width']}", f"text:{f['encoding']}", "u8:0", f"u32:{f['step']}",
                        f"bytes:{f['data'].hex()}")
        elif message.kind == "compressed":
            yield from (f"text:{f['format']}", f"bytes:{f['data'].hex()}")
        elif message.kind == "info":
            yield from (f"u32:{f['height']}", f"u32:{f['width']}", f"text:{f['model']}",
                        "f64s:" + ",".join(map(repr, f["D"])), *numbers(f["K"]), *numbers([0.0] * 9), *numbers(f["P"]),
                        *["u32:0"] * 6, "u8:0")
        elif message.kind == "fix":
            yield from (f"i8:{f.get('status', 0)}", "u16:1", *numbers(f["position"]), *numbers([0.0] * 9), "u8:0")
        elif message.kind == "imu":
            yield from (*numbers(f["rotation"]), *numbers([float(f.get("covariance", 0))] + [0.0] * 8), *numbers([0.0] * 24))
        else:
            yield from ("text:base_link", *numbers(f["position"]), *numbers(f["rotation"]), *numbers([0.0] * 78))

    @classmethod
    def encoded(cls, messages, order="little"):
        lines = "".join(" ".join(cls.fields(message)) + "\n" for message in messages)
        output = subprocess.run([CDR_ENCODER, order], input=lines.encode(), capture_output=True, check=True).stdout
        blobs = []
        while output:
            length, = struct.unpack_from("=I", output)
            blobs.append(output[4:4 + length])
            output = output[4 + length:]
        return blobs

    @classmethod
    def write(cls, file, messages, order="little", packed=lambda blob: blob):
        database = sqlite3.connect(file)
        database.executescript(
            "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);"
            "CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);"
            "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
            "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
            "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, "
            "data BLOB NOT NULL);"
            "CREATE INDEX timestamp_idx ON messages (timestamp ASC);")
        ids = {}
        for message, blob in zip(messages, cls.encoded(messages, order)):
            if message.topic not in ids:
                ids[message.topic] = len(ids) + 1
                database.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')",
                                 (ids[message.topic], message.topic, cls.types[message.kind]))
            database.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)",
                             (ids[message.topic], message.time_ns + 10**9, packed(blob)))
        database.commit()
        database.close()
