"""A segment's line in metres: its curvature, and how far to its side a vehicle drove."""
import csv
import json
import sqlite3

import numpy as np

WGS84_A_M = 6378137.0
WGS84_E2 = 6.69437999014e-3

CURVATURE_WINDOW_M = 20.0  # of road, over which curvature is taken
CURVED_RADIUS_M = 100.0    # a bend of a smaller radius is curved


def earth_centred(latitude_deg, longitude_deg, altitude_m):
    """WGS84 positions as (n, 3) metres, earth centred and earth fixed."""
    latitude, longitude = np.radians(latitude_deg), np.radians(longitude_deg)
    normal_m = WGS84_A_M / np.sqrt(1 - WGS84_E2 * np.sin(latitude) ** 2)
    return np.stack([(normal_m + altitude_m) * np.cos(latitude) * np.cos(longitude),
                     (normal_m + altitude_m) * np.cos(latitude) * np.sin(longitude),
                     (normal_m * (1 - WGS84_E2) + altitude_m) * np.sin(latitude)], axis=-1)


def geodetic(earth_m):
    """Latitude and longitude in degrees and height in metres of an earth-centred position, not at a pole."""
    x_m, y_m, z_m = earth_m
    distance_m = np.hypot(x_m, y_m)
    latitude = np.arctan2(z_m, distance_m * (1 - WGS84_E2))
    for _ in range(3):  # each nearer by orders of magnitude, for heights near the ground
        normal_m = WGS84_A_M / np.sqrt(1 - WGS84_E2 * np.sin(latitude) ** 2)
        latitude = np.arctan2(z_m + WGS84_E2 * normal_m * np.sin(latitude), distance_m)
    return float(np.degrees(latitude)), float(np.degrees(np.arctan2(y_m, x_m))), float(
        distance_m / np.cos(latitude) - normal_m)


class LocalFrame:
    """East, north, up in metres of the tangent plane at an origin."""

    def __init__(self, latitude_deg, longitude_deg, altitude_m):
        self.origin = earth_centred(latitude_deg, longitude_deg, altitude_m)
        sin_lat, cos_lat = np.sin(np.radians(latitude_deg)), np.cos(np.radians(latitude_deg))
        sin_lon, cos_lon = np.sin(np.radians(longitude_deg)), np.cos(np.radians(longitude_deg))
        self.enu_from_earth = np.array([[-sin_lon, cos_lon, 0],
                                        [-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat],
                                        [cos_lat * cos_lon, cos_lat * sin_lon, sin_lat]])

    def from_earth(self, earth_m):
        return (earth_m - self.origin) @ self.enu_from_earth.T

    def to_earth(self, enu_m):
        return enu_m @ self.enu_from_earth + self.origin


class Road:
    """One segment of a map."""

    def __init__(self, along_m, east_north_m, frame=None, altitude_m=0.0):
        self.along_m = np.asarray(along_m, float)  # increasing, one a vertex
        self.east_north_m = np.asarray(east_north_m, float)
        self.frame = frame  # that east and north are of
        self.altitude_m = altitude_m  # of the frame's origin

    @property
    def length_m(self):
        return float(self.along_m[-1])

    @property
    def spacing_m(self):
        """The usual distance of map frames."""
        return float(np.median(np.diff(self.along_m)))

    def at(self, along_m):
        return np.stack([np.interp(along_m, self.along_m, self.east_north_m[:, axis]) for axis in (0, 1)], axis=-1)

    def has_begun_at(self, east_north_m):
        """Whether each position near the line lies after its first vertex."""
        return (east_north_m - self.east_north_m[0]) @ (self.east_north_m[1] - self.east_north_m[0]) >= 0

    def curvature_per_m(self, along_m, window_m=CURVATURE_WINDOW_M):
        """Of the circle through the points half a window before, at, and half a window after; left is positive.

        Within half a window of an end the circle at that distance from the end counts.
        """
        half_m = min(window_m, self.length_m) / 2
        middle_m = np.clip(along_m, half_m, self.length_m - half_m)
        before, at, after = (self.at(middle_m + step_m) for step_m in (-half_m, 0, half_m))
        first, second = at - before, after - at
        twice_area = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
        sides = [np.linalg.norm(side, axis=-1) for side in (first, second, after - before)]
        return 2 * twice_area / np.prod(sides, axis=0)

    def is_curved(self, along_m):
        return np.abs(self.curvature_per_m(along_m)) > 1 / CURVED_RADIUS_M

    def lateral_m(self, east_north_m):
        """Distance of each position from the line; left of it is positive."""
        starts, steps = self.east_north_m[:-1], np.diff(self.east_north_m, axis=0)
        squared_m2 = np.maximum((steps ** 2).sum(axis=1), 1e-12)
        lateral_m = []
        for position in np.atleast_2d(east_north_m):
            to_position = position - starts
            share = np.clip((to_position * steps).sum(axis=1) / squared_m2, 0, 1)
            distance_m = np.linalg.norm(to_position - share[:, None] * steps, axis=1)
            nearest = np.argmin(distance_m)
            side = steps[nearest, 0] * to_position[nearest, 1] - steps[nearest, 1] * to_position[nearest, 0]
            lateral_m.append(np.copysign(distance_m[nearest], side))
        return np.array(lateral_m)


def read_roads(map_file):
    """The segments of a map file, by id (schema/FORMAT.md, section 2)."""
    with sqlite3.connect(f"file:{map_file}?mode=ro&immutable=1", uri=True) as store:
        rows = store.execute("SELECT segment, along_m, latitude_deg, longitude_deg, altitude_m FROM vertices"
                             " ORDER BY segment, position").fetchall()
    roads = {}
    for segment in dict.fromkeys(row[0] for row in rows):
        along_m, *geodetic = np.array([row[1:] for row in rows if row[0] == segment], float).T
        frame = LocalFrame(*(values[0] for values in geodetic))
        roads[segment] = Road(along_m, frame.from_earth(earth_centred(*geodetic))[:, :2], frame,
                              geodetic[2][0])
    return roads


def tracklets_per_m(map_file, layer="tracklets"):
    """Of all segments together."""
    with sqlite3.connect(f"file:{map_file}?mode=ro&immutable=1", uri=True) as store:
        items = store.execute("SELECT sum(items) FROM tiles WHERE layer = ?", [layer]).fetchone()[0] or 0
        return items / store.execute("SELECT sum(length_m) FROM segments").fetchone()[0]


def read_positions(drive):
    """The recorded positions of a drive's frames, earth centred, by file name."""
    description = json.loads((drive / "drive.json").read_text(encoding="utf-8"))
    with (drive / "trajectory.csv").open(newline="", encoding="utf-8") as table:
        header, *rows = list(csv.reader(table))
    del header  # fixed by the drive format
    names = [row[0] for row in rows if row]
    values = np.array([row[2:5] for row in rows if row], float)
    if description["frame"] == "geographic":
        earth_m = earth_centred(*values.T)
    else:
        origin = description["origin"]
        earth_m = LocalFrame(origin["latitude_deg"], origin["longitude_deg"],
                             origin["altitude_m"]).to_earth(values)
    return dict(zip(names, earth_m))
