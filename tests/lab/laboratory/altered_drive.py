#!/usr/bin/python3 -B
"""Copies a drive folder as a camera of wrong calibration would describe it; the laboratory calls it as a stage.

usage: altered_drive.py DRIVE OUT FOCAL_FACTOR YAW_DEG

Focal lengths are multiplied by the factor. A camera yawed clockwise by a small angle sees everything moved to
the left by f tan(angle); so, the frames being as they are, the principal point is moved to the right by as much.
Frames are hard links where the file system allows.
"""
import json
import math
import os
import pathlib
import shutil
import sys

DESCRIPTION = "drive.json"


def altered(description, focal_factor, yaw_deg):
    """The content of a drive.json with the altered camera."""
    camera = description["camera"]
    focal_px = [focal_factor * each for each in camera["focal_px"]]
    x_px, y_px = camera["principal_px"]
    principal_px = [x_px + focal_px[0] * math.tan(math.radians(yaw_deg)), y_px]
    return {**description, "camera": {**camera, "focal_px": focal_px, "principal_px": principal_px}}


def linked_or_copied(source, target):
    try:
        os.link(source, target)
    except OSError:  # another file system
        shutil.copy2(source, target)


def copy_altered(drive, out, focal_factor, yaw_deg):
    description = json.loads((drive / DESCRIPTION).read_text(encoding="utf-8"))
    shutil.copytree(drive, out, copy_function=linked_or_copied, ignore=shutil.ignore_patterns(DESCRIPTION))
    (out / DESCRIPTION).write_text(json.dumps(altered(description, focal_factor, yaw_deg), indent=1) + "\n",
                                   encoding="utf-8")


if __name__ == "__main__":
    copy_altered(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), float(sys.argv[3]), float(sys.argv[4]))
