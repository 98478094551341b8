"""How well milepost-mapper aerial finds the walls of buildings, with and without each of its stages.

Outlines and walls are sampled each 0.25 m. Completeness is the share of the outlines' points, of those in the image, that
have a point of a wall within 1 m whose direction differs by 15 degrees at most; correctness is the share of the walls'
points that have such a point of an outline; F1 is their harmonic mean.
"""
import argparse
import dataclasses
import json
import pathlib
import sqlite3
import subprocess
import sys
import tempfile

import numpy
from scipy.spatial import cKDTree

STEP_M = 0.25
REACH_M = 1.0
MAX_ANGLE_RAD = numpy.radians(15)
STAGES = ("shadows", "vegetation", "progressive", "roofs", "merging", "closure", "corners")


@dataclasses.dataclass(frozen=True)
class Frame:
    """Metres east and north of a place, good to a millimetre over a few hundred metres."""
    latitude_deg: float
    longitude_deg: float

    def metres(self, positions):
        """From rows of [longitude, latitude]."""
        sine, cosine = numpy.sin(numpy.radians(self.latitude_deg)), numpy.cos(numpy.radians(self.latitude_deg))
        flat = 1 - 0.00669437999014 * sine * sine  # of the first eccentricity's square of WGS84
        north_m = numpy.radians(6378137 * 0.99330562000986 / flat ** 1.5)
        east_m = numpy.radians(6378137 * cosine / flat ** 0.5)
        away_deg = numpy.asarray(positions, float) - [self.longitude_deg, self.latitude_deg]
        return away_deg * [east_m, north_m]


@dataclasses.dataclass(frozen=True)
class Points:
    """Sampled lines: positions in metres, directions in radians."""
    at_m: numpy.ndarray
    angle_rad: numpy.ndarray

    def of(self, mask):
        return Points(self.at_m[mask], self.angle_rad[mask])


def sampled(lines_m):
    """Points on lines, each an array of two rows [east, north]."""
    at_m, angle_rad = [numpy.empty((0, 2))], [numpy.empty(0)]
    for begin, end in lines_m:
        length_m = numpy.hypot(*(end - begin))
        if length_m == 0:
            continue
        count = int(numpy.ceil(length_m / STEP_M))
        share = (numpy.arange(count) + 0.5) / count
        at_m.append(begin + share[:, None] * (end - begin))
        angle_rad.append(numpy.full(count, numpy.arctan2(*(end - begin)[::-1])))
    return Points(numpy.concatenate(at_m), numpy.concatenate(angle_rad))


def share_met(points, others):
    """The share of `points` that have one of `others` near, of their direction; 0 where there are no points."""
    if len(points.at_m) == 0 or len(others.at_m) == 0:
        return 0.0
    met = 0
    near = cKDTree(others.at_m).query_ball_point(points.at_m, REACH_M)
    for angle_rad, numbers in zip(points.angle_rad, near):
        turn_rad = (others.angle_rad[numbers] - angle_rad + numpy.pi / 2) % numpy.pi - numpy.pi / 2
        met += bool(numpy.any(numpy.abs(turn_rad) <= MAX_ANGLE_RAD))
    return met / len(points.at_m)


@dataclasses.dataclass(frozen=True)
class Score:
    walls: int
    completeness: float
    correctness: float

    @property
    def f1(self):
        both = self.completeness + self.correctness
        return 2 * self.completeness * self.correctness / both if both else 0.0


def rings_of(geojson):
    for feature in json.loads(geojson)["features"]:
        geometry = feature["geometry"]
        polygons = [geometry["coordinates"]] if geometry["type"] == "Polygon" else geometry["coordinates"]
        for polygon in polygons:
            for ring in polygon:
                yield [position[:2] for position in ring]


def score(walls, outlines, bounds):
    """Walls (pairs of positions) against outlines (rings of positions), of which those in the box count as missed."""
    west, south, east, north = (bounds[side] for side in ("west_deg", "south_deg", "east_deg", "north_deg"))
    frame = Frame((south + north) / 2, (west + east) / 2)
    low, high = frame.metres([[west, south], [east, north]])
    found = sampled([frame.metres(wall) for wall in walls])
    rings_m = [frame.metres(ring) for ring in outlines]
    true = sampled([(ring[i], ring[i + 1]) for ring in rings_m for i in range(len(ring) - 1)])
    inside = numpy.all((true.at_m > low) & (true.at_m < high), axis=1)
    return Score(len(walls), share_met(true.of(inside), found), share_met(found, true))


def mapped(mapper, image, *words):
    """Walls that the mapper finds in an image, and the box of the image."""
    with tempfile.TemporaryDirectory() as folder:
        map_file, lines = pathlib.Path(folder) / "walls.map", pathlib.Path(folder) / "walls.geojson"
        for call in (("aerial", "--image", image, "--map", map_file, "--allow-empty", *words),
                     ("export", "--map", map_file, "--layer", "walls", "--geojson", lines)):
            result = subprocess.run([mapper, *call], capture_output=True, text=True, check=False)
            if result.returncode != 0:
                raise RuntimeError(result.stderr.strip())
        with sqlite3.connect(f"file:{map_file}?immutable=1", uri=True) as database:
            (parameters,), = database.execute("SELECT parameters FROM layers WHERE name = 'walls'")
        walls = [feature["geometry"]["coordinates"] for feature in json.loads(lines.read_text())["features"]]
        return walls, json.loads(parameters)["bounds"]


def scored(mapper, image, outlines, *words):
    walls, bounds = mapped(mapper, image, *words)
    return score(walls, list(rings_of(pathlib.Path(outlines).read_text())), bounds)


def main():
    parser = argparse.ArgumentParser(prog="tests/lab/walls", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mapper", help="the program milepost-mapper")
    parser.add_argument("image", help="an orthoimage")
    parser.add_argument("outlines", help="GeoJSON of the true outlines of buildings")
    parser.add_argument("options", nargs="*", help="further options of milepost-mapper aerial, after --")
    arguments = parser.parse_args()
    print(f"{'':22} {'walls':>6} {'complete':>9} {'correct':>8} {'F1':>6}")
    for name, left_out in (("all stages", ()), *((f"without {stage}", (stage,)) for stage in STAGES),
                           ("the paper's", ("roofs", "corners"))):
        words = [word for stage in left_out for word in ("--without", stage)]
        try:
            found = scored(arguments.mapper, arguments.image, arguments.outlines, *words, *arguments.options)
        except RuntimeError as error:
            sys.exit(str(error))
        print(f"{name:22} {found.walls:6} {found.completeness:9.3f} {found.correctness:8.3f} {found.f1:6.3f}",
              flush=True)


if __name__ == "__main__":
    main()
