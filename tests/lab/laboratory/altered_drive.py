#!/usr/bin/python3 -B
"""Copies a drive folder with something altered; the laboratory calls it as a stage. Give one alteration, or several:

--focal-factor F   the camera is described with focal lengths F times what they are
--yaw-deg D        ... and as if it were not yawed clockwise by D degrees, which it seems to be
--part LOW HIGH    of the frames only the part between these shares, 0 to 1
--spoil KIND       other images: blur, soft, noise, half (the resolution), dark
--record KIND      poses recorded worse: heading (noise of 5 degrees), altitude (1 m), position (0.3 m on each axis),
                   decimals (five of a degree), fifth (only every fifth frame); or wrong: clock (each frame has the pose of
                   the third after it), exchanged (east and north), rear (headings against the direction of travel)
--leap-m M         after a third of the frames so many metres are left out and the times closed up, so that whoever
                   follows is pushed away by as much; the receiver is told at the beginning only
--onto DRIVE       positions and receiver lie on the road of another drive, which the images do not show

A camera yawed clockwise by a small angle sees everything moved to the left by f tan(angle); so, the frames being as
they are, the principal point is moved to the right by as much. Frames are hard links where the file system allows.
"""
import argparse
import csv
import dataclasses
import json
import math
import os
import pathlib
import shutil

RECEIVER_SIGMA_M = 5
METRES_OF_A_DEGREE = 111_200  # of latitude
FRAMES_AFTER_LEAP = 6         # at least
LEAP_MPS = 50                 # at most, beyond the vehicle's own speed: faster drives are refused
JPEG_QUALITY = 90
LOCAL = ("east_m", "north_m", "up_m")


@dataclasses.dataclass
class Drive:
    """A drive folder's texts. Rows are dictionaries of texts, by column; an absent table has none."""

    folder: pathlib.Path
    description: dict
    trajectory: list
    receiver: list
    odometry: list

    @property
    def images(self):
        return self.folder / self.description["images"]


TABLES = {"trajectory": "trajectory.csv", "receiver": "gps.csv", "odometry": "odometry.csv"}


def read_rows(path):
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as table:
        return list(csv.DictReader(table))


def read_drive(folder):
    folder = pathlib.Path(folder)
    description = json.loads((folder / "drive.json").read_text(encoding="utf-8"))
    return Drive(folder, description, *(read_rows(folder / name) for name in TABLES.values()))


def linked_or_copied(source, target):
    try:
        os.link(source, target)
    except OSError:  # another file system
        shutil.copy2(source, target)


def write_drive(drive, out, write_frame=linked_or_copied):
    """`write_frame(source, target)` writes each frame of the trajectory."""
    images = out / drive.description["images"]
    images.mkdir(parents=True)
    (out / "drive.json").write_text(json.dumps(drive.description, indent=1) + "\n", encoding="utf-8")
    for field, name in TABLES.items():
        rows = getattr(drive, field)
        if rows:
            with (out / name).open("w", newline="", encoding="utf-8") as table:
                writer = csv.DictWriter(table, rows[0].keys(), lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows)
    for row in drive.trajectory:
        write_frame(drive.images / row["filename"], images / row["filename"])


def with_camera(drive, change):
    """The drive with another camera; `change` maps drive.json's camera to its differences."""
    camera = drive.description["camera"]
    return dataclasses.replace(drive, description={**drive.description, "camera": {**camera, **change(camera)}})


def miscalibrated(drive, focal_factor, yaw_deg):
    def change(camera):
        focal_px = [focal_factor * each for each in camera["focal_px"]]
        x_px, y_px = camera["principal_px"]
        return {"focal_px": focal_px, "principal_px": [x_px + focal_px[0] * math.tan(math.radians(yaw_deg)), y_px]}
    return with_camera(drive, change)


def part_of(drive, low, high):
    count = len(drive.trajectory)
    return dataclasses.replace(drive, trajectory=drive.trajectory[int(low * count):int(high * count)])


def time_s(row):
    return float(row["timestamp_s"])


def started_at(drive, first, count):
    """So many frames from the first on; the receiver is told once, with the first frame."""
    frames = drive.trajectory[first:first + count]
    begin_s = time_s(frames[0])
    earlier = [row for row in drive.receiver if time_s(row) <= begin_s + 1e-6] or drive.receiver
    known = earlier[-1] if earlier is not drive.receiver else earlier[0]
    odometry = [row for row in drive.odometry if begin_s - 1 <= time_s(row) <= time_s(frames[-1]) + 1]
    return dataclasses.replace(drive, trajectory=frames, odometry=odometry,
                               receiver=[{**known, "timestamp_s": frames[0]["timestamp_s"]}])


def positions_deg(drive):
    """Latitude and longitude of each frame."""
    if drive.description["frame"] == "geographic":
        return [(float(row["latitude_deg"]), float(row["longitude_deg"])) for row in drive.trajectory]
    origin = drive.description["origin"]
    degree_m = METRES_OF_A_DEGREE * math.cos(math.radians(origin["latitude_deg"]))
    return [(origin["latitude_deg"] + float(row["north_m"]) / METRES_OF_A_DEGREE,
             origin["longitude_deg"] + float(row["east_m"]) / degree_m) for row in drive.trajectory]


