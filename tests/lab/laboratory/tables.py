"""The tables: each as aligned text, as CSV, as Markdown and as data of a page, of the same cells."""
import csv
import dataclasses
import io
import math
import textwrap

import numpy as np

from . import paper, statistics
from .fixes import OF_FRAMES
from .road import CURVATURE_WINDOW_M, CURVED_RADIUS_M

TEXT_WIDTH = 110  # of notes


@dataclasses.dataclass
class Table:
    """Cells are words, or numbers that `decimals` of their column rounds; a missing number is NaN or None."""

    name: str   # of its files
    title: str
    note: str   # what its words mean
    columns: list  # (heading, unit, decimals; None in a column of words)
    rows: list = dataclasses.field(default_factory=list)
    best: set = dataclasses.field(default_factory=set)  # headings of which the least number is marked
    groups: int = 0  # rows with equal words in so many first columns stand together

    def cell(self, row, index):
        return self.text(row[index], self.columns[index][2])

    @staticmethod
    def text(value, decimals):
        if value is None or isinstance(value, float) and math.isnan(value):
            return "–"
        return value if isinstance(value, str) else f"{value:.{decimals}f}"

    def headings(self):
        return [f"{heading} {unit}".strip() for heading, unit, _ in self.columns]

    def group(self, row):
        return tuple(row[:self.groups])

    def best_text(self, row, index):
        """The cell that is marked in the row's group; none where all say the same."""
        heading, _, decimals = self.columns[index]
        values = [each[index] for each in self.rows if self.group(each) == self.group(row)]
        values = [value for value in values if isinstance(value, (int, float)) and math.isfinite(value)]
        texts = {self.text(value, decimals) for value in values}
        return self.text(min(values), decimals) if heading in self.best and len(texts) > 1 else None

    def is_best(self, row, index):
        return not isinstance(row[index], str) and self.cell(row, index) == self.best_text(row, index)

    def as_text(self):
        lines = [self.headings(), *([self.cell(row, i) for i in range(len(row))] for row in self.rows)]
        widths = [max(len(line[i]) for line in lines) for i in range(len(self.columns))]
        aligned = ["  ".join(word.rjust(width) if column[2] is not None else word.ljust(width)
                             for word, width, column in zip(line, widths, self.columns)).rstrip()
                   for line in lines]
        rule = "-" * (sum(widths) + 2 * (len(widths) - 1))
        parts = [aligned[0], rule]
        for row, line, following in zip(self.rows, aligned[1:], [*self.rows[1:], None]):
            parts.append(line)
            if following is None or self.group(following) != self.group(row):
                parts.append(rule)
        return f"{self.title}\n\n" + "\n".join(parts) + f"\n{textwrap.fill(self.note, TEXT_WIDTH)}\n"

    def as_csv(self):
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow([heading.replace(" ", "_") + (f"_{unit.replace('/', '_per_')}" if unit else "")
                         for heading, unit, _ in self.columns])
        for row in self.rows:
            writer.writerow(["" if self.cell(row, i) == "–" else self.cell(row, i) for i in range(len(row))])
        return text.getvalue()

    def as_markdown(self):
        lines = ["| " + " | ".join(self.headings()) + " |",
                 "| " + " | ".join("---:" if decimals is not None else "---" for *_, decimals in self.columns) + " |"]
        for row in self.rows:
            cells = [self.cell(row, i) for i in range(len(row))]
            lines.append("| " + " | ".join(f"**{cell}**" if self.is_best(row, i) else cell
                                           for i, cell in enumerate(cells)) + " |")
        return "\n".join(lines) + "\n"

    def as_data(self):
        """For a page. A group is a row of its own, then its rows without the group's word."""
        columns = self.columns[self.groups:]
        rows, last = [], ()
        for row in self.rows:
            if self.group(row) != last:
                last = self.group(row)
                rows.append({"group": ", ".join(last)})
            best = [index for index in range(len(columns)) if self.is_best(row, self.groups + index)]
            rows.append({"cells": [self.data(row, self.groups + index) for index in range(len(columns))], "best": best})
        return {"columns": [dict(zip(("heading", "unit", "decimals"), column)) for column in columns], "rows": rows}

    def data(self, row, index):
        """A word, or the number that is shown; None where it is missing."""
        text = self.cell(row, index)
        return text if isinstance(row[index], str) else None if text == "–" else float(text)


