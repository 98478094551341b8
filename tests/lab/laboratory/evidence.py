"""What single frames say for places: for where they were taken, and for the best places elsewhere on the map. A Bayes
factor above f may come up elsewhere in one case of f: more would be evidence that claims too much."""
import math

import numpy as np

from . import figures
from .fixes import read_table
from .honesty import KINDS, as_recorded_or
from .road import earth_centred, read_positions, read_roads
from .studies import Outcome
from .tables import Table

EVERY = 7            # frames of a drive one looks
HERE_M, ELSEWHERE_M = 0.5, 2.0  # nearer, farther than; what lies between is neither
SAME_PLACE_M = 1.0   # of one frame's relocalizations
LOGS = (2, 5)        # of factors


def plan(planner, pairs):
    """{kind of frames: runs}, to be run."""
    return {kind: [planner.run(pair, query=as_recorded_or(kind), relocalizations=EVERY) for pair in pairs] for kind in KINDS}


def relocalizations_of(run):
    """(distance in plan from where the frame was taken, log Bayes factor) of each place that a frame was put at."""
    road = next(iter(read_roads(run.map_file).values()))
    positions = read_positions(run.query_drive)
    seen, found = set(), []
    for row in read_table(run.evaluation.result / "relocalizations.csv"):
        place = (row["filename"], row["segment"], round(float(row["along_m"]) / SAME_PLACE_M))
        if place in seen:
            continue
        seen.add(place)
        told_m = earth_centred(float(row["latitude_deg"]), float(row["longitude_deg"]), road.altitude_m)
        off_m = road.frame.from_earth(np.stack([told_m, positions[row["filename"]]]))[:, :2]
        found.append((float(np.linalg.norm(off_m[0] - off_m[1])), float(row["log_bayes_factor"])))
    return np.array(found).reshape(-1, 2)


def row_of(name, where, logs):
    if not len(logs):
        return [name, where, 0, *[math.nan] * (4 + len(LOGS))]
    shares = [100 * float(np.mean(logs < 0)), *(100 * float(np.mean(logs > limit)) for limit in LOGS)]
    return [name, where, len(logs), *map(float, np.quantile(logs, (0.05, 0.5))), *shares, float(logs.max())]


def outcome(planned):
    """`planned`: {kind of frames: runs that are done}."""
    table = Table(
        "study-evidence", "What single frames say for places",
        f"One frame in {EVERY} is looked with about each sixth metre of the map, as a start does. Natural logarithms of the "
        f"Bayes factor of each place that it is put at, within {HERE_M:g} m of where it was taken, and farther than "
        f"{ELSEWHERE_M:g} m. Factors above e² may come up elsewhere in 13.5 % of cases at most, above e⁵ in 0.7 %.",
        [("frames", "", None), ("place", "", None), ("places", "", 0), ("5 %", "", 1), ("median", "", 1), ("below 0", "%", 1),
         *((f"above {limit}", "%", 2) for limit in LOGS), ("greatest", "", 1)], groups=1)
    everything = []
    for kind, runs in planned.items():
        found = np.concatenate([relocalizations_of(run) for run in runs])
        everything.append(found)
        add_rows(table, kind, found)
    found = np.concatenate(everything)
    add_rows(table, "all", found)
    here, elsewhere = split(found)
    figure = figures.evidence_figure(here, elsewhere)
    return Outcome(table.title, table.note, table, figure, {})


def split(found):
    return found[found[:, 0] < HERE_M, 1], found[found[:, 0] > ELSEWHERE_M, 1]


def add_rows(table, name, found):
    for where, logs in zip(("its own", "elsewhere"), split(found)):
        table.rows.append(row_of(name, where, logs))
