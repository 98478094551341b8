"""Figures of errors. Every random draw has a fixed seed."""
import dataclasses
import math

import numpy as np
from scipy import stats

BOOTSTRAP_DRAWS = 4000
BOOTSTRAP_SEED = 20170101
BLOCK_FRAMES = 20  # neighbouring frames err alike, so they are drawn together
SIGMAS = (1, 2, 3)
NORMAL_SHARES = tuple(math.erf(count / math.sqrt(2)) for count in SIGMAS)  # 68.3, 95.4, 99.7 %


@dataclasses.dataclass(frozen=True)
class Figures:
    """Of absolute errors in metres; NaN where no frame was localized."""

    mean_m: float
    std_m: float  # of the absolute errors, as the paper tells it
    max_m: float
    median_m: float
    localized: int
    frames: int


def figures_of(fixes):
    """Of all frames of a list of PairFixes together: each frame counts alike."""
    absolute_m = np.concatenate([each.absolute_m for each in fixes]) if fixes else np.array([])
    frames = sum(len(each.error_m) for each in fixes)
    if not len(absolute_m):
        return Figures(math.nan, math.nan, math.nan, math.nan, 0, frames)
    return Figures(float(absolute_m.mean()), float(absolute_m.std()), float(absolute_m.max()),
                   float(np.median(absolute_m)), len(absolute_m), frames)


def kb_per_m(fixes):
    """Of all maps together, each map once, by its length."""
    maps = {each.map_name: each for each in fixes if math.isfinite(each.map_kb_per_m)}
    length_m = sum(each.map_length_m for each in maps.values())
    return sum(each.map_kb_per_m * each.map_length_m for each in maps.values()) / length_m if maps else math.nan


def pooled(fixes, name):
    """One array of a list of PairFixes, all frames together."""
    return np.concatenate([getattr(each, name) for each in fixes]) if fixes else np.array([])


@dataclasses.dataclass(frozen=True)
class Spread:
    """Of absolute errors; NaN where none is known."""

    mean: float
    p95: float
    max: float


def spread_of(errors):
    """Of those that are known."""
    absolute = np.abs(errors[np.isfinite(errors)])
    if not len(absolute):
        return Spread(math.nan, math.nan, math.nan)
    return Spread(float(absolute.mean()), float(np.quantile(absolute, 0.95)), float(absolute.max()))


def share_within(errors, sigmas, count):
    """Share of the errors within so many of their claimed sigmas; NaN where none is claimed."""
    known = np.isfinite(errors) & np.isfinite(sigmas)
    return float((np.abs(errors[known]) <= count * sigmas[known]).mean()) if known.any() else math.nan


def calibration(fixes):
    """Share of localized frames whose error is within 1, 2, 3 of the claimed sigma."""
    return tuple(share_within(pooled(fixes, "error_m"), pooled(fixes, "sigma_m"), count) for count in SIGMAS)


@dataclasses.dataclass(frozen=True)
class Difference:
    """Of a figure of method A less that of B, on the frames both localized, with its 95 % interval."""

    a: float
    b: float
    low: float
    high: float
    frames: int

    @property
    def value(self):
        return self.a - self.b

    @property
    def significant(self):
        return self.low > 0 or self.high < 0


def paired_differences(a_fixes, b_fixes, keep=lambda fixes: fixes.localized):
    """(Difference of means, Difference of variances) of the absolute errors in m and m^2.

    A paired moving-block bootstrap: stretches of BLOCK_FRAMES frames are drawn with replacement, the same
    for both methods. `keep` marks the frames of a PairFixes that count. None where no frame is left.
    """
    a_of = {each.pair: each for each in a_fixes}
    b_of = {each.pair: each for each in b_fixes}
    series = []
    for pair in (pair for pair in a_of if pair in b_of):
        both = np.all([each.localized & keep(each) for each in (a_of[pair], b_of[pair])], axis=0)
        if both.any():
            a, b = (np.abs(each.error_m[both]) for each in (a_of[pair], b_of[pair]))
            series.append(np.stack([a, b, a ** 2, b ** 2]))
    if not series:
        return None
    return differences_of(series)


