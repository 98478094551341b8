"""Figures 5 to 8 of the tracklet paper, from our data, and the figures of studies."""
import numpy as np
from matplotlib import ticker
from scipy import stats

from . import paper
from .drawing import DASHES, INK, MARKERS, MUTED, STAND_INS, colour, drawn
from .regressions import MODELS
from .statistics import running_mean
from .tables import methods_of, of_method, on_road, pairs_of

RUNNING_WINDOW_M = 10.0
LEAST_SHOWN_M = 0.01  # of an error on a logarithmic axis
HISTOGRAM_SIGMAS = 4.0
SAMPLE_MARKERS = "osD^vPX"


def metres(value, _):
    return f"{value:g}"


def logarithmic(axes, which):
    """`which`: "x" or "y"."""
    axes.set(**{f"{which}scale": "log"})
    axis = getattr(axes, f"{which}axis")
    axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5), numticks=20))
    axis.set_major_formatter(ticker.FuncFormatter(metres))
    axis.set_minor_locator(ticker.NullLocator())


def error_along_route(fixes):
    """Figure 5: a panel a pair, a line a method."""
    pairs, methods = pairs_of(fixes), methods_of(fixes)
    columns = min(2, len(pairs))
    rows = -(-len(pairs) // columns)

    def draw(axes):
        for axis, pair in zip(axes.flat, pairs):
            for method in reversed(methods):  # the first drawn lies below
                for each in of_method(fixes, method):
                    if each.pair == pair:
                        draw_errors(axis, each, columns)
            axis.set_title(pair)
            logarithmic(axis, "y")
        for axis in list(axes.flat)[len(pairs):]:
            axis.set_visible(False)
        for row in axes:
            row[0].set_ylabel("error (m)")
        for index in range(columns):
            shown = [axis for axis in axes[:, index] if axis.get_visible()]
            shown[-1].set_xlabel("true position along the segment (m)")

    return drawn(rows, columns, 0.5 + (2.1 if columns > 1 else 3.2) * rows, draw, sharey=True)


def draw_errors(axis, fixes, columns):
    order = np.argsort(fixes.truth_along_m, kind="stable")
    along_m = fixes.truth_along_m[order]
    error_m = np.maximum(np.abs(fixes.error_m[order]), LEAST_SHOWN_M)
    ours = fixes.method == paper.OURS
    axis.plot(along_m, error_m, ".", color=colour(fixes.method), markersize=3, alpha=0.4, markeredgewidth=0)
    axis.plot(along_m, running_mean(along_m, error_m, RUNNING_WINDOW_M), color=colour(fixes.method),
              linestyle=DASHES.get(fixes.method, "-"), linewidth=2 if ours else 1.3, solid_capstyle="round")


def error_by_road_type(fixes):
    """Figure 6: share of frames below an error, on curved and straight road."""
    methods = [method for method in (*paper.ESTIMATORS, paper.OURS) if method in methods_of(fixes)]
    reach_m = max((np.quantile(each.absolute_m, 0.98) for method in methods for each in of_method(fixes, method)
                   if len(each.absolute_m)), default=1)

    def draw(axes):
        for axis, road_type in zip(axes[0], paper.ROAD_TYPES):
            count = 0
            for method in methods:
                of_type = on_road(of_method(fixes, method), road_type)
                errors_m = np.sort(np.concatenate([each.absolute_m for each in of_type]))
                count = max(count, len(errors_m))
                if len(errors_m):
                    axis.step(np.r_[0, errors_m], 100 * np.arange(len(errors_m) + 1) / len(errors_m), where="post",
                              color=colour(method), linestyle=DASHES.get(method, "-"))
                    axis.plot([errors_m.mean()], [0], marker="^", markersize=7, color=colour(method), clip_on=False,
                              markeredgewidth=0)
            if count == 0:
                axis.text(reach_m / 2, 50, "no frame on such road", ha="center", va="center", color=MUTED)
            axis.set_title(f"{'(a)' if road_type == 'curved' else '(b)'} {road_type} road, {count} frames")
            axis.set_xlabel("error (m)")
            axis.set_xlim(0, reach_m)
            axis.set_ylim(0, 100)
        axes[0, 0].set_ylabel("frames with no larger error (%)")

    return drawn(1, 2, 3.1, draw, sharey=True)


def error_distribution(fixes):
    """Share of frames below an error, every method, all pairs together."""
    def draw(axes):
        axis = axes[0, 0]
        for method in reversed(methods_of(fixes)):
            errors_m = np.sort(np.concatenate([each.absolute_m for each in of_method(fixes, method)]))
            if len(errors_m):
                axis.step(np.maximum(errors_m, LEAST_SHOWN_M), 100 * np.arange(1, len(errors_m) + 1) / len(errors_m),
                          where="post", color=colour(method), linestyle=DASHES.get(method, "-"),
                          linewidth=2 if method == paper.OURS else 1.4)
        logarithmic(axis, "x")
        axis.set_xlabel("error (m)")
        axis.set_ylabel("frames with no larger error (%)")
        axis.set_ylim(0, 100)

    return drawn(1, 1, 3.2, draw)


def regressions(samples):
    """Figure 7: `samples` are Samples; where a feature was seen at which scale, and the lines of both models."""
    def draw(axes):
        for axis, model, end in zip(axes[0], MODELS, (1, 0)):  # the letters stand where the lines are apart
            for index, sample in enumerate(samples):
                fit, last_m = sample.fits[model], sample.along_m[-1]
                reach_m = np.array([sample.along_m[0] - last_m - 1, 1])
                line = (reach_m + last_m - fit.intercept) / fit.slope
                axis.plot(reach_m, line, color=MUTED, linewidth=1)
                axis.plot(sample.along_m - last_m, MODELS[model](sample.scale_px), color=STAND_INS["m0"], linestyle="",
                          marker=SAMPLE_MARKERS[index % len(SAMPLE_MARKERS)], markersize=4.5, markeredgewidth=0)
                axis.annotate(sample.name, (reach_m[end], line[end]), (3 if end else -3, 0), va="center",
                              ha="left" if end else "right", textcoords="offset points", fontsize=8, fontweight="bold")
            axis.set_title(f"linear in {model}")
            axis.set_xlabel("position, from where it was last seen (m)")
        axes[0, 0].set_ylabel("scale s (px)")
        axes[0, 1].set_ylabel("-1/s (1/px)")

    return drawn(1, 2, 3.4, draw)


def estimate_histogram(errors_m, normality):
    """Figure 8: per-tracklet errors v_k against normal densities, and their quantiles against the normal's."""
    reach_m = HISTOGRAM_SIGMAS * max(normality.core_std, 0.5 * normality.std)
    inside = errors_m[np.abs(errors_m) <= reach_m]
    beyond = 1 - len(inside) / len(errors_m)

    def draw(axes):
        histogram, quantiles = axes[0]
        bins = np.linspace(-reach_m, reach_m, 81)
        density = np.histogram(errors_m, bins)[0] / len(errors_m) / np.diff(bins)
        histogram.bar(bins[:-1], density, np.diff(bins), align="edge", color=STAND_INS["m5"], alpha=0.45, linewidth=0)
        grid_m = np.linspace(-reach_m, reach_m, 241)
        histogram.plot(grid_m, stats.norm.pdf(grid_m, 0, normality.std), color=INK,
                       label=f"normal, σ = {normality.std:.2f} m (all)")
        histogram.plot(grid_m, stats.norm.pdf(grid_m, 0, normality.core_std), color=STAND_INS["m1"],
                       linestyle=(0, (5, 1.5)), label=f"normal, σ = {normality.core_std:.2f} m (bulk)")
        histogram.set_title(f"{len(errors_m)} estimates, {100 * beyond:.1f} % beyond the edges")
        histogram.set_xlabel("error of a tracklet's estimate v (m)")
        histogram.set_ylabel("density (1/m)")
        histogram.set_xlim(-reach_m, reach_m)
        histogram.set_ylim(0, 1.25 * max(density.max(), stats.norm.pdf(0, 0, normality.core_std)))
        histogram.legend(loc="upper left")
        shares = (np.arange(1, 400) - 0.5) / 399
        normal = stats.norm.ppf(shares)
        quantiles.plot([-3, 3], [-3 * normality.std, 3 * normality.std], color=INK)
        quantiles.plot([-3, 3], [-3 * normality.core_std, 3 * normality.core_std], color=STAND_INS["m1"],
                       linestyle=(0, (5, 1.5)))
        quantiles.plot(normal, np.quantile(errors_m, shares), ".", color=STAND_INS["m5"], markersize=4,
                       markeredgewidth=0)
        quantiles.set_title("quantiles (straight: normal)")
        quantiles.set_xlabel("quantile of the standard normal")
        quantiles.set_ylabel("quantile of the errors (m)")
        quantiles.set_xlim(-3.1, 3.1)

    return drawn(1, 2, 3.2, draw, width_ratios=[1.7, 1])


def study_figure(points, x_label, x_log=False, second_label=None, x_ticks=()):
    """`points`: of each method a list of (x, mean error m, value of the second plot), x increasing.

    Without a label there is no second plot. `x_ticks` are names of x = 0, 1, 2, ...
    """
    def draw(axes):
        error, *second = axes[0]
        for method, values in points.items():
            x, mean_m, second_values = np.array(values, float).T
            style = {"color": colour(method), "linestyle": DASHES.get(method, "-"), "marker": MARKERS.get(method, "o"),
                     "markersize": 4.5, "markeredgewidth": 0}
            error.plot(x, mean_m, **style)
            if second:
                second[0].plot(x, second_values, **style)
        error.set_ylabel("mean error (m)")
        for axis in axes[0]:
            axis.set_xlabel(x_label)
            axis.set_ylim(bottom=0)
            if x_ticks:
                axis.set_xticks(range(len(x_ticks)), x_ticks)
            if x_log:
                axis.set_xscale("log")
                ticks = sorted({x for values in points.values() for x, *_ in values})
                axis.xaxis.set_major_locator(ticker.FixedLocator(ticks))
                axis.xaxis.set_major_formatter(ticker.FuncFormatter(lambda x, _: f"{round(x, 2):g}"))
                axis.xaxis.set_minor_locator(ticker.NullLocator())
        if second:
            second[0].set_ylabel(second_label)

    return drawn(1, 2 if second_label else 1, 2.9, draw)


def honesty_figure(sigmas_of_group):
    """`sigmas_of_group`: of each group of fixes their errors in sigmas."""
    colours = [STAND_INS[name] for name in ("m0", "m1", "m2", "m3", "m4", "m6")]

    def draw(axes):
        axis = axes[0, 0]
        for index, (group, sigmas) in enumerate(sigmas_of_group.items()):
            ordered = np.sort(sigmas)
            beyond = 100 * (1 - np.arange(1, len(ordered) + 1) / len(ordered))
            axis.step(np.r_[0, ordered], np.r_[100, beyond], where="post", color=colours[index % len(colours)],
                      label=f"{group}, {len(ordered)} fixes")
        grid = np.linspace(0, 6, 121)
        axis.plot(grid, 200 * stats.norm.sf(grid), color=MUTED, linestyle=(0, (5, 1.5)), label="normal")
        logarithmic(axis, "y")
        axis.set_xlim(0, 6)
        axis.set_ylim(0.01, 100)
        axis.set_xlabel("error in sigmas")
        axis.set_ylabel("fixes beyond (%)")
        axis.legend(loc="upper right")

    return drawn(1, 1, 3.2, draw)


def evidence_figure(here, elsewhere):
    """Log Bayes factors of places where frames were taken, and of others."""
    def draw(axes):
        axis = axes[0, 0]
        bins = np.linspace(-40, 40, 81)
        for logs, name, label in ((elsewhere, "m1", "elsewhere"), (here, "m0", "where the frame was taken")):
            counts = np.histogram(np.clip(logs, bins[0], bins[-1]), bins)[0]
            axis.bar(bins[:-1], 100 * counts / max(1, len(logs)), np.diff(bins), align="edge", color=STAND_INS[name],
                     alpha=0.55, linewidth=0, label=f"{label}, {len(logs)} places")
        axis.axvline(0, color=MUTED, linewidth=1)
        axis.set_xlabel("logarithm of the Bayes factor (beyond 40: at the edge)")
        axis.set_ylabel("places (%)")
        axis.legend(loc="upper right")

    return drawn(1, 1, 2.9, draw)


def means_beside_paper(fixes):
    """Mean error of each method, and the paper's where it has one."""
    methods = [method for method in methods_of(fixes) if method != paper.UNAVERAGED]

    def draw(axes):
        axis = axes[0, 0]
        for place, method in enumerate(reversed(methods)):
            errors_m = np.concatenate([each.absolute_m for each in of_method(fixes, method)])
            published_m = paper.TABLE_1[method][1] if method in paper.TABLE_1 else None
            if len(errors_m):
                axis.plot([errors_m.mean()], [place], "o", color=colour(method), markersize=9, markeredgewidth=0)
                axis.annotate(f"{errors_m.mean():.2f}", (1.02, place), xycoords=("axes fraction", "data"), va="center",
                              fontsize=8, color=INK)
            if published_m:
                axis.plot([published_m], [place], "|", color=INK, markersize=15, markeredgewidth=1.6)
                axis.annotate(f"paper {published_m:.2f}", (1.08, place), xycoords=("axes fraction", "data"),
                              va="center", fontsize=8, color=MUTED)
        logarithmic(axis, "x")
        low_m, high_m = axis.get_xlim()
        axis.set_xlim(low_m / 1.5, high_m * 1.5)
        axis.set_yticks(range(len(methods)), methods[::-1])
        axis.set_ylim(-0.6, len(methods) - 0.2)
        axis.tick_params(axis="y", length=0, labelcolor=INK)
        axis.set_xlabel("mean error (m)")

    return drawn(1, 1, 0.6 + 0.36 * len(methods), draw)