def distance_m(a_deg, b_deg):
    return math.hypot(a_deg[0] - b_deg[0], (a_deg[1] - b_deg[1]) * math.cos(math.radians(a_deg[0]))) * METRES_OF_A_DEGREE


def leaping(drive, leap_m):
    places, frames = positions_deg(drive), drive.trajectory
    before = len(frames) // 3
    usual_s = time_s(frames[before + 1]) - time_s(frames[before])
    step_s = max(usual_s, leap_m / LEAP_MPS)
    way_m = leap_m + distance_m(places[before], places[before + 1]) * step_s / usual_s
    after = next((index for index in range(before + 1, len(frames) - FRAMES_AFTER_LEAP)
                  if distance_m(places[before], places[index]) >= way_m), len(frames) - FRAMES_AFTER_LEAP)
    from_s, to_s = time_s(frames[before]), time_s(frames[after])
    shift_s = to_s - from_s - step_s

    def closed_up(rows):
        return [*(row for row in rows if time_s(row) <= from_s),
                *({**row, "timestamp_s": f"{time_s(row) - shift_s:.4f}"} for row in rows if time_s(row) >= to_s)]

    return dataclasses.replace(drive, trajectory=closed_up(frames), odometry=closed_up(drive.odometry),
                               receiver=drive.receiver[:1])


