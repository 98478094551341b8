"""Figures 5 to 8 of the tracklet paper, from our data, and the figures of studies: each a list of plots."""
import numpy as np
from scipy import stats

from . import paper
from .drawing import MARKERS, axis, colour, dots, layer, line, method_line, plot, texts
from .regressions import MODELS
from .statistics import running_mean
from .tables import methods_of, of_method, on_road, pairs_of

RUNNING_WINDOW_M = 10.0
LEAST_SHOWN_M = 0.01  # of an error on a logarithmic axis
HISTOGRAM_SIGMAS = 4.0
SAMPLE_MARKERS = ({"marker": "circle"}, {"marker": "rect"}, {"marker": "rectRot"}, {"marker": "triangle"},
                  {"marker": "triangle", "rotation_deg": 180}, {"marker": "cross", "edge_px": 1.5},
                  {"marker": "crossRot", "edge_px": 1.5})
SHARES = np.linspace(0, 1, 201)  # of frames, at which a distribution is drawn
NORMAL_DASH = [7, 2]


def log_ends(values):
    """Of an axis that holds the values; an empty one is a decade."""
    known = np.concatenate([np.ravel(value) for value in values]) if len(values) else np.array([])
    known = known[np.isfinite(known) & (known > 0)]
    return (known.min() / 1.2, known.max() * 1.2) if len(known) else (0.1, 1)


def shown(error_m):
    return np.maximum(np.abs(error_m), LEAST_SHOWN_M)


def distribution(errors_m):
    """Errors, and the share of frames with no larger one in percent."""
    ordered = np.sort(errors_m)
    if len(ordered) <= len(SHARES):
        return np.r_[0, ordered], 100 * np.arange(len(ordered) + 1) / len(ordered)
    return np.quantile(ordered, SHARES), 100 * SHARES


def steps(bins, heights, name, colour_name, opacity):
    """The filled outline of a histogram."""
    x, y = np.r_[bins[0], bins], np.r_[0, heights, 0]
    return [layer("area", x, y, colour=colour_name, opacity=opacity, steps=True), line(x, y, name, colour_name, 1, steps=True)]


def error_along_route(fixes):
    """Figure 5: a panel a pair, a line a method."""
    methods = methods_of(fixes)
    low, high = log_ends([shown(each.error_m) for each in fixes])
    plots = []
    for pair in pairs_of(fixes):
        layers = []
        for method in reversed(methods):
            for each in of_method(fixes, method):
                if each.pair == pair:
                    layers += errors_of(each)
        plots.append(plot(layers, axis("true arc length (m)", decimals=1), axis("error (m)", low, high, 3, log=True), title=pair))
    return plots


def errors_of(fixes):
    order = np.argsort(fixes.truth_along_m, kind="stable")
    along_m, error_m = fixes.truth_along_m[order], shown(fixes.error_m[order])
    return [dots(along_m, error_m, colour(fixes.method), 1.5, opacity=0.4),
            method_line(along_m, running_mean(along_m, error_m, RUNNING_WINDOW_M), fixes.method)]


def error_by_road_type(fixes):
    """Figure 6: share of frames below an error, on curved and straight road."""
    methods = [method for method in (*paper.ESTIMATORS, paper.OURS) if method in methods_of(fixes)]
    reach_m = max((np.quantile(each.absolute_m, 0.98) for method in methods for each in of_method(fixes, method)
                   if len(each.absolute_m)), default=1)
    plots = []
    for letter, road_type in zip("ab", paper.ROAD_TYPES):
        count, layers = 0, []
        for method in methods:
            of_type = on_road(of_method(fixes, method), road_type)
            errors_m = np.concatenate([each.absolute_m for each in of_type])
            count = max(count, len(errors_m))
            if len(errors_m):
                layers += [method_line(*distribution(errors_m), method, steps=True),
                           dots([errors_m.mean()], [0], colour(method), 6, marker="triangle", unclipped=True)]
        if count == 0:
            layers = [texts([reach_m / 2], [50], ["no frame on such road"], "center")]
        plots.append(plot(layers, axis("error (m)", 0, reach_m, 3), axis("frames with no larger error (%)", 0, 100, 1), 230,
                          title=f"({letter}) {road_type} road, {count} frames"))
    return plots


def error_distribution(fixes):
    """Share of frames below an error, every method, all pairs together."""
    layers = []
    for method in reversed(methods_of(fixes)):
        errors_m = np.concatenate([each.absolute_m for each in of_method(fixes, method)])
        if len(errors_m):
            error_m, share = distribution(errors_m)
            layers.append(method_line(shown(error_m), share, method, steps=True))
    low, high = log_ends([shown(each.absolute_m) for each in fixes])
    return [plot(layers, axis("error (m)", low, high, 3, log=True), axis("frames with no larger error (%)", 0, 100, 1), 260)]


def regressions(samples):
    """Figure 7: `samples` are Samples; where a feature was seen at which scale, and the lines of both models."""
    plots = []
    for model, end, label in zip(MODELS, (1, 0), ("scale s (px)", "-1/s (1/px)")):  # the letters stand where the lines are apart
        layers = []
        for index, sample in enumerate(samples):
            fit, last_m = sample.fits[model], sample.along_m[-1]
            reach_m = np.array([sample.along_m[0] - last_m - 1, 1])
            ends = (reach_m + last_m - fit.intercept) / fit.slope
            layers += [line(reach_m, ends, None, "muted", 1),
                       dots(sample.along_m - last_m, MODELS[model](sample.scale_px), "m0", 3.5, sample.name,
                            **SAMPLE_MARKERS[index % len(SAMPLE_MARKERS)]),
                       texts(reach_m[end:end + 1], ends[end:end + 1], [sample.name], "left" if end else "right", (4 if end else -4, 4))]
        plots.append(plot(layers, axis("arc length, from where it was last seen (m)", decimals=1), axis(label, decimals=3), 260,
                          title=f"linear in {model}"))
    return plots