def of_method(fixes, method):
    return [each for each in fixes if each.method == method]


def methods_of(fixes):
    return list(dict.fromkeys(each.method for each in fixes))


def pairs_of(fixes):
    return list(dict.fromkeys(each.pair for each in fixes))


FIGURE_COLUMNS = [("mean", "m", 3), ("std", "m", 3), ("max", "m", 2), ("median", "m", 3), ("map", "kB/m", 2),
                  ("localized", "", 0), ("frames", "", 0)]
PAPER_COLUMNS = [("paper mean", "m", 2), ("paper std", "m", 2), ("paper max", "m", 2)]
FIGURE_NOTE = ("Mean, standard deviation, maximum and median of the absolute error along the route, over the localized "
               "frames. Map: what a vehicle holds for the method on each metre of road.")


def figure_cells(fixes):
    figures = statistics.figures_of(fixes)
    return [figures.mean_m, figures.std_m, figures.max_m, figures.median_m, statistics.kb_per_m(fixes),
            figures.localized, figures.frames]


def table_1(fixes):
    table = Table(
        "table1", "Table 1: methods, all pairs together",
        FIGURE_NOTE + " Each frame counts alike. The paper's values are of its own drives; its database is text, "
        "ours compressed tiles.",
        [("method", "", None), *FIGURE_COLUMNS, *PAPER_COLUMNS, ("paper map", "kB/m", 2)],
        best={"mean", "std", "max", "median", "map"})
    for method in methods_of(fixes):
        published = paper.TABLE_1.get(method, (None,) * 5)[1:]
        table.rows.append([method, *figure_cells(of_method(fixes, method)), *published])
    return table


def table_1_by_pair(fixes):
    table = Table("table1-pairs", "Table 1 by pair", FIGURE_NOTE, [("pair", "", None), ("method", "", None),
                  *FIGURE_COLUMNS], best={"mean", "std", "max", "median"}, groups=1)
    for pair in pairs_of(fixes):
        for method in methods_of(fixes):
            here = [each for each in of_method(fixes, method) if each.pair == pair]
            table.rows.append([pair, method, *figure_cells(here)])
    return table


ALL_PAIRS = "all pairs"


def precision_table(fixes):
    """Position and heading of each method: all pairs together, and pair by pair."""
    table = Table(
        "precision", "Precision: along, lateral and heading",
        "Mean, 95th percentile and maximum of the absolute errors along the route and to the side, mean of the "
        "absolute heading error, over the frames of which the method knows them; –: it knows none. Map: what a vehicle "
        "holds for the method on each metre of road. In 2σ: share of the errors within twice the standard deviation "
        "that the method itself claims; 95.4 % would be honest. Of all pairs together each frame counts alike.",
        [("pair", "", None), ("method", "", None), ("along mean", "m", 3), ("along p95", "m", 3), ("along max", "m", 2),
         ("lateral mean", "m", 3), ("lateral p95", "m", 3), ("lateral max", "m", 2), ("heading mean", "°", 2),
         ("map", "kB/m", 2), ("along in 2σ", "%", 1), ("lateral in 2σ", "%", 1)],
        best={"along mean", "along p95", "along max", "lateral mean", "lateral p95", "lateral max", "heading mean",
              "map"}, groups=1)
    for pair, method, here in by_pair_and_method(fixes):
        table.rows.append([pair, method, *precision_cells(here)])
    return table


def precision_latency_table(fixes):
    """The same with the time of a frame, which is not the same each time: it stays out of the report."""
    table = precision_table(fixes)
    place = [heading for heading, *_ in table.columns].index("map") + 1
    table.name = "latency-precision"
    table.note += " p50: half of the frames take no longer from the decoded image to the fix, while other stages run."
    table.columns.insert(place, ("p50", "ms", 1))
    for row, (_, _, here) in zip(table.rows, by_pair_and_method(fixes)):
        row.insert(place, float(np.median(statistics.pooled(here, "latency_ms"))))
    return table


