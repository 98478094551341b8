"""What several mapping drives with slow errors of their own know together, and whether sigma tells it: simulated drives with
exact positions get a bias each and a drift along their way, drawn anew for each draw; maps of the first one, two, four, six
drives (in an order that is drawn, too) are built, and the query drive is localized on each.

A row for each number of drives, over all draws: mean error in the world along and across, the root mean square of both
together, the median over draws of its ratio to that of a map of one drive and to that of the mean of the drawn errors of the
drives that were mapped (the best that can be had), shares within 2 sigma and beyond 4, mean normalised error squared along and
across (1 if sigma holds), the sigmas that were told, kB a metre, and the share of landmarks that two drives or more saw.
"""
import argparse
import concurrent.futures
import csv
import dataclasses
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

from .errors import LabError
from .fixes import column, read_table

EXACT = ("east_m", "north_m", "up_m")
WAVES, WAVES_M = 8, (100, 300)  # their number, and their lengths, divided by 2 pi
HEADER = (f"{'drives':>6} {'along m':>8} {'across m':>8} {'rms m':>7} {'to one':>7} {'to best':>7} {'told':>11} {'in 2':>11} "
          f"{'beyond 4':>9} {'nees':>11} {'sigma m':>8} {'kB/m':>5} {'repeated':>8}")


def read_trajectory(drive):
    with open(drive / "trajectory.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if not rows or any(name not in rows[0] for name in EXACT):
        raise LabError(f"{drive}: is no drive in a local frame; give simulated drives with exact positions")
    return rows


def places_of(rows):
    return np.array([[float(row[name]) for name in EXACT] for row in rows])


def headings_of(rows):
    return np.radians([float(row["heading_deg"]) for row in rows])


def part_near(rows, query_rows, near_m, margin_m):
    """The longest run of frames that drive along the query's way, in its direction, with a margin."""
    places, query = places_of(rows)[:, :2], places_of(query_rows)[:, :2]
    apart_m = np.linalg.norm(places[:, None] - query[None], axis=2)
    nearest = apart_m.argmin(axis=1)
    turn = headings_of(rows) - headings_of(query_rows)[nearest]
    near = (apart_m.min(axis=1) < near_m) & (np.cos(turn) > 0.7)
    runs, begin = [], None
    for i, is_near in enumerate([*near, False]):
        if is_near and begin is None:
            begin = i
        elif not is_near and begin is not None:
            runs.append((begin, i))
            begin = None
    if not runs:
        return []
    begin, end = max(runs, key=lambda run: run[1] - run[0])
    along_m = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))])
    kept = (along_m >= along_m[begin] - margin_m) & (along_m <= along_m[end - 1] + margin_m)
    return [row for row, is_kept in zip(rows, kept) if is_kept]


def drawn_errors(places, noise, random):
    """East, north, up of each frame: a bias and a smooth drift along the way, as milepost-simulator draws them: on each axis
    a sum of waves that is alike over 100 to 300 m."""
    along_m = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))])
    lengths_m = random.uniform(*WAVES_M, (WAVES, 1, 3))
    phases = random.uniform(0, 2 * math.pi, (WAVES, 1, 3))
    drift = math.sqrt(2 / WAVES) * np.sin(along_m[:, None] / lengths_m + phases).sum(axis=0)
    return noise.bias_m * random.standard_normal(3) + noise.drift_m * drift


