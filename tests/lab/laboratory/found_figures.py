"""Figures 10 and 11 of the aerial paper, from our data: the error over time of several runs."""
import numpy as np

from .drawing import INK, MUTED, STAND_INS, drawn
from .figures import LEAST_SHOWN_M, logarithmic
from .found import course_of

PAPER_MEAN_M = 3.40  # once converged, or from a known start
ERROR, WRONG = STAND_INS["m0"], STAND_INS["m1"]


def error_over_time(runs):
    """Each run, their median and the middle eight tenths; below, the share of runs that track the vehicle."""
    course = course_of(runs)

    def shown(error_m):
        return np.maximum(error_m, LEAST_SHOWN_M)

    def draw(axes):
        error, share = axes[:, 0]
        for run in runs:
            error.plot(run.time_s, shown(run.error_m), color=ERROR, alpha=0.3, linewidth=0.7)
        error.fill_between(course.time_s, shown(course.low_m), shown(course.high_m), color=ERROR, alpha=0.15, linewidth=0)
        error.plot(course.time_s, shown(course.median_m), color=ERROR, linewidth=2)
        error.axhline(PAPER_MEAN_M, color=MUTED, linestyle=(0, (2, 3)), linewidth=1)
        error.annotate(f"the paper's mean, {PAPER_MEAN_M:.2f} m", (1, PAPER_MEAN_M), (-2, 3), color=MUTED, fontsize=8,
                       xycoords=("axes fraction", "data"), textcoords="offset points", ha="right")
        logarithmic(error, "y")
        error.set(ylabel="error (m)", title=f"error of {len(runs)} runs, their median and middle eight tenths")
        right, tracked = 100 * course.right, 100 * (course.right + course.wrong)
        share.fill_between(course.time_s, right, color=ERROR, alpha=0.3, linewidth=0)
        share.fill_between(course.time_s, right, tracked, color=WRONG, alpha=0.45, linewidth=0)
        share.plot(course.time_s, right, color=ERROR)
        share.plot(course.time_s, tracked, color=INK, linestyle=(0, (1.2, 1.2)))
        share.set(ylabel="runs (%)", xlabel="time (s)", ylim=(0, 103), xlim=(0, course.time_s[-1]),
                  title="runs that track the vehicle: where it is (below), and in a wrong place (above)")

    return drawn(2, 1, 5.2, draw, sharex=True, gridspec_kw={"height_ratios": (1.6, 1)})
