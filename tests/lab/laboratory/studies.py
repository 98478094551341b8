"""How the error depends on one thing at a time: features, tracklets, map frame spacing, size of the map, the
camera's calibration, lateral offset."""
import dataclasses
import math
import typing

import numpy as np

from . import figures, paper, statistics
from .fixes import read_run
from .road import read_roads, tracklets_per_m
from .runs import AS_RECORDED, Alteration
from .tables import Table, methods_of, of_method

METHODS = ("tracklet-matching", "tracklet-regression", "tracklet-regression-kalman", "inverse-scale", "milepost")
LATERAL_EDGES_M = (0, 0.25, 0.5, 1, 2, 3, 4)
LEAST_FRAMES = 10  # of a point that is drawn
CALIBRATIONS = (AS_RECORDED, Alteration("focal -5 %", ("--focal-factor", "0.95")),
                Alteration("focal +5 %", ("--focal-factor", "1.05")), Alteration("yaw 2°", ("--yaw-deg", "2")))
SIZE, LATERAL = "map (kB/m)", "mean lateral error (m)"  # what a study's second plot shows


@dataclasses.dataclass(frozen=True)
class Study:
    """One thing at several values: an option of milepost-mapper build, whose map stores what the client must follow, or
    an alteration of the query drive."""

    name: str
    title: str
    caption: str
    option: str  # of the mapper, or what the values are
    values: tuple  # numbers, or Alterations
    default: float | None  # of the mapper: needs no map of its own
    x_label: str
    measure: typing.Callable  # (value, map files, PairFixes of a method) -> x
    x_log: bool = False
    methods: tuple = METHODS
    second: str = SIZE
    x_ticks: tuple = ()  # names of x = 0, 1, 2, ...

    @property
    def x_has_column(self):
        """Whether no other column of the table says what x is."""
        return not self.x_ticks and self.x_label != SIZE


@dataclasses.dataclass(frozen=True)
class Outcome:
    """A study's table and figure."""

    title: str
    caption: str
    table: Table
    figure: list  # of plots
    points: dict
    more: Table | None = None  # goes into files only


def mean_over_length(map_files, of_map):
    weights = [sum(road.length_m for road in read_roads(file).values()) for file in map_files]
    return float(np.average([of_map(file) for file in map_files], weights=weights))


def measured_tracklets_per_m(_, map_files, __):
    return mean_over_length(map_files, tracklets_per_m)


def measured_spacing_m(_, map_files, __):
    return mean_over_length(map_files, lambda file: np.mean([road.spacing_m for road in read_roads(file).values()]))


STUDIES = {study.name: study for study in (
    Study("features", "Error against the number of features",
          "At most so many features are kept of each frame, the strongest first, in the map and by the client.",
          "--max-features", (125, 250, 500, 1000, 2000), 1000, "features kept of a frame",
          lambda value, *_: value, x_log=True),
    Study("tracklets", "Error against tracklets a metre",
          "Fewer tracklets because each must have been seen in more frames (3, 4, 5, 6, 8, 10, from right to left).",
          "--min-observations", (3, 4, 5, 6, 8, 10), 3, "tracklets a metre", measured_tracklets_per_m),
    Study("spacing", "Error against map frame spacing",
          "Map frames nearer to the last one than 0.9, 1.9, 2.9, 3.9, 4.9 m are passed over; drawn at the spacing that "
          "remains.", "--min-frame-spacing-m", (0.9, 1.9, 2.9, 3.9, 4.9), 0.3, "distance of map frames (m)", measured_spacing_m),
    Study("size", "Error against the size of the map",
          "The mapper keeps the landmarks that tell the most within so many kB a metre; drawn at the size that came "
          "out.",
          "--size-target-kb-per-m", (0.15, 0.25, 0.35, 0.5, 0.8, 1.5), None, SIZE,
          lambda _, __, fixes: statistics.kb_per_m(fixes), x_log=True, methods=(paper.OURS,), second=LATERAL),
    Study("calibration-error", "Error of a camera of wrong calibration",
          "The query's drive.json says another focal length than the camera has, or a principal point where a camera "
          "yawed by 2° would have it. The true heading is the recorded one, so that a yaw which a method does not find "
          "out is an error of its heading.",
          "calibration", CALIBRATIONS, None, "calibration", lambda value, *_: CALIBRATIONS.index(value),
          methods=("tracklet-regression-kalman", "inverse-scale", paper.OURS), second=LATERAL,
          x_ticks=tuple(calibration.name for calibration in CALIBRATIONS)),
)}


def plan(study, planner, pairs, methods):
    """{value: runs} of a study, to be run."""
    chosen = [method for method in study.methods if method in methods] or list(methods)

    def run(pair, value):
        if isinstance(value, Alteration):
            return planner.run(pair, (), chosen, query=value)
        return planner.run(pair, () if value == study.default else (study.option, str(value)), chosen)

    return {value: [run(pair, value) for pair in pairs] for value in study.values}


def outcome(study, runs):
    """`runs`: {value: runs that are done}."""
    table = Table(
        f"study-{study.name}", study.title, study.caption + " Pairs: " +
        ", ".join(run.pair.name for run in next(iter(runs.values()))) + ".",
        [(study.option, "", None), *([(study.x_label, "", 2)] if study.x_has_column else []), ("method", "", None),
         ("mean", "m", 3), ("std", "m", 3), ("max", "m", 2), ("lateral mean", "m", 3), ("lateral p95", "m", 3),
         ("heading mean", "°", 2), ("map", "kB/m", 2), ("localized", "", 0), ("frames", "", 0)], groups=1)
    points = {}
    for value, runs_of_value in runs.items():
        fixes = [fixes for run in runs_of_value for fixes in read_run(run)]
        map_files = list(dict.fromkeys(run.map_file for run in runs_of_value))
        for method in methods_of(fixes):
            here = of_method(fixes, method)
            x = study.measure(value, map_files, here)
            each, kb_per_m = statistics.figures_of(here), statistics.kb_per_m(here)
            lateral, heading = (statistics.spread_of(statistics.pooled(here, name))
                                for name in ("lateral_error_m", "heading_error_deg"))
            table.rows.append([name_of(value), *([x] if study.x_has_column else []), method, each.mean_m, each.std_m,
                               each.max_m, lateral.mean, lateral.p95, heading.mean, kb_per_m, each.localized,
                               each.frames])
            second = {SIZE: kb_per_m, LATERAL: lateral.mean}[study.second]
            points.setdefault(method, []).append((x, each.mean_m, second))
    points = {method: sorted(values) for method, values in points.items()}
    figure = figures.study_figure(points, study.x_label, study.x_log, study.second, study.x_ticks)
    return Outcome(study.title, table.note, table, figure, points)


def name_of(value):
    return value.name if isinstance(value, Alteration) else f"{value:g}"


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
                   figures.study_figure(points, "distance from the map's line (m)"), points)


def in_offsets(fixes, low_m, high_m):
    offset_m = np.abs(fixes.lateral_m)
    error_m = np.where((offset_m >= low_m) & (offset_m < high_m), fixes.error_m, np.nan)
    return dataclasses.replace(fixes, error_m=error_m)