def write_drive(drive, name, rows, errors, folder):
    """A drive of these rows with errors; its frames are those of `drive`."""
    folder.mkdir(parents=True)
    description = json.loads((drive / "drive.json").read_text(encoding="utf-8"))
    frames = description["images"]
    description["name"] = name
    (folder / "drive.json").write_text(json.dumps(description), encoding="utf-8")
    (folder / frames).symlink_to((drive / frames).resolve())
    for table in ("gps.csv", "odometry.csv"):
        if (drive / table).exists():
            (folder / table).symlink_to((drive / table).resolve())
    with open(folder / "trajectory.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        for row, error in zip(rows, errors):
            writer.writerow({**row, **{axis: f"{float(row[axis]) + off:.6f}" for axis, off in zip(EXACT, error)}})


def run(arguments):
    result = subprocess.run([str(word) for word in arguments], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise LabError(result.stderr.strip())
    return result.stdout


@dataclasses.dataclass
class Noise:
    bias_m: float
    drift_m: float


@dataclasses.dataclass
class Measured:
    """One map of one draw; arrays have a value a frame that was told."""

    frames: int
    along_m: np.ndarray
    across_m: np.ndarray
    along_sigma_m: np.ndarray
    across_sigma_m: np.ndarray
    best_m: np.ndarray  # along and across, of the mean of the drawn errors
    kb_per_m: float
    repeated: float

    @property
    def rms_m(self):
        return math.sqrt(np.mean(np.concatenate([self.along_m, self.across_m]) ** 2))

    @property
    def best_rms_m(self):
        return math.sqrt(np.mean(self.best_m ** 2))


def mean_errors_at(query_rows, drives):
    """Of the drives, (rows, errors) each, at the query's frames, in the query's directions along and across."""
    query, headings = places_of(query_rows)[:, :2], headings_of(query_rows)
    total = np.zeros_like(query)
    for rows, errors in drives:
        places = places_of(rows)[:, :2]
        nearest = np.linalg.norm(query[:, None] - places[None], axis=2).argmin(axis=1)
        total += errors[nearest, :2] / len(drives)
    forward = np.stack([np.sin(headings), np.cos(headings)], axis=1)
    right = np.stack([np.cos(headings), -np.sin(headings)], axis=1)
    return np.sum(total * forward, axis=1), np.sum(total * right, axis=1)


def measure(options, seed, folder):
    """{number of drives: Measured} of one draw."""
    random = np.random.default_rng(seed)
    noise = Noise(options.bias_m, options.drift_m)
    query_rows = read_trajectory(options.query)
    begin, end = (round(share * len(query_rows)) for share in options.part)
    query_rows = query_rows[begin:end:options.every]
    write_drive(options.query, "query", query_rows, np.zeros((len(query_rows), 3)), folder / "query")
    drives = []
    for drive in options.map_drive:
        rows = part_near(read_trajectory(drive), query_rows, options.near_m, margin_m=30)
        if not rows:
            raise LabError(f"{drive}: does not drive along the query's way")
        errors = drawn_errors(places_of(rows), noise, random)
        write_drive(drive, drive.name, rows, errors, folder / drive.name)
        drives.append((folder / drive.name, rows, errors))
    random.shuffle(drives)
    measured = {}
    for number in options.numbers:
        chosen = drives[:number]
        map_file = folder / f"{number}.map"
        said = run([options.mapper, "build", "--map", map_file, "--jobs", 1,
                    *(word for drive, _, _ in chosen for word in ("--drive", drive))])
        out = folder / f"of-{number}"
        run([options.client, "evaluate", "--map", map_file, "--drive", folder / "query", "--out", out, "--method", "milepost",
             "--receiver-until-s", 0])
        rows = read_table(out / "fixes-milepost.csv")
        told = np.isfinite(column(rows, "error_m")) & np.isfinite(column(rows, "lateral_error_m"))
        best = mean_errors_at(query_rows, [(rows_of, errors) for _, rows_of, errors in chosen])
        summary, = json.loads((out / "summary.json").read_text(encoding="utf-8"))
        repeated = re.search(r"(\d+) % seen by two", said)
        measured[number] = Measured(
            len(rows), *(column(rows, name)[told] for name in ("error_m", "lateral_error_m", "sigma_m", "lateral_sigma_m")),
            np.concatenate(best), summary["map_kb_per_m"], float(repeated.group(1)) if repeated else 0)
    return measured


def measure_in_folder(options, seed):
    with tempfile.TemporaryDirectory() as folder:
        return measure(options, seed, pathlib.Path(folder))


def line(number, of_draws):
    here = [draw[number] for draw in of_draws]
    first = min(of_draws[0])
    along_m, across_m, along_sigma_m, across_sigma_m = (
        np.concatenate([getattr(each, name) for each in here])
        for name in ("along_m", "across_m", "along_sigma_m", "across_sigma_m"))
    along, across = np.abs(along_m / along_sigma_m), np.abs(across_m / across_sigma_m)
    rms_m = math.sqrt(np.mean(np.concatenate([along_m, across_m]) ** 2))
    to_one = np.median([draw[number].rms_m / draw[first].rms_m for draw in of_draws])
    to_best = np.median([each.rms_m / each.best_rms_m if each.best_rms_m > 0 else math.inf for each in here])
    return (f"{number:>6} {np.abs(along_m).mean():>8.4f} {np.abs(across_m).mean():>8.4f} {rms_m:>7.4f} {to_one:>7.2f} "
            f"{to_best:>7.2f} {len(along_m):>5}/{sum(each.frames for each in here):<5} "
            f"{100 * np.mean(along <= 2):>5.1f}/{100 * np.mean(across <= 2):<5.1f} "
            f"{100 * np.mean(np.maximum(along, across) > 4):>8.2f}% {np.mean(along ** 2):>5.2f}/{np.mean(across ** 2):<5.2f} "
            f"{np.median(np.concatenate([along_sigma_m, across_sigma_m])):>8.4f} {np.mean([each.kb_per_m for each in here]):>5.2f} "
            f"{np.mean([each.repeated for each in here]):>7.0f}%")


def main():
    parser = argparse.ArgumentParser(prog="tests/lab/draws", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mapper", help="the program milepost-mapper")
    parser.add_argument("client", help="the program milepost-client")
    parser.add_argument("--map-drive", type=pathlib.Path, nargs="+", required=True, help="simulated drives, exact positions")
    parser.add_argument("--query", type=pathlib.Path, required=True, help="simulated drive on the same road")
    parser.add_argument("--part", type=float, nargs=2, default=(0, 1), metavar=("LOW", "HIGH"),
                        help="only this part of the query's frames (default: 0 1)")
    parser.add_argument("--every", type=int, default=1, help="only one in so many of these frames (default: 1)")
    parser.add_argument("--near-m", type=float, default=8, help="how near a mapping drive passes (default: 8)")
    parser.add_argument("--numbers", type=int, nargs="+", default=[1, 2, 4, 6], help="of drives (default: 1 2 4 6)")
    parser.add_argument("--draws", type=int, default=20, help="default: 20")
    parser.add_argument("--first-seed", type=int, default=1, help="of the draws (default: 1)")
    parser.add_argument("--bias-m", type=float, default=0.1, help="standard deviation on each axis (default: 0.1)")
    parser.add_argument("--drift-m", type=float, default=0.15, help="the same of the drift (default: 0.15)")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)), help="draws at a time")
    options = parser.parse_args()
    if options.draws < 1 or options.every < 1 or min(options.numbers) < 1 or max(options.numbers) > len(options.map_drive):
        parser.error("--draws, --every and --numbers: at least 1, and no more drives than are given")
    done = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        draws = [pool.submit(measure_in_folder, options, options.first_seed + draw) for draw in range(options.draws)]
        for draw in draws:
            try:
                done.append(draw.result())
            except LabError as error:
                pool.shutdown(cancel_futures=True)
                sys.exit(str(error))
            print(f"draw {len(done)}: " + ", ".join(
                f"{number} {each.rms_m:.4f} (best {each.best_rms_m:.4f}, sigma "
                f"{np.median(each.along_sigma_m):.4f})" for number, each in done[-1].items()), flush=True)
    print(HEADER)
    for number in options.numbers:
        print(line(number, done))


if __name__ == "__main__":
    main()
