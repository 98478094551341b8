#!/usr/bin/env python3
"""Combines the results of deploy/demo in one table.

usage: demo_table.py OUT QUERY...
Reads OUT/results/QUERY/summary.json; prints the table; writes OUT/table.txt, table.csv, index.html.
"""
import csv
import html
import json
import sys
from pathlib import Path

# Heading, key of summary.json, decimals, meaning.
COLUMNS = [
    ("mean m", "mean_error_m", 3, "mean absolute error along the route"),
    ("std m", "std_error_m", 3, "standard deviation of the error"),
    ("max m", "max_error_m", 2, "largest absolute error"),
    ("p95 m", "p95_error_m", 3, "95 % of the errors are no larger"),
    ("in 2 sigma", "within_2_sigma", 2, "share of errors within twice the estimated sigma"),
    ("lateral m", "mean_lateral_error_m", 3, "mean absolute lateral error, of methods that estimate it"),
    ("kB/m", "map_kb_per_m", 2, "map data that the vehicle needs per metre of road"),
    ("ms p50", "latency_ms_p50", 1, "median time per frame"),
]
COUNTS = ("localized_frames", "frames")

PAGE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>milepost: demo</title>
<style>
:root {{ color-scheme: light dark; --line: #8884; --bar: #3b82c4; }}
body {{ font: 15px/1.5 system-ui, sans-serif; max-width: 80rem; margin: 2rem auto; padding: 0 1rem; }}
h1 {{ font-size: 1.4rem; }}
.scroll {{ overflow-x: auto; }}
table {{ border-collapse: collapse; font-variant-numeric: tabular-nums; white-space: nowrap; }}
th, td {{ padding: .25rem .7rem; text-align: right; }}
th {{ font-weight: 600; border-bottom: 2px solid var(--line); }}
td:nth-child(-n+2), th:nth-child(-n+2) {{ text-align: left; }}
tbody {{ border-bottom: 1px solid var(--line); }}
tbody.mean {{ font-weight: 600; }}
.bar {{ display: inline-block; height: .6em; background: var(--bar); border-radius: 2px; }}
td.bars {{ text-align: left; min-width: 8rem; }}
</style>
<h1>milepost: demo</h1>
<p>Each query drive was localized on the map of its map drive, through a tile server on loopback and
a fresh cache. The bar is the mean error; the name of a pair links to its report.</p>
<div class="scroll"><table>
<thead><tr>{head}</tr></thead>
{bodies}
</table></div>
<dl>{legend}</dl>
</html>
"""


def read_rows(out, queries):
    """One dictionary per pair and method: its summary with `pair` added."""
    rows = []
    for query in queries:
        path = out / "results" / query / "summary.json"
        for summary in json.loads(path.read_text(encoding="utf-8")):
            rows.append({"pair": query, **summary})
    return rows


def mean_rows(rows):
    """One row per method: the mean of each column over the pairs, and the sums of frames."""
    means = []
    for method in dict.fromkeys(row["method"] for row in rows):
        of_method = [row for row in rows if row["method"] == method]
        mean = {"pair": f"mean of {len(of_method)}", "method": method}
        for _, key, _, _ in COLUMNS:
            values = [row[key] for row in of_method]
            # A pair without a value must not drop out of the mean silently.
            mean[key] = None if None in values else sum(values) / len(values)
        for key in COUNTS:
            mean[key] = sum(row[key] for row in of_method)
        means.append(mean)
    return means


def cells(row):
    numbers = ["-" if row[key] is None else f"{row[key]:.{decimals}f}"
               for _, key, decimals, _ in COLUMNS]
    return [row["pair"], row["method"], *numbers, "/".join(str(row[key]) for key in COUNTS)]


HEADINGS = ["pair", "method", *(heading for heading, _, _, _ in COLUMNS), "localized"]


def text_table(groups):
    lines = [HEADINGS, *(cells(row) for group in groups for row in group)]
    widths = [max(len(line[column]) for line in lines) for column in range(len(HEADINGS))]

    def aligned(line):
        words = [word.ljust(width) if column < 2 else word.rjust(width)
                 for column, (word, width) in enumerate(zip(line, widths))]
        return "  ".join(words).rstrip()

    rule = "-" * (sum(widths) + 2 * (len(widths) - 1))
    parts = [aligned(HEADINGS), rule]
    for group in groups:
        parts += [*(aligned(cells(row)) for row in group), rule]
    return "\n".join(parts) + "\n"


def html_page(groups, means):
    scale = max((row["mean_error_m"] or 0 for group in groups for row in group), default=0) or 1

    def html_row(row, linked):
        pair, *rest = [html.escape(word) for word in cells(row)]
        if linked:
            pair = f'<a href="results/{pair}/report.html">{pair}</a>'
        width = 7 * (row["mean_error_m"] or 0) / scale
        bar = f'<td class="bars"><span class="bar" style="width:{width:.2f}rem"></span></td>'
        return "<tr>" + "".join(f"<td>{word}</td>" for word in [pair, *rest]) + bar + "</tr>"

    bodies = ["<tbody>" + "\n".join(html_row(row, True) for row in group) + "</tbody>"
              for group in groups]
    bodies.append('<tbody class="mean">' + "\n".join(html_row(row, False) for row in means) +
                  "</tbody>")
    legend = "".join(f"<dt>{heading}</dt><dd>{meaning}</dd>" for heading, _, _, meaning in COLUMNS)
    return PAGE.format(head="".join(f"<th>{heading}</th>" for heading in [*HEADINGS, "mean error"]),
                       bodies="\n".join(bodies), legend=legend)


def write_csv(path, rows):
    keys = ["pair", "method", *(key for _, key, _, _ in COLUMNS), *COUNTS]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, keys, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def main():
    if len(sys.argv) < 3 or sys.argv[1].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    out, queries = Path(sys.argv[1]), sys.argv[2:]
    rows = read_rows(out, queries)
    groups = [[row for row in rows if row["pair"] == query] for query in queries]
    means = mean_rows(rows)

    table = text_table([*groups, means])
    (out / "table.txt").write_text(table, encoding="utf-8")
    write_csv(out / "table.csv", rows)
    (out / "index.html").write_text(html_page(groups, means), encoding="utf-8")
    print(table)
    print(f"Reports: {out / 'index.html'}, per pair {out / 'results'}/QUERY/report.html; "
          f"the table: {out / 'table.txt'}, {out / 'table.csv'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