def differences_of(series):
    """`series`: of each pair an array (a, b, a^2, b^2) by frames."""
    whole = np.concatenate(series, axis=1)
    frames = whole.shape[1]
    a_mean, b_mean, a_square, b_square = whole.mean(axis=1)
    drawn_a, drawn_b, drawn_a2, drawn_b2 = block_means(series)
    mean = interval(a_mean, b_mean, drawn_a - drawn_b, frames)
    variance = interval(a_square - a_mean ** 2, b_square - b_mean ** 2,
                        (drawn_a2 - drawn_a ** 2) - (drawn_b2 - drawn_b ** 2), frames)
    return mean, variance


def block_means(series):
    """The rows' means in each draw, (rows, BOOTSTRAP_DRAWS): of every pair as many frames as it has."""
    generator = np.random.default_rng(BOOTSTRAP_SEED)
    sums, count = 0, 0
    for values in series:
        frames = values.shape[1]
        length = min(BLOCK_FRAMES, frames)
        blocks = math.ceil(frames / length)
        circle = np.concatenate([np.zeros((len(values), 1)), values, values[:, :length]], axis=1)
        wrapped = np.cumsum(circle, axis=1)
        block_sums = wrapped[:, length:length + frames] - wrapped[:, :frames]
        starts = generator.integers(0, frames, size=(BOOTSTRAP_DRAWS, blocks))
        sums = sums + block_sums[:, starts].sum(axis=2) * (frames / (blocks * length))
        count += frames
    return sums / count


def interval(a, b, drawn, frames):
    low, high = np.percentile(drawn, [2.5, 97.5])
    return Difference(float(a), float(b), float(low), float(high), frames)


@dataclasses.dataclass(frozen=True)
class Normality:
    """How far from normal a sample is; a p-value says little of thousands of values."""

    count: int
    mean: float
    std: float
    skewness: float          # 0 when normal
    excess_kurtosis: float   # 0 when normal
    kolmogorov: float        # largest distance from the distribution function of N(mean, std^2), 0 to 1
    core_std: float          # 1.4826 times the median absolute deviation: of the bulk, without the tails
    core_kolmogorov: float   # distance from N(median, core_std^2)


def normality_of(values):
    values = np.asarray(values, float)
    mean, std, median = values.mean(), values.std(), np.median(values)
    core_std = 1.4826 * np.median(np.abs(values - median))
    return Normality(len(values), float(mean), float(std), float(stats.skew(values)),
                     float(stats.kurtosis(values)), kolmogorov_distance(values, mean, std), float(core_std),
                     kolmogorov_distance(values, median, core_std))


def kolmogorov_distance(values, mean, std):
    """Largest difference between the sample's distribution function and that of N(mean, std^2)."""
    ordered = np.sort(values)
    normal = stats.norm.cdf(ordered, mean, std)
    ranks = np.arange(len(ordered) + 1) / len(ordered)
    return float(max(np.max(ranks[1:] - normal), np.max(normal - ranks[:-1])))


@dataclasses.dataclass(frozen=True)
class LinearFit:
    """y = intercept + slope x by least squares, and its coefficient of determination (the paper's Eq. 14)."""

    intercept: float
    slope: float
    r_squared: float


def linear_fit(x, y):
    slope, intercept = np.polyfit(x, y, 1)
    residual = y - (intercept + slope * x)
    return LinearFit(float(intercept), float(slope), float(1 - (residual ** 2).sum() / ((y - y.mean()) ** 2).sum()))


def running_mean(along_m, values, window_m):
    """Mean of the values within half a window of each along; NaN values take no part."""
    known = np.isfinite(values) & np.isfinite(along_m)
    means = np.full(len(values), np.nan)
    for index in np.flatnonzero(known):
        near = known & (np.abs(along_m - along_m[index]) <= window_m / 2)
        means[index] = values[near].mean()
    return means
