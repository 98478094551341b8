"""Right or silent: what is claimed where the map ends, after spoilt starts, on wrong roads, after a push, and with less
than the map or the camera should be. Counted in plan: position against position, with both sigmas together."""
import dataclasses
import math

import numpy as np

from . import figures, paper
from .altered_drive import RECORDS, SPOILS
from .errors import WrongCall
from .fixes import column, read_table, sigmas_against_map
from .road import earth_centred, read_positions, read_roads
from .runs import AS_RECORDED, Alteration
from .studies import CALIBRATIONS, Outcome
from .tables import Table

PARTS = ((0.3, 0.7), (0.1, 0.5))  # of a mapping drive's frames
LEAPS_M = (5, 10, 20, 30)
KINDS = ("plain", *SPOILS)
REVERSED = "reversed"  # tag of pairs whose query is driven in the opposite direction

WRONG_M, WRONG_SIGMAS = 1.0, 5.0  # beyond both a fix is confidently wrong
BEYOND_SIGMAS = 4
ON_MAP_M = 6.0           # from the map's line
STRANGE_SIGMA_M = 1.0    # a claim, on a road that is not the map's
START_SIGMA_M, START_SIGMAS = 0.3, 3  # a start tracks
FIRST_FIXES = 3


@dataclasses.dataclass(frozen=True)
class Situation:
    """Runs that are counted together. `in_frames`: within which the vehicle has to know where it is, from the start
    of a piece, from where it comes onto the map, or from the push."""

    name: str
    group: str  # of the figure
    kind: str = "whole"  # or part, start, push, strange, first
    in_frames: int = 0


def as_recorded_or(kind):
    return AS_RECORDED if kind == "plain" else Alteration(kind, ("--spoil", kind))


def plan(planner, pairs, methods, wanted=()):
    """{Situation: runs}, to be run: of situations whose name begins with one of the names asked for, or of all."""
    methods = [method for method in (paper.OURS,) if method in methods] or list(methods)
    ahead = [pair for pair in pairs if REVERSED not in pair.tags]
    back = [pair for pair in pairs if REVERSED in pair.tags]

    def runs(chosen=None, **alterations):
        return [planner.run(pair, methods=methods, **alterations) for pair in (ahead if chosen is None else chosen)]

    planned = {Situation("whole map", "whole map"): runs()}
    planned[Situation(f"its first {FIRST_FIXES} fixes", "whole map", "first")] = runs()
    for kind in KINDS:
        planned[Situation(f"part of the map, {kind}", "part of the map", "part", 3)] = [
            run for low, high in PARTS for run in runs(
                query=as_recorded_or(kind),
                map_drive=Alteration(f"{low:.0%} to {high:.0%}", ("--part", str(low), str(high))))]
    for kind in KINDS:
        planned[Situation(f"start, {kind}", "starts", "start", 3 if kind == "plain" else 10)] = runs(
            query=as_recorded_or(kind), starts=True)
    roads = {(pair.place, pair.map_drive): pair for pair in ahead}
    strange = [run for road, map_of in roads.items()
               for run in runs([pair for pair in ahead if (pair.place, pair.map_drive) != road], map_of=map_of,
                               query=Alteration("wrong road", onto=road))]
    if strange:
        planned[Situation("wrong road", "", "strange")] = strange
    if back:
        planned[Situation("opposite direction", "", "strange")] = runs(back)
    for leap_m in LEAPS_M:
        planned[Situation(f"pushed {leap_m} m along", "pushed", "push", 5)] = runs(
            query=Alteration(f"pushed {leap_m} m", ("--leap-m", str(leap_m))))
    for calibration in CALIBRATIONS[1:]:
        planned[Situation(calibration.name, "altered")] = runs(query=calibration)
    for kind in RECORDS:
        planned[Situation(f"map drive, {kind}", "map drives recorded worse")] = runs(
            map_drive=Alteration(kind, ("--record", kind)))
    planned[Situation("125 features a frame", "altered")] = runs(mapper_settings=("--max-features", "125"))
    planned[Situation("map frames 4.9 m apart", "altered")] = runs(mapper_settings=("--min-frame-spacing-m", "4.9"))
    for word in wanted:
        if not any(situation.name.startswith(word) for situation in planned):
            raise WrongCall(f"--situations: no situation of these pairs begins with '{word}'; choose from "
                            + ", ".join(situation.name for situation in planned))
    return {situation: these for situation, these in planned.items() if not wanted or situation.name.startswith(tuple(wanted))}


