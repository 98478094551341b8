"""The paper's claims, each checked on the measured errors."""
import dataclasses

from . import paper, statistics
from .tables import of_method, methods_of

ACCURACY_MARGIN = 0.05  # of the mean error: a smaller loss costs no accuracy, a smaller gain is not worth it
HALF_SIZE = 0.55        # of the size: at most this is called half
NORMAL_KS = 0.05        # Kolmogorov distance up to which a distribution is called closely normal

NAMES = {
    "wisurf": "WISURF", "scale-only": "scale only", "tracklet-matching": "tracklet matching",
    "tracklet-regression": "regression", "tracklet-regression-kalman": "regression with the Kalman filter",
    "tracklet-regression-particle": "regression with the particle filter", "milepost": "milepost",
    "tracklet-regression-unaveraged": "regression with every observation's descriptor",
    "inverse-scale": "regression on -1/scale",
}


@dataclasses.dataclass(frozen=True)
class Claim:
    text: str
    verdict: str  # "held", "not held" or "not tested"
    figures: str


class Evidence:
    """The errors of every method, and comparisons of two."""

    def __init__(self, fixes):
        self.fixes = fixes
        self.methods = methods_of(fixes)

    def has(self, *methods):
        return all(method in self.methods for method in methods)

    def differences(self, a, b, keep=lambda fixes: fixes.localized):
        return statistics.paired_differences(of_method(self.fixes, a), of_method(self.fixes, b), keep)

    def mean(self, a, b, keep=lambda fixes: fixes.localized):
        differences = self.differences(a, b, keep)
        return differences and differences[0]


def said(difference, a, b, unit="m"):
    """The two figures, and their difference with its interval."""
    return (f"{NAMES.get(a, a)} {difference.a:.3f} {unit}, {NAMES.get(b, b)} {difference.b:.3f} {unit}: difference "
            f"{difference.value:+.3f} {unit} [{difference.low:+.3f}, {difference.high:+.3f}], "
            f"{difference.frames} frames")


def verdict(held):
    return "held" if held else "not held"


def less(evidence, better, worse, text):
    """The claim that one method's mean error is less than another's."""
    if not evidence.has(better, worse):
        return untested(text, evidence, better, worse)
    difference = evidence.mean(better, worse)
    if difference is None:
        return Claim(text, "not tested", "no frame was localized by both methods")
    return Claim(text, verdict(difference.high < 0), said(difference, better, worse))


def untested(text, evidence, *methods):
    missing = [method for method in methods if method not in evidence.methods]
    return Claim(text, "not tested", f"{' and '.join(missing)} {'were' if len(missing) > 1 else 'was'} not run")


def averaging_claims(evidence):
    """Section 5.2: without averaging, accuracy is the same at twice the size."""
    averaged, single = "tracklet-regression", paper.UNAVERAGED
    accuracy = "Averaging the descriptors of a tracklet costs no accuracy"
    size = "Averaging descriptors halves the map"
    if not evidence.has(averaged, single):
        return [untested(text, evidence, averaged, single) for text in (accuracy, size)]
    difference = evidence.mean(averaged, single)
    kb_averaged, kb_single = (statistics.kb_per_m(of_method(evidence.fixes, method)) for method in (averaged, single))
    ratio = kb_averaged / kb_single
    return [Claim(accuracy, verdict(difference.high < ACCURACY_MARGIN * difference.b),
                  said(difference, averaged, single) +
                  f"; held if the interval ends below {100 * ACCURACY_MARGIN:.0f} % of the error"),
            Claim(size, verdict(ratio <= HALF_SIZE),
                  f"{kb_averaged:.2f} kB/m of {kb_single:.2f} kB/m: {ratio:.2f} (paper: 0.50); held up to {HALF_SIZE}")]


def kalman_claims(evidence):
    """Section 5.3: the filter lowers the mean error and its variance."""
    filtered, plain = "tracklet-regression-kalman", "tracklet-regression"
    mean = less(evidence, filtered, plain, "The Kalman filter lowers the mean error")
    text = "The Kalman filter lowers the variance of the error"
    differences = evidence.has(filtered, plain) and evidence.differences(filtered, plain)
    if not differences:
        return [mean, dataclasses.replace(mean, text=text)]
    variance = differences[1]
    return [mean, Claim(text, verdict(variance.high < 0), said(variance, filtered, plain, "m²"))]


def particle_claims(evidence):
    """Section 5.4: the particle filter gains nothing significant, on curves neither."""
    particle, kalman = "tracklet-regression-particle", "tracklet-regression-kalman"
    claims = []
    for where, keep in (("", lambda fixes: fixes.localized), (" on curved road", lambda fixes: fixes.curved),
                        (" on straight road", lambda fixes: ~fixes.curved)):
        text = f"The particle filter adds nothing significant{where}"
        if not evidence.has(particle, kalman):
            claims.append(untested(text, evidence, particle, kalman))
            continue
        difference = evidence.mean(particle, kalman, keep)
        if difference is None:
            claims.append(Claim(text, "not tested", "no such frame"))
            continue
        gains = difference.high < 0 and -difference.value > ACCURACY_MARGIN * difference.b
        claims.append(Claim(text, verdict(not gains), said(difference, particle, kalman) +
                            f"; a gain within chance or below {100 * ACCURACY_MARGIN:.0f} % of the error is none"))
    return claims


def order_claims(evidence):
    """Table 1: each method is better than the one before it."""
    text = "The methods stand in the order of Table 1 by their mean errors"
    if not evidence.has(*paper.ORDER):
        whole = untested(text, evidence, *paper.ORDER)
    else:
        means_m = {method: statistics.figures_of(of_method(evidence.fixes, method)).mean_m for method in paper.ORDER}
        ours = sorted(paper.ORDER, key=lambda method: -means_m[method])
        whole = Claim(text, verdict(ours == list(paper.ORDER)),
                      "here: " + ", ".join(f"{NAMES[method]} {means_m[method]:.2f} m" for method in ours))
    return [whole, *(less(evidence, better, worse, f"Order of Table 1: {NAMES[better]} is better than {NAMES[worse]}")
                     for worse, better in zip(paper.ORDER, paper.ORDER[1:]))]


def normality_claim(normality):
    text = "The errors of single tracklets are closely zero-mean Gaussian"
    if normality is None:
        return Claim(text, "not tested", "no estimates were written")
    held = abs(normality.mean) < 0.1 * normality.std and normality.kolmogorov <= NORMAL_KS
    return Claim(text, verdict(held),
                 f"mean {normality.mean:+.3f} m, deviation {normality.std:.3f} m, skewness {normality.skewness:+.2f}, "
                 f"excess kurtosis {normality.excess_kurtosis:.1f}, Kolmogorov distance {normality.kolmogorov:.3f} "
                 f"({normality.count} estimates); held if the mean is below a tenth of the deviation and the distance "
                 f"at most {NORMAL_KS}")


def claims_of(fixes, normality=None):
    evidence = Evidence(fixes)
    return [*order_claims(evidence), *averaging_claims(evidence), *kalman_claims(evidence),
            *particle_claims(evidence), normality_claim(normality),
            less(evidence, paper.OURS, "tracklet-regression-kalman",
                 "Ours: milepost is better than the paper's best method")]
