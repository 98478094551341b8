"""Sample tracklets and their regressions, for figure 7: along is linear in scale, or in inverse scale."""
import dataclasses

import numpy as np

from .fixes import column
from .statistics import linear_fit
from .tables import Table

# Model -> what along is linear in.
MODELS = {"scale": lambda scale_px: scale_px, "inverse scale": lambda scale_px: -1 / scale_px}
MOST_SAMPLES = 7


@dataclasses.dataclass(frozen=True)
class Sample:
    """One tracklet's observations, by growing along, and its line on each model."""

    name: str  # a letter
    along_m: np.ndarray
    scale_px: np.ndarray
    fits: dict


def samples_of(rows):
    """Of a regressions.csv, one Sample a tracklet, in the file's order, as many as a figure can tell apart."""
    samples = []
    for tracklet in list(dict.fromkeys(row["tracklet"] for row in rows))[:MOST_SAMPLES]:
        own = [row for row in rows if row["tracklet"] == tracklet]
        along_m, scale_px = column(own, "along_m"), column(own, "scale_px")
        fits = {model: linear_fit(of(scale_px), along_m) for model, of in MODELS.items()}
        samples.append(Sample(chr(ord("A") + len(samples)), along_m, scale_px, fits))
    return samples


def regression_table(samples):
    """The lines of figure 7: along = offset + slope f(s)."""
    table = Table(
        "regressions", "Lines of figure 7",
        "Along = offset + slope × s, with the scale s in pixels (as published), or offset + slope × (-1/s), which is "
        "exact for a feature of fixed size and a straight approach.",
        [("tracklet", "", None), ("seen in frames", "", 0), ("over", "m", 1), ("offset", "m", 1), ("slope", "m/px", 2),
         ("R²", "", 4), ("offset, inverse", "m", 1), ("slope, inverse", "m px", 1), ("R², inverse", "", 4)])
    for sample in samples:
        row = [sample.name, len(sample.along_m), float(np.ptp(sample.along_m))]
        for model in MODELS:
            row += [sample.fits[model].intercept, sample.fits[model].slope, sample.fits[model].r_squared]
        table.rows.append(row)
    return table