@dataclasses.dataclass
class Drive:
    """What one evaluation told; arrays have one entry a frame, NaN where nothing was told."""

    name: str
    method: str
    tracking: np.ndarray
    error_m: np.ndarray  # in plan
    sigma_m: np.ndarray  # claimed, and of the recorded positions
    along_error_m: np.ndarray
    along_sigma_m: np.ndarray  # claimed
    truth_sigma_m: float
    on_map: np.ndarray
    has_begun: np.ndarray  # whether the frame lies after the beginning of a road
    step_m: np.ndarray  # from the frame before
    taken_error_m: np.ndarray  # in plan, from where the frame was taken, if that lies in the map's world
    sigma_map_m: np.ndarray  # as sigma_m, but claimed against the map

    @property
    def told(self):
        return np.isfinite(self.error_m)

    @property
    def sigmas(self):
        return self.error_m / self.sigma_m

    @property
    def sigmas_of_map(self):
        return self.error_m / self.sigma_map_m

    @property
    def wrong(self):
        return self.told & (self.error_m > np.maximum(WRONG_M, WRONG_SIGMAS * self.sigma_m))


def read_drives(run):
    """Of each piece, or of the whole drive, and each method."""
    folder = run.evaluation.result
    pieces = sorted(each for each in folder.iterdir() if each.is_dir()) if run.evaluation.kind == "starts" else [folder]
    roads = list(read_roads(run.map_file).values())
    positions = read_positions(run.query_drive)
    taken = read_positions(run.taken_drive) if run.taken_drive else None
    return [read_drive(file, run, roads, positions, taken) for piece in pieces for file in sorted(piece.glob("fixes-*.csv"))]


def read_drive(file, run, roads, positions, taken):
    """`positions` and `taken`: earth-centred, by frame; `taken` None where it is not in the map's world."""
    rows, frame = read_table(file), roads[0].frame

    def in_plan_m(places):
        return frame.from_earth(np.array([places[row["filename"]] for row in rows]))[:, :2]

    truth_m = in_plan_m(positions)
    altitude_m = roads[0].altitude_m
    told_m = frame.from_earth(earth_centred(column(rows, "latitude_deg"), column(rows, "longitude_deg"), altitude_m))
    lateral_sigma_m = np.nan_to_num(column(rows, "lateral_sigma_m"))
    along_sigma_m = column(rows, "sigma_m")
    along_map_m, lateral_map_m = sigmas_against_map(rows)
    return Drive(
        name=run.pair.name, method=file.stem.removeprefix("fixes-"),
        tracking=np.array([row["status"] == "tracking" for row in rows]),
        error_m=np.linalg.norm(told_m[:, :2] - truth_m, axis=1),
        sigma_m=np.sqrt(along_sigma_m ** 2 + lateral_sigma_m ** 2 + run.pair.truth_sigma_m ** 2),
        along_error_m=np.abs(column(rows, "error_m")), along_sigma_m=along_sigma_m, truth_sigma_m=run.pair.truth_sigma_m,
        on_map=np.min([np.abs(road.lateral_m(truth_m)) for road in roads], axis=0) < ON_MAP_M,
        has_begun=np.any([road.has_begun_at(truth_m) for road in roads], axis=0),
        step_m=np.linalg.norm(np.diff(truth_m, axis=0, prepend=truth_m[:1]), axis=1),
        taken_error_m=(np.linalg.norm(told_m[:, :2] - in_plan_m(taken), axis=1) if taken
                       else np.full(len(rows), math.inf)),
        sigma_map_m=np.sqrt(along_map_m ** 2 + np.nan_to_num(lateral_map_m) ** 2 + run.pair.truth_sigma_m ** 2))


def known_in_time(situation, drive):
    """Whether the vehicle knows where it is in time, or (after a push) says that it does not; None: not asked."""
    within = situation.in_frames
    if situation.kind == "start":
        known = (drive.tracking & (drive.along_sigma_m <= START_SIGMA_M)
                 & (drive.along_error_m <= START_SIGMAS * np.hypot(drive.along_sigma_m, drive.truth_sigma_m)))
        return bool(known[:within].any())
    if situation.kind == "part":
        entered = drive.on_map & drive.has_begun
        first = int(np.argmax(entered))
        return bool(drive.tracking[first:first + within + 1].any()) if entered[first] else None
    if situation.kind == "push":
        pushed = int(np.argmax(drive.step_m))
        after = slice(pushed, pushed + within + 1)
        right = drive.tracking & (drive.error_m < WRONG_M)
        return bool((right | ~drive.tracking)[after].any()) and not drive.wrong[after].any()
    return None


def wrong_of(situation, drive):
    """Marks the confidently wrong frames. On a road that is not the map's every claim is wrong, but for one that tells
    where the frame was taken: roads of one town share streets."""
    if situation.kind == "strange":
        claimed = drive.tracking | drive.told & (drive.sigma_m < STRANGE_SIGMA_M)
        return claimed & ~(drive.taken_error_m <= np.maximum(WRONG_M, WRONG_SIGMAS * drive.sigma_m))
    return drive.wrong


