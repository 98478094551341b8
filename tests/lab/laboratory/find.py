"""How well a vehicle is found: runs milepost-client find on a drive with several seeds and prints what came of it.

A row a seed: seconds until it was found, frames in which it counted as found, wrong ones among these (more than 10 m off),
their errors in metres, mean error of the heading in degrees, share of errors inside the circle that should hold 95 % of
them by the claimed sigma, and milliseconds a frame.
"""
import argparse
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from . import report
from .errors import LabError
from .found import WRONG_M, figures_of, read_found, read_recording
from .found_figures import error_over_time
from .road import geodetic
from .tables import Table

GOLDEN_ANGLE = 2.4
NOTE = (f"Tracked: frames in which the vehicle counts as found; the columns after it are of these. Wrong: farther than "
        f"{WRONG_M:.0f} m from the recorded position. In circle: share of errors inside the circle that should hold 95 % of them by "
        "the claimed sigma.")
CAPTION = ("Distance of the densest place of the belief from the recorded position, whether the vehicle counts as found or not. "
           "Figures 10 (start unknown) and 11 (start known) of Leung et al. (2008) show the like of five runs.")
HEADER = (f"{'seed':>8} {'found s':>8} {'found':>12} {'wrong':>5} {'mean m':>7} {'p50 m':>7} {'p95 m':>7} {'deg':>7} "
          f"{'in 95%':>6} {'ms p50':>7} {'ms p99':>7}")


def line(name, figures):
    first = "-" if math.isnan(figures.found_after_s) else f"{figures.found_after_s:.1f}"
    return (f"{name:>8} {first:>8} {figures.tracked:>6}/{figures.frames:<5} {figures.wrong:>5} {figures.mean_m:>7.2f} "
            f"{figures.p50_m:>7.2f} {figures.p95_m:>7.2f} {figures.mean_turn_deg:>7.2f} {100 * figures.within_95:>6.0f} "
            f"{figures.latency_p50_ms:>7.0f} {figures.latency_p99_ms:>7.0f}")


def result_of(runs):
    firsts_s = [run.found_after_s for run in runs if run.tracked.any()]
    if not firsts_s:
        return f"found in none of {len(runs)} runs"
    figures = figures_of(runs)
    return (f"found in {len(firsts_s)} of {len(runs)} runs, after {min(firsts_s):.1f} to {max(firsts_s):.1f} s; "
            f"{figures.wrong} of {figures.tracked} frames while found in a wrong place, more than {WRONG_M:.0f} m off")


def start_arguments(recording, off_m, seed):
    """A known start on a spiral about the true one: as far off as asked for in the mean of squares of each direction."""
    angle = GOLDEN_ANGLE * seed
    away_m = math.sqrt(2) * off_m * np.array([math.sin(angle), math.cos(angle), 0])
    latitude_deg, longitude_deg, _ = geodetic(recording.frame.to_earth(away_m))
    return ["--start", f"{latitude_deg:.8f},{longitude_deg:.8f}", "--start-sigma-m", str(off_m)]


def run_once(options, arguments, fixes_csv):
    result = subprocess.run(
        [options.client, "find", "--map", options.map, "--drive", str(options.drive), "--out", str(fixes_csv), *arguments],
        capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise LabError(result.stderr.strip())


def table_of(runs):
    table = Table("found", "By seed", NOTE, [
        ("seed", "", None), ("found after", "s", 1), ("tracked", "frames", 0), ("of", "", 0), ("wrong", "", 0), ("mean", "m", 2),
        ("p50", "m", 2), ("p95", "m", 2), ("heading", "°", 2), ("in circle", "%", 0)])
    for name, part in (*((str(seed), [run]) for seed, run in enumerate(runs, 1)), ("all", runs)):
        figures = figures_of(part)
        table.rows.append([name, figures.found_after_s, figures.tracked, figures.frames, figures.wrong, figures.mean_m,
                           figures.p50_m, figures.p95_m, figures.mean_turn_deg, 100 * figures.within_95])
    return table


def report_page(options, arguments, runs):
    start = "unknown" if options.start_off_m is None else f"known, off by {options.start_off_m:g} m in each direction"
    return report.page(
        f"{options.drive.name}, {len(runs)} runs", f"{result_of(runs).capitalize()}.",
        [("Map", pathlib.Path(options.map).name), ("Start", start), ("Options of find", " ".join(arguments) or "none")],
        [report.figure("Error over time", error_over_time(runs), CAPTION, stacked=True), report.table(table_of(runs))])


def main():
    parser = argparse.ArgumentParser(prog="tests/lab/find", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter,
                                     epilog="Further arguments go to milepost-client find: --area, --start, --method, --particles.")
    parser.add_argument("client", help="the program milepost-client")
    parser.add_argument("map", help="map with a layer of walls")
    parser.add_argument("drive", type=pathlib.Path, help="folder of the drive")
    parser.add_argument("--seeds", type=int, default=10, help="how many runs (default: 10)")
    parser.add_argument("--start-off-m", type=float, help="a known start, off by so much (standard deviation, each way)")
    parser.add_argument("--report", type=pathlib.Path, metavar="FILE.html", help="also write a page with the error over time")
    options, arguments = parser.parse_known_args()
    if options.seeds < 1:
        parser.error("--seeds must be at least 1")
    recording = read_recording(options.drive)
    runs = []
    print(HEADER)
    with tempfile.TemporaryDirectory() as folder:
        fixes_csv = pathlib.Path(folder) / "found.csv"
        for seed in range(1, options.seeds + 1):
            start = [] if options.start_off_m is None else start_arguments(recording, options.start_off_m, seed)
            try:
                run_once(options, ["--seed", str(seed), *start, *arguments], fixes_csv)
            except LabError as error:
                sys.exit(str(error))
            runs.append(read_found(fixes_csv, recording))
            print(line(str(seed), figures_of(runs[-1:])), flush=True)
    print(line("all", figures_of(runs)))
    print(result_of(runs))
    if options.report:
        options.report.write_text(report_page(options, arguments, runs), encoding="utf-8")


if __name__ == "__main__":
    main()