def laid_onto(drive, other):
    """Frames are spread over the other road evenly, so that both are driven from end to end."""
    road_deg = positions_deg(other)
    count = len(drive.trajectory)
    trajectory, receiver, told_s = [], [], -math.inf
    for index, row in enumerate(drive.trajectory):
        place = min(len(road_deg) - 1, index * len(road_deg) // count)
        positions = {name: value for name, value in other.trajectory[place].items() if name not in ("filename", "timestamp_s")}
        trajectory.append({"filename": row["filename"], "timestamp_s": row["timestamp_s"], **positions})
        if time_s(row) - told_s >= 1:
            told_s = time_s(row)
            latitude_deg, longitude_deg = road_deg[place]
            receiver.append({"timestamp_s": row["timestamp_s"], "latitude_deg": f"{latitude_deg:.8f}",
                             "longitude_deg": f"{longitude_deg:.8f}", "sigma_m": str(RECEIVER_SIGMA_M)})
    frame = {key: other.description[key] for key in ("frame", "origin") if key in other.description}
    description = {key: value for key, value in drive.description.items() if key not in ("frame", "origin")}
    return dataclasses.replace(drive, description={**description, **frame}, trajectory=trajectory, receiver=receiver)


def with_noise(drive, sigmas):
    """Independent from frame to frame, on these columns."""
    import numpy as np
    random = np.random.default_rng(7)
    trajectory = [{**row, **{name: f"{float(row[name]) + random.normal(0, sigma):.6f}" for name, sigma in sigmas.items()}}
                  for row in drive.trajectory]
    return dataclasses.replace(drive, trajectory=trajectory)


def geographic(drive):
    """The same drive with latitudes and longitudes."""
    if drive.description["frame"] == "geographic":
        return drive
    from road import LocalFrame, geodetic  # beside this script
    origin = drive.description["origin"]
    frame = LocalFrame(origin["latitude_deg"], origin["longitude_deg"], origin["altitude_m"])
    trajectory = []
    for row in drive.trajectory:
        latitude_deg, longitude_deg, altitude_m = geodetic(frame.to_earth([float(row[name]) for name in LOCAL]))
        trajectory.append({"filename": row["filename"], "timestamp_s": row["timestamp_s"],
                           "latitude_deg": f"{latitude_deg:.11f}", "longitude_deg": f"{longitude_deg:.11f}",
                           "altitude_m": f"{altitude_m:.6f}", "heading_deg": row["heading_deg"]})
    description = {key: value for key, value in drive.description.items() if key != "origin"}
    return dataclasses.replace(drive, description={**description, "frame": "geographic"}, trajectory=trajectory)


def rounded(drive):
    drive = geographic(drive)
    return dataclasses.replace(drive, trajectory=[
        {**row, **{name: f"{float(row[name]):.5f}" for name in ("latitude_deg", "longitude_deg")}} for row in drive.trajectory])


def with_position_noise(drive):
    if drive.description["frame"] == "local":
        return with_noise(drive, dict.fromkeys(LOCAL, 0.3))
    latitude_deg, _ = positions_deg(drive)[0]
    degree_m = METRES_OF_A_DEGREE * math.cos(math.radians(latitude_deg))
    noisy_drive = with_noise(drive, {"altitude_m": 0.3})
    import numpy as np
    random = np.random.default_rng(8)
    return dataclasses.replace(noisy_drive, trajectory=[
        {**row, "latitude_deg": f"{float(row['latitude_deg']) + random.normal(0, 0.3 / METRES_OF_A_DEGREE):.11f}",
         "longitude_deg": f"{float(row['longitude_deg']) + random.normal(0, 0.3 / degree_m):.11f}"}
        for row in noisy_drive.trajectory])


def altitude_of(drive):
    return "up_m" if drive.description["frame"] == "local" else "altitude_m"


RECORDS = {"heading": lambda drive: with_noise(drive, {"heading_deg": 5}),
           "altitude": lambda drive: with_noise(drive, {altitude_of(drive): 1}),
           "position": with_position_noise,
           "decimals": rounded,
           "fifth": lambda drive: dataclasses.replace(drive, trajectory=drive.trajectory[::5])}


def exchanged(drive):
    """East and north, or latitude and longitude as far as they change."""
    if drive.description["frame"] == "local":
        return dataclasses.replace(drive, trajectory=[{**row, "east_m": row["north_m"], "north_m": row["east_m"]}
                                                      for row in drive.trajectory])
    first = {name: float(drive.trajectory[0][name]) for name in ("latitude_deg", "longitude_deg")}
    shrink = math.cos(math.radians(first["latitude_deg"]))
    return dataclasses.replace(drive, trajectory=[
        {**row, "latitude_deg": f"{first['latitude_deg'] + (float(row['longitude_deg']) - first['longitude_deg']) * shrink:.11f}",
         "longitude_deg": f"{first['longitude_deg'] + (float(row['latitude_deg']) - first['latitude_deg']) / shrink:.11f}"}
        for row in drive.trajectory])


def late(drive, frames=3):
    """Each frame has the pose of one that was taken later."""
    rows = drive.trajectory
    return dataclasses.replace(drive, trajectory=[{**later, "filename": row["filename"], "timestamp_s": row["timestamp_s"]}
                                                  for row, later in zip(rows, rows[frames:])])


def looking_back(drive):
    return dataclasses.replace(drive, trajectory=[{**row, "heading_deg": f"{(float(row['heading_deg']) + 180) % 360:.6f}"}
                                                  for row in drive.trajectory])


# Not only worse but wrong.
FAULTS = {**RECORDS, "clock": late, "exchanged": exchanged, "rear": looking_back}


def motion_blurred(image):
    """As of a camera that moved to the side, 4 px."""
    import numpy as np
    from PIL import Image
    weights = np.exp(-np.arange(13) ** 2 / 32)
    grey = np.asarray(image, float)
    padded = np.pad(grey, ((0, 0), (len(weights) - 1, 0)), mode="edge")
    sums = sum(weight * padded[:, lag:lag + grey.shape[1]] for lag, weight in enumerate(weights[::-1]))
    return Image.fromarray(np.round(sums / weights.sum()).astype(np.uint8))


def noisy(image):
    import numpy as np
    from PIL import Image
    grey = np.asarray(image, float)
    noise = np.random.default_rng(7).normal(0, 12, grey.shape)
    return Image.fromarray(np.clip(np.round(grey + noise), 0, 255).astype(np.uint8))


def soft(image):
    from PIL import ImageFilter
    return image.filter(ImageFilter.GaussianBlur(1.5))


SPOILS = {"blur": motion_blurred, "soft": soft, "noise": noisy,
          "half": lambda image: image.reduce(2),
          "dark": lambda image: image.point(lambda value: value // 3)}


def spoilt_writer(kind):
    from PIL import Image

    def write_frame(source, target):
        with Image.open(source) as image:
            SPOILS[kind](image.convert("L")).save(target, quality=JPEG_QUALITY)
    return write_frame


def halved(camera):
    """Of the camera of images of half the resolution; the centre of the first pixel is (0, 0)."""
    return {"width_px": (camera["width_px"] + 1) // 2, "height_px": (camera["height_px"] + 1) // 2,
            "focal_px": [each / 2 for each in camera["focal_px"]],
            "principal_px": [(each + 0.5) / 2 - 0.5 for each in camera["principal_px"]]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("drive", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--focal-factor", type=float, default=1)
    parser.add_argument("--yaw-deg", type=float, default=0)
    parser.add_argument("--part", type=float, nargs=2)
    parser.add_argument("--spoil", choices=SPOILS)
    parser.add_argument("--record", choices=FAULTS)
    parser.add_argument("--leap-m", type=float)
    parser.add_argument("--onto", type=pathlib.Path)
    options = parser.parse_args()
    drive = miscalibrated(read_drive(options.drive), options.focal_factor, options.yaw_deg)
    if options.part:
        drive = part_of(drive, *options.part)
    if options.record:
        drive = FAULTS[options.record](drive)
    if options.leap_m:
        drive = leaping(drive, options.leap_m)
    if options.onto:
        drive = laid_onto(drive, read_drive(options.onto))
    if options.spoil == "half":
        drive = with_camera(drive, halved)
    write_drive(drive, options.out, spoilt_writer(options.spoil) if options.spoil else linked_or_copied)


if __name__ == "__main__":
    main()
