"""How the error depends on one thing at a time: features, tracklets, map frame spacing, lateral offset."""
import dataclasses
import math
import typing

import numpy as np

from . import figures, statistics
from .fixes import read_run
from .road import read_roads, tracklets_per_m
from .tables import Table, methods_of, of_method

METHODS = ("tracklet-matching", "tracklet-regression", "tracklet-regression-kalman", "milepost")
LATERAL_EDGES_M = (0, 0.25, 0.5, 1, 2, 3, 4)
LEAST_FRAMES = 10  # of a point that is drawn


@dataclasses.dataclass(frozen=True)
class Study:
    """One option of milepost-mapper build at several values; the map stores what the client must follow."""

    name: str
    title: str
    caption: str
    option: str
    values: tuple
    default: float  # of the mapper: needs no map of its own
    x_label: str
    measure: typing.Callable  # (value, map files) -> x
    x_log: bool = False


@dataclasses.dataclass(frozen=True)
class Outcome:
    """A study's table and figure."""

    title: str
    caption: str
    table: Table
    figure: str
    points: dict


def mean_over_length(map_files, of_map):
    weights = [sum(road.length_m for road in read_roads(file).values()) for file in map_files]
    return float(np.average([of_map(file) for file in map_files], weights=weights))


def measured_tracklets_per_m(_, map_files):
    return mean_over_length(map_files, tracklets_per_m)


def measured_spacing_m(_, map_files):
    return mean_over_length(map_files, lambda file: np.mean([road.spacing_m for road in read_roads(file).values()]))


STUDIES = {study.name: study for study in (
    Study("features", "Error against the number of features",
          "At most so many features are kept of each frame, the strongest first, in the map and by the client.",
          "--max-features", (125, 250, 500, 1000, 2000), 1000, "features kept of a frame",
          lambda value, _: value, x_log=True),
    Study("tracklets", "Error against tracklets a metre",
          "Fewer tracklets because each must have been seen in more frames (3, 4, 5, 6, 8, 10, from right to left).",
          "--min-observations", (3, 4, 5, 6, 8, 10), 3, "tracklets a metre", measured_tracklets_per_m),
    Study("spacing", "Error against map frame spacing",
          "Map frames nearer to the last one than 0.9, 1.9, 2.9, 3.9, 4.9 m are passed over; drawn at the spacing that "
          "remains.", "--min-frame-spacing-m", (0.9, 1.9, 2.9, 3.9, 4.9), 0.3, "distance of map frames (m)", measured_spacing_m),
)}
NAMES = (*STUDIES, "lateral")


def plan(study, planner, pairs, methods):
    """{value: runs} of a study, to be run."""
    chosen = [method for method in METHODS if method in methods] or list(methods)
    return {value: [planner.run(pair, () if value == study.default else (study.option, str(value)), chosen)
                    for pair in pairs] for value in study.values}


def outcome(study, runs, query_drive):
    """`runs`: {value: runs that are done}; `query_drive(pair)`: the drive's folder."""
    table = Table(
        f"study-{study.name}", study.title, study.caption + " Pairs: " +
        ", ".join(run.pair.name for run in next(iter(runs.values()))) + ".",
        [(study.option, "", None), (study.x_label, "", 2), ("method", "", None), ("mean", "m", 3), ("std", "m", 3),
         ("max", "m", 2), ("map", "kB/m", 2), ("localized", "", 0), ("frames", "", 0)], groups=1)
    points = {}
    for value, runs_of_value in runs.items():
        fixes = [fixes for run in runs_of_value for fixes in read_run(run, query_drive(run.pair))]
        x = study.measure(value, list(dict.fromkeys(run.map_file for run in runs_of_value)))
        for method in methods_of(fixes):
            here = of_method(fixes, method)
            each, kb_per_m = statistics.figures_of(here), statistics.kb_per_m(here)
            table.rows.append([f"{value:g}", x, method, each.mean_m, each.std_m, each.max_m, kb_per_m, each.localized,
                               each.frames])
            points.setdefault(method, []).append((x, each.mean_m, kb_per_m))
    points = {method: sorted(values) for method, values in points.items()}
    return Outcome(study.title, table.note, table, figures.study_figure(points, study.x_label, study.x_log), points)


def lateral_outcome(fixes):
    """Of the runs of Table 1: frames by how far to the side of the map's line they were recorded."""
    table = Table(
        "study-lateral", "Error against lateral offset",
        "Frames of all pairs by the distance of their recorded position from the line of the map's drive. "
        f"Points of fewer than {LEAST_FRAMES} frames are not drawn.",
        [("offset", "m", None), ("mean offset", "m", 2), ("method", "", None), ("mean", "m", 3), ("std", "m", 3),
         ("max", "m", 2), ("localized", "", 0)], groups=1)
    points = {}
    for low_m, high_m in zip(LATERAL_EDGES_M, (*LATERAL_EDGES_M[1:], math.inf)):
        for method in methods_of(fixes):
            inside = [in_offsets(each, low_m, high_m) for each in of_method(fixes, method)]
            each = statistics.figures_of(inside)
            if not each.localized:
                continue
            offset_m = float(np.concatenate([np.abs(f.lateral_m[f.localized]) for f in inside]).mean())
            label = f"{low_m:g} to {high_m:g}" if math.isfinite(high_m) else f"over {low_m:g}"
            table.rows.append([label, offset_m, method, each.mean_m, each.std_m, each.max_m, each.localized])
            if each.localized >= LEAST_FRAMES:
                points.setdefault(method, []).append((offset_m, each.mean_m, math.nan))
    return Outcome(table.title, table.note, table,
                   figures.study_figure(points, "distance from the map's line (m)", with_size=False), points)


def in_offsets(fixes, low_m, high_m):
    offset_m = np.abs(fixes.lateral_m)
    error_m = np.where((offset_m >= low_m) & (offset_m < high_m), fixes.error_m, np.nan)
    return dataclasses.replace(fixes, error_m=error_m)