def first_fixes(drive):
    """The drive as far as its first fixes that are tracked."""
    kept = np.flatnonzero(drive.tracking & drive.told)[:FIRST_FIXES]
    return dataclasses.replace(drive, **{each.name: getattr(drive, each.name)[kept] for each in dataclasses.fields(drive)
                                         if each.name not in ("name", "method", "truth_sigma_m")})


COLUMNS = [("frames", "", 0), ("on the map", "", 0), ("tracked", "", 0), ("wrong", "", 0), ("in time", "", None),
           ("mean", "m", 3), ("p95", "m", 3), ("max", "m", 2), ("max", "sigmas", 1), ("within 1", "%", 1),
           ("within 2", "%", 1), (f"beyond {BEYOND_SIGMAS}", "%", 2), ("map: within 2", "%", 1),
           (f"map: beyond {BEYOND_SIGMAS}", "%", 2)]


def cells_of(situation, drives):
    """The table's cells of drives that are counted together."""
    def together(of):
        return np.concatenate([of(drive) for drive in drives])

    told, tracking = together(lambda drive: drive.told), together(lambda drive: drive.tracking)
    times = [known for drive in drives if (known := known_in_time(situation, drive)) is not None]
    counts = [len(told), int(together(lambda drive: drive.on_map).sum()), int(tracking.sum()),
              int(together(lambda drive: wrong_of(situation, drive)).sum()),
              f"{sum(times)} of {len(times)}" if times else "–"]
    if situation.kind == "strange":
        counts[1] = math.nan
        return [*counts, *[math.nan] * (len(COLUMNS) - len(counts))]
    error_m = together(lambda drive: drive.error_m)
    sigmas = together(lambda drive: drive.sigmas)[told]
    of_map = together(lambda drive: drive.sigmas_of_map)[told]
    tracked_m = error_m[told & tracking]
    spread = ([tracked_m.mean(), np.quantile(tracked_m, 0.95), tracked_m.max()] if len(tracked_m) else [math.nan] * 3)
    shares = ([sigmas.max(), *(100 * np.mean(sigmas <= count) for count in (1, 2)),
               100 * np.mean(sigmas > BEYOND_SIGMAS), 100 * np.mean(of_map <= 2), 100 * np.mean(of_map > BEYOND_SIGMAS)]
              if len(sigmas) else [math.nan] * 6)
    return [*counts, *map(float, [*spread, *shares])]


NOTE = (f"A fix is confidently wrong that is off by more than {WRONG_M:g} m and by more than {WRONG_SIGMAS:g} of its own "
        "sigmas, in plan; on a wrong road and in the opposite direction every fix that says `tracking` or a sigma below "
        f"{STRANGE_SIGMA_M:g} m is, unless it is where the frame was taken (streets that roads of a town share). Mean, 95th percentile and maximum are of tracked frames, the shares within 1 and 2 and "
        f"beyond {BEYOND_SIGMAS} sigmas of all that were told; where the recorded positions are known to be rough, their sigma is "
        "added. After map: the same of the sigma against the map, as if its own positions were exact, which they are where map and "
        "query have one truth. Parts are 30 to 70 % and 10 to 50 % of a map drive's "
        "frames; on the map is within 6 m of its line. Starts are pieces of 20 frames, one each 12, with one receiver "
        "position. In time: starts track (sigma at most 0.3 m, error within 3 sigma, along) within 3 frames, spoilt ones "
        "within 10; on parts within 3 frames of coming onto the map; a push is found out within 5 frames and nothing wrong "
        "is claimed meanwhile.")


def outcome(planned):
    """`planned`: {Situation: runs that are done}."""
    table = Table("study-honesty", "Right or silent", NOTE,
                  [("situation", "", None), ("method", "", None), *COLUMNS])
    by_drive = Table("study-honesty-drives", "Right or silent, drive by drive", NOTE,
                     [("situation", "", None), ("method", "", None), ("pair", "", None), *COLUMNS], groups=1)
    sigmas = {}
    for situation, runs in planned.items():
        drives = [drive for run in runs for drive in read_drives(run)]
        if situation.kind == "first":
            drives = [first_fixes(drive) for drive in drives]
        for method in dict.fromkeys(drive.method for drive in drives):
            of_method = [drive for drive in drives if drive.method == method]
            table.rows.append([situation.name, method, *cells_of(situation, of_method)])
            for name in dict.fromkeys(drive.name for drive in of_method):
                here = [drive for drive in of_method if drive.name == name]
                by_drive.rows.append([situation.name, method, name, *cells_of(situation, here)])
            if situation.group and situation.kind != "first" and method == paper.OURS:
                sigmas.setdefault(situation.group, []).extend(drive.sigmas[drive.told] for drive in of_method)
    figure = figures.honesty_figure({group: np.concatenate(parts) for group, parts in sigmas.items()})
    return Outcome(table.title, "Share of fixes whose error is more than so many of their own sigmas, in plan. " + NOTE,
                   table, figure, {}, by_drive)
