"""Figures 10 and 11 of the aerial paper, from our data: the error over time of several runs."""
import numpy as np

from .drawing import axis, layer, line, plot, texts
from .figures import log_ends, shown
from .found import course_of

PAPER_MEAN_M = 3.40  # once converged, or from a known start


def error_over_time(runs):
    """Each run, their median and the middle eight tenths; below, the share of runs that track the vehicle."""
    course = course_of(runs)
    time_s, end_s = course.time_s, max(float(course.time_s[-1]), 0.1)
    low, high = log_ends([*(shown(run.error_m) for run in runs), np.array([PAPER_MEAN_M])])
    error = plot(
        [layer("band", time_s, shown(course.high_m), "middle eight tenths", low=[float(value) for value in shown(course.low_m)],
               colour="m0", opacity=0.15),
         *(line(run.time_s, shown(run.error_m), "a run", "m0", 0.7, opacity=0.3) for run in runs),
         line(time_s, shown(course.median_m), "median", "m0", 2),
         line([0, end_s], [PAPER_MEAN_M] * 2, None, "muted", 1, dash=[2, 4]),
         texts([end_s], [PAPER_MEAN_M], [f"the paper's mean, {PAPER_MEAN_M:.2f} m"], "right", (-4, -5))],
        axis("time (s)", 0, end_s, 1), axis("error (m)", low, high, log=True), 260,
        title=f"error of {len(runs)} runs, their median and middle eight tenths")
    right, tracked = 100 * course.right, 100 * (course.right + course.wrong)
    share = plot(
        [layer("area", time_s, tracked, "in a wrong place", colour="m1", opacity=0.45),
         layer("area", time_s, right, colour="page"), layer("area", time_s, right, "where it is", colour="m0", opacity=0.3),
         line(time_s, right, None, "m0"), line(time_s, tracked, "tracked", "ink", dash=[2, 2])],
        axis("time (s)", 0, end_s, 1), axis("runs (%)", 0, 103, 0), 150,
        title="runs that track the vehicle: where it is (below), and in a wrong place (above)")
    return [error, share]
