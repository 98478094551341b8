"""What the evaluations found, one frame after another, ready for counting."""
import csv
import dataclasses
import json

import numpy as np

from .road import read_positions, read_roads


# The arrays of a PairFixes.
OF_FRAMES = ("truth_along_m", "error_m", "sigma_m", "curved", "lateral_m", "lateral_error_m", "lateral_sigma_m",
             "heading_error_deg", "latency_ms")


@dataclasses.dataclass
class PairFixes:
    """One method on one pair. Arrays have one entry a frame of the query, NaN where there is no fix."""

    pair: str
    method: str
    truth_along_m: np.ndarray
    error_m: np.ndarray  # signed: fix minus truth
    sigma_m: np.ndarray  # against the map: maps and queries of the lists have one truth
    curved: np.ndarray     # whether the map's line is curved there
    lateral_m: np.ndarray  # of the recorded position, left of the map's line is positive
    lateral_error_m: np.ndarray    # signed; NaN, too, where the method knows no lateral
    lateral_sigma_m: np.ndarray    # likewise
    heading_error_deg: np.ndarray  # signed; NaN where the method knows no heading
    latency_ms: np.ndarray         # differs from run to run
    map_kb_per_m: float
    map_length_m: float
    map_name: str

    @property
    def localized(self):
        return np.isfinite(self.error_m)

    @property
    def absolute_m(self):
        """Absolute errors of the localized frames."""
        return np.abs(self.error_m[self.localized])


def read_table(path):
    with path.open(newline="", encoding="utf-8") as table:
        return list(csv.DictReader(table))


def column(rows, name):
    """A column as numbers; empty cells are NaN."""
    return np.array([float(row[name]) if row[name] else np.nan for row in rows])


def sigmas_against_map(rows):
    """Along and lateral. The map's own error, which a fix's sigmas hold, is the same in all directions in plan."""
    along_m, lateral_m, along_map_m = (column(rows, name) for name in ("sigma_m", "lateral_sigma_m", "sigma_map_m"))
    return along_map_m, np.sqrt(np.maximum(lateral_m ** 2 - np.maximum(along_m ** 2 - along_map_m ** 2, 0), 0))


def read_run(run):
    """A list of PairFixes, one a method, from a run whose stages are done."""
    roads = read_roads(run.map_file)
    positions = read_positions(run.query_drive)
    folder = run.evaluation.result
    summaries = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    return [read_method(run, folder, summary, roads, positions) for summary in summaries]


def read_method(run, folder, summary, roads, positions):
    rows = read_table(folder / f"fixes-{summary['method']}.csv")
    truth_along_m = column(rows, "truth_along_m")
    curved = np.zeros(len(rows), bool)
    lateral_m = np.full(len(rows), np.nan)
    sigma_m, lateral_sigma_m = sigmas_against_map(rows)
    segments = np.array([row["segment"] for row in rows])
    for segment in sorted(set(segments) - {""}):
        road, here = roads[segment], segments == segment
        curved[here] = road.is_curved(truth_along_m[here])
        earth_m = np.array([positions[row["filename"]] for row in rows if row["segment"] == segment])
        lateral_m[here] = road.lateral_m(road.frame.from_earth(earth_m)[:, :2])
    return PairFixes(
        pair=run.pair.name, method=summary["method"], truth_along_m=truth_along_m,
        error_m=column(rows, "error_m"), sigma_m=sigma_m, curved=curved, lateral_m=lateral_m,
        lateral_error_m=column(rows, "lateral_error_m"), lateral_sigma_m=lateral_sigma_m,
        heading_error_deg=column(rows, "heading_error_deg"), latency_ms=column(rows, "latency_ms"),
        map_kb_per_m=summary["map_kb_per_m"] or np.nan,
        map_length_m=sum(road.length_m for road in roads.values()), map_name=run.map_stage.result.name)


def read_estimates(run, method):
    """Per-tracklet errors v_k in metres of a method (columns error_m and more), or None without them."""
    path = run.evaluation.result / f"estimates-{method}.csv"
    return read_table(path) if path.is_file() else None


def read_regressions(run):
    """Observations of sample tracklets, or None without them."""
    path = run.evaluation.result / "regressions.csv"
    return read_table(path) if path.is_file() else None
