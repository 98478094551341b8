"""What the mapper tells of mapping drives that are spoilt on purpose, and what they cost: each mapping drive is spoilt in each
way, mapped, and its query drive is localized on the map.

A row for each pair and fault, the drive as recorded first: what is found before the map is built (*) and with it, or why no
map was built; frames with a fix; mean error in plan in metres, and how many fixes are confidently wrong (beyond 1 m and 5
sigma). Exit code 1 if a sound drive has a finding.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from . import altered_drive
from .errors import LabError
from .fixes import column, read_table
from .honesty import WRONG_M, WRONG_SIGMAS

AS_RECORDED = "as recorded"


def run(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)


def kinds_of(text):
    return sorted({finding["kind"] for finding in json.loads(text)["findings"]})


def fixes_of(folder):
    """Frames, those with a fix, their mean error in plan, and how many are confidently wrong."""
    rows = read_table(folder / "fixes-milepost.csv")
    error_m = np.hypot(column(rows, "error_m"), column(rows, "lateral_error_m"))
    sigma_m = np.hypot(column(rows, "sigma_m"), column(rows, "lateral_sigma_m"))
    told = np.isfinite(error_m)
    wrong = told & (error_m > np.maximum(WRONG_M, WRONG_SIGMAS * sigma_m))
    return len(rows), int(told.sum()), float(error_m[told].mean()) if told.any() else float("nan"), int(wrong.sum())


def measure(options, pair, fault, folder):
    """The row of one pair and fault, and what is found there."""
    map_drive, query = pair
    drive = map_drive
    folder.mkdir()
    if fault != AS_RECORDED:
        drive = folder / map_drive.name
        altered = run(sys.executable, "-B", altered_drive.__file__, map_drive, drive, "--record", fault)
        if altered.returncode != 0:
            raise LabError(altered.stderr.strip())
    map_file, out = folder / "spoilt.map", folder / "out"
    before = run(options.mapper, "build", "--drive", drive, "--dry-run", "--json")
    built = run(options.mapper, "build", "--drive", drive, "--map", map_file, "--json", "--jobs", 1)
    early = set(kinds_of(before.stdout)) if before.returncode == 0 else set()
    name = f"{map_drive.name:26} {fault:12}"
    if built.returncode != 0:
        said = built.stderr.strip().splitlines()[-1] if built.stderr else before.stderr.strip()
        found = early | {"no map"}
        return f"{name} {'':>9} {'':>7} {'':>5}  {' '.join(f'{kind}*' for kind in sorted(early))} NO MAP: {said}", found
    found = set(kinds_of(built.stdout))
    told = " ".join(f"{kind}*" if kind in early else kind for kind in sorted(found)) or "-"
    evaluated = run(options.client, "evaluate", "--map", map_file, "--drive", query, "--out", out, "--method", "milepost")
    if evaluated.returncode != 0:
        return f"{name} {'':>9} {'':>7} {'':>5}  {told} NO FIX: {evaluated.stderr.strip()}", found
    frames, fixes, mean_m, wrong = fixes_of(out)
    return f"{name} {fixes:>4}/{frames:<4} {mean_m:7.3f} {wrong:5}  {told}", found


def main():
    parser = argparse.ArgumentParser(prog="tests/lab/spoilt", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mapper", type=pathlib.Path, metavar="MAPPER")
    parser.add_argument("client", type=pathlib.Path, metavar="CLIENT")
    parser.add_argument("--pair", nargs=2, type=pathlib.Path, action="append", required=True, metavar=("MAP_DRIVE", "QUERY"))
    parser.add_argument("--fault", nargs="+", choices=altered_drive.FAULTS, default=list(altered_drive.FAULTS))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    wanted = [(pair, fault) for pair in options.pair for fault in (AS_RECORDED, *options.fault)]
    print(f"{'mapping drive':26} {'fault':12} {'fixes':>9} {'mean m':>7} {'wrong':>5}  found (*: before the build)", flush=True)
    alarms = 0
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        def one(place):
            number, (pair, fault) = place
            return measure(options, pair, fault, pathlib.Path(folder) / str(number))
        try:
            for (_, fault), (row, found) in zip(wanted, pool.map(one, enumerate(wanted))):
                print(row, flush=True)
                alarms += fault == AS_RECORDED and bool(found)
        except LabError as error:
            sys.exit(f"tests/lab/spoilt: {error}")
    print(f"{alarms} of {len(options.pair)} drives as recorded have a finding")
    sys.exit(alarms > 0)


if __name__ == "__main__":
    main()