def estimate_histogram(errors_m, normality):
    """Figure 8: per-tracklet errors v_k against normal densities, and their quantiles against the normal's."""
    reach_m = HISTOGRAM_SIGMAS * max(normality.core_std, 0.5 * normality.std)
    beyond = np.mean(np.abs(errors_m) > reach_m)
    bins = np.linspace(-reach_m, reach_m, 81)
    density = np.histogram(errors_m, bins)[0] / len(errors_m) / np.diff(bins)
    grid_m = np.linspace(-reach_m, reach_m, 241)
    normals = ((normality.std, "all", "ink", {}), (normality.core_std, "bulk", "m1", {"dash": NORMAL_DASH}))
    histogram = plot(
        [*steps(bins, density, "estimates", "m5", 0.45),
         *(line(grid_m, stats.norm.pdf(grid_m, 0, sigma_m), f"normal, σ = {sigma_m:.2f} m ({of})", name, **dash)
           for sigma_m, of, name, dash in normals)],
        axis("error of a tracklet's estimate v (m)", -reach_m, reach_m),
        axis("density (1/m)", 0, 1.1 * max(density.max(), stats.norm.pdf(0, 0, normality.core_std)), 3), 240,
        bin=float(bins[1] - bins[0]), title=f"{len(errors_m)} estimates, {100 * beyond:.1f} % beyond the edges")
    shares = (np.arange(1, 400) - 0.5) / 399
    quantiles = plot(
        [*(line([-3, 3], [-3 * sigma_m, 3 * sigma_m], None, name, **dash) for sigma_m, _, name, dash in normals),
         dots(stats.norm.ppf(shares), np.quantile(errors_m, shares), "m5", 2, "quantiles")],
        axis("quantile of the standard normal", -3.1, 3.1), axis("quantile of the errors (m)"), 240,
        title="quantiles (straight: normal)")
    return [histogram, quantiles]


def study_figure(points, x_label, x_log=False, second_label=None, x_ticks=()):
    """`points`: of each method a list of (x, mean error m, value of the second plot), x increasing.

    Without a label there is no second plot. `x_ticks` are names of x = 0, 1, 2, ...
    """
    values = sorted({x for of_method_ in points.values() for x, *_ in of_method_})
    if x_ticks:
        x_axis = axis(x_label, -0.3, len(x_ticks) - 0.7, names=list(x_ticks))
    elif x_log:
        x_axis = axis(x_label, *log_ends([np.array(values)]), log=True, ticks=values)
    else:
        x_axis = axis(x_label)
    return [plot([method_line([each[0] for each in of_method_], [each[index] for each in of_method_], method, radius_px=3.5,
                              **MARKERS.get(method, {"marker": "circle"})) for method, of_method_ in points.items()],
                 x_axis, axis(label, 0, decimals=3), 220)
            for index, label in ((1, "mean error (m)"), (2, second_label)) if label]


def honesty_figure(sigmas_of_group):
    """`sigmas_of_group`: of each group of fixes their errors in sigmas."""
    layers = []
    for name, (group, sigmas) in zip(("m0", "m1", "m2", "m3", "m4", "m6"), sigmas_of_group.items()):
        of_sigmas, share = distribution(sigmas)
        layers.append(line(of_sigmas, np.where(share < 100, 100 - share, np.nan), f"{group}, {len(sigmas)} fixes", name, steps=True))
    grid = np.linspace(0, 6, 121)
    layers.append(line(grid, 200 * stats.norm.sf(grid), "normal", "muted", dash=NORMAL_DASH))
    return [plot(layers, axis("error in sigmas", 0, 6), axis("fixes beyond (%)", 0.01, 100, 2, log=True), 260)]


def evidence_figure(here, elsewhere):
    """Log Bayes factors of places where frames were taken, and of others."""
    bins = np.linspace(-40, 40, 81)
    layers = []
    for logs, name, label in ((elsewhere, "m1", "elsewhere"), (here, "m0", "where the frame was taken")):
        counts = np.histogram(np.clip(logs, bins[0], bins[-1]), bins)[0]
        layers += steps(bins, 100 * counts / max(1, len(logs)), f"{label}, {len(logs)} places", name, 0.4)
    return [plot(layers, axis("logarithm of the Bayes factor (beyond 40: at the edge)", -40, 40, 0), axis("places (%)", 0), 230,
                 bin=float(bins[1] - bins[0]))]


def means_beside_paper(fixes):
    """Mean error of each method, and the paper's where it has one."""
    methods = [method for method in methods_of(fixes) if method != paper.UNAVERAGED][::-1]
    layers, means_m = [], []
    for place, method in enumerate(methods):
        errors_m = np.concatenate([each.absolute_m for each in of_method(fixes, method)])
        if method in paper.TABLE_1:
            published_m = paper.TABLE_1[method][1]
            means_m.append(published_m)
            layers.append(dots([published_m], [place], "ink", 7, "paper", marker="line", rotation_deg=90, edge_px=1.6))
        if len(errors_m):
            means_m.append(errors_m.mean())
            layers += [dots([errors_m.mean()], [place], colour(method), 5, "here"),
                       texts([errors_m.mean()], [place], [f"{errors_m.mean():.2f}"], shift_px=(9, 4))]
    low, high = log_ends([np.array(means_m)])
    return [plot(layers, axis("mean error (m)", low / 1.3, high * 1.5, log=True), axis("", -0.6, len(methods) - 0.4, names=methods),
                 26 * len(methods))]