def by_pair_and_method(fixes):
    """(pair, method, PairFixes) of all pairs together, then of each pair."""
    every = [(ALL_PAIRS, fixes), *((pair, [each for each in fixes if each.pair == pair]) for pair in pairs_of(fixes))]
    return [(pair, method, of_method(here, method)) for pair, here in every for method in methods_of(here)]


def precision_cells(fixes):
    along, lateral, heading = (statistics.spread_of(statistics.pooled(fixes, name))
                               for name in ("error_m", "lateral_error_m", "heading_error_deg"))
    within = [100 * statistics.share_within(statistics.pooled(fixes, error), statistics.pooled(fixes, sigma), 2)
              for error, sigma in (("error_m", "sigma_m"), ("lateral_error_m", "lateral_sigma_m"))]
    return [along.mean, along.p95, along.max, lateral.mean, lateral.p95, lateral.max, heading.mean,
            statistics.kb_per_m(fixes), *within]


def on_road(fixes, road_type):
    """The PairFixes with the frames of one road type only."""
    def only(each):
        kept = each.curved if road_type == "curved" else ~each.curved
        return dataclasses.replace(each, **{name: getattr(each, name)[kept] for name in OF_FRAMES})
    return [only(each) for each in fixes]


def table_2(fixes):
    table = Table(
        "table2", "Table 2: estimators by road type",
        f"Curved: the map's line bends with a radius below {CURVED_RADIUS_M:.0f} m over {CURVATURE_WINDOW_M:.0f} m of "
        "road. Errors as in Table 1.",
        [("road", "", None), ("method", "", None), ("mean", "m", 3), ("std", "m", 3), ("max", "m", 2),
         ("localized", "", 0), *PAPER_COLUMNS], best={"mean", "std", "max"}, groups=1)
    methods = [method for method in (*paper.ESTIMATORS, paper.OURS) if method in methods_of(fixes)]
    for road_type in paper.ROAD_TYPES:
        for method in methods:
            figures = statistics.figures_of(on_road(of_method(fixes, method), road_type))
            published = paper.TABLE_2.get((road_type, method), (None,) * 3)
            table.rows.append([road_type, method, figures.mean_m, figures.std_m, figures.max_m, figures.localized,
                               *published])
    return table


def calibration_table(fixes):
    table = Table(
        "calibration", "Calibration: errors within the claimed sigma",
        "Share of localized frames whose error is within 1, 2 and 3 of the standard deviations that the method "
        "itself claims. A method without a motion model claims the spread of its estimates.",
        [("method", "", None), *((f"within {count}σ", "%", 1) for count in statistics.SIGMAS)])
    for method in methods_of(fixes):
        shares = statistics.calibration(of_method(fixes, method))
        table.rows.append([method, *(100 * share for share in shares)])
    table.rows.append(["normal distribution", *(100 * share for share in statistics.NORMAL_SHARES)])
    return table


def normality_table(samples):
    """`samples`: {name: Normality} of per-tracklet errors in metres."""
    table = Table(
        "normality", "Per-tracklet errors against the normal distribution",
        "KS: Kolmogorov's distance, the largest difference between the distribution functions of the errors and of "
        "the normal distribution with their mean and deviation (core: with their median, and the deviation of the "
        "bulk, 1.4826 times the median absolute deviation). 0 is perfect; of thousands of values any small departure "
        "has a vanishing p-value, so the distance is told.",
        [("method", "", None), ("estimates", "", 0), ("mean", "m", 3), ("std", "m", 3), ("skewness", "", 2),
         ("excess kurtosis", "", 1), ("KS", "", 3), ("core std", "m", 3), ("core KS", "", 3)])
    for name, each in samples.items():
        table.rows.append([name, each.count, each.mean, each.std, each.skewness, each.excess_kurtosis,
                           each.kolmogorov, each.core_std, each.core_kolmogorov])
    return table


def latency_table(runs):
    """`runs`: of each pair its summaries. Not the same each time: it stays out of the report."""
    table = Table("latency", "Time for one frame, its features included",
                  "Median and 99th percentile, measured while other stages ran beside.",
                  [("pair", "", None), ("method", "", None), ("p50", "ms", 1), ("p99", "ms", 1)], groups=1)
    for pair, summaries in runs:
        for summary in summaries:
            table.rows.append([pair, summary["method"], summary["latency_ms_p50"], summary["latency_ms_p99"]])
    return table
