"""What milepost-client find found in a drive, beside what was recorded, and its figures."""
import dataclasses
import math

import numpy as np

from .fixes import column, read_table
from .road import LocalFrame, earth_centred, geodetic, read_positions

TRACKED = ("tracking", "predicted")  # the states in which the vehicle counts as found
WRONG_M = 10.0                       # farther off than that, it is taken to be in another street
WITHIN_95_SIGMAS = math.sqrt(-2 * math.log(0.05))  # holds 95 % of normal errors in the plane


@dataclasses.dataclass(frozen=True)
class Recording:
    """Where the camera of a drive really was. Arrays have one entry a frame."""

    frame: LocalFrame  # about the first position
    time_s: np.ndarray  # since the first frame
    east_north_m: np.ndarray
    heading_deg: np.ndarray


def read_recording(drive):
    rows = read_table(drive / "trajectory.csv")
    earth_m = np.array(list(read_positions(drive).values()))
    frame = LocalFrame(*geodetic(earth_m[0]))
    time_s = column(rows, "timestamp_s")
    return Recording(frame, time_s - time_s[0], frame.from_earth(earth_m)[:, :2], column(rows, "heading_deg"))


@dataclasses.dataclass(frozen=True)
class FoundRun:
    """Arrays have one entry a frame."""

    time_s: np.ndarray    # since the first frame
    tracked: np.ndarray   # whether the vehicle counts as found
    error_m: np.ndarray   # from the recorded position, along the ground
    turn_deg: np.ndarray  # absolute angle to the recorded heading
    sigma_m: np.ndarray   # as claimed
    latency_ms: np.ndarray

    @property
    def wrong(self):
        return self.tracked & (self.error_m > WRONG_M)

    @property
    def found_after_s(self):
        """NaN where it never is."""
        return float(self.time_s[self.tracked][0]) if self.tracked.any() else math.nan


def read_found(fixes_csv, recording):
    rows = read_table(fixes_csv)
    latitude_deg, longitude_deg = column(rows, "latitude_deg"), column(rows, "longitude_deg")
    height_m = np.full(len(rows), geodetic(recording.frame.origin)[2])
    found_m = recording.frame.from_earth(earth_centred(latitude_deg, longitude_deg, height_m).reshape(-1, 3))[:, :2]
    turn_deg = column(rows, "heading_deg") - recording.heading_deg
    return FoundRun(
        time_s=recording.time_s, tracked=np.array([row["status"] in TRACKED for row in rows]),
        error_m=np.linalg.norm(found_m - recording.east_north_m, axis=1),
        turn_deg=np.abs((turn_deg + 180) % 360 - 180), sigma_m=column(rows, "sigma_m"),
        latency_ms=column(rows, "latency_ms"))


@dataclasses.dataclass(frozen=True)
class FoundFigures:
    """Of one run, or of several together, each frame counting alike. Errors are those of tracked frames; NaN without any."""

    found_after_s: float  # the median of the runs that found the vehicle
    tracked: int
    frames: int
    wrong: int
    mean_m: float
    p50_m: float
    p95_m: float
    mean_turn_deg: float
    within_95: float  # share of errors inside the circle that should hold 95 %, as claimed
    latency_p50_ms: float  # of all frames
    latency_p99_ms: float


def quantile(values, share):
    return float(np.quantile(values, share)) if len(values) else math.nan


def mean(values):
    return float(np.mean(values)) if len(values) else math.nan


def figures_of(runs):
    error_m, turn_deg, sigma_m = (np.concatenate([getattr(run, name)[run.tracked] for run in runs])
                                  for name in ("error_m", "turn_deg", "sigma_m"))
    latency_ms = np.concatenate([run.latency_ms for run in runs])
    return FoundFigures(
        found_after_s=quantile([run.found_after_s for run in runs if run.tracked.any()], 0.5),
        tracked=len(error_m), frames=len(latency_ms), wrong=sum(int(run.wrong.sum()) for run in runs),
        mean_m=mean(error_m), p50_m=quantile(error_m, 0.5), p95_m=quantile(error_m, 0.95),
        mean_turn_deg=mean(turn_deg), within_95=mean(error_m <= WITHIN_95_SIGMAS * sigma_m),
        latency_p50_ms=quantile(latency_ms, 0.5), latency_p99_ms=quantile(latency_ms, 0.99))


@dataclasses.dataclass(frozen=True)
class Course:
    """How runs on one drive went, together. Arrays have one entry a frame; shares are of the runs."""

    time_s: np.ndarray
    low_m: np.ndarray     # a tenth of the runs err by no more
    median_m: np.ndarray
    high_m: np.ndarray    # nine tenths
    right: np.ndarray     # share that tracks the vehicle where it is
    wrong: np.ndarray     # share that tracks it in a wrong place


def course_of(runs):
    error_m = np.stack([run.error_m for run in runs])
    tracked = np.stack([run.tracked for run in runs])
    wrong = np.stack([run.wrong for run in runs])
    low_m, median_m, high_m = np.quantile(error_m, (0.1, 0.5, 0.9), axis=0)
    return Course(runs[0].time_s, low_m, median_m, high_m, (tracked & ~wrong).mean(axis=0), wrong.mean(axis=0))
