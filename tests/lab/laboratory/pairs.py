"""Lists of map and query drives: the laboratory's input.

A list is a text file, one pair a line: NAME MAP_DRIVE QUERY_DRIVE [TAG...], fields apart by blanks or
commas, '#' before a comment. Two other lines say where the drives after them are:

  drives FOLDER       relative to the list's own folder, which is also the default
  simulate OPTION...  drives that milepost-simulator makes with these options, when they are needed

The tag `truth-0.25m` says that the recorded positions are good to 0.25 m only, one sigma; `reversed` that the query is
driven in the opposite direction. The tag `study` marks the pairs that studies run on; where none is marked they run on all.
"""
import dataclasses
import pathlib
import re

from .errors import LabError, WrongCall

TRUTH = re.compile(r"truth-(\d+(?:\.\d+)?)m")
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")


@dataclasses.dataclass(frozen=True)
class Place:
    """Where drives are: in a folder, or in what the simulator makes of some options."""

    folder: pathlib.Path | None = None
    simulate: tuple[str, ...] = ()


@dataclasses.dataclass(frozen=True)
class Pair:
    """A drive to make a map of, and a drive to localize on it. The drives are paths below the place."""

    name: str
    place: Place
    map_drive: str
    query_drive: str
    tags: frozenset[str] = frozenset()

    @property
    def truth_sigma_m(self):
        """Of the recorded positions of the query, as far as it is known."""
        return next((float(found[1]) for tag in self.tags if (found := TRUTH.fullmatch(tag))), 0.0)


def read_pairs(path):
    """The pairs of a list, in its order. Drives in folders have been checked to be there."""
    path = pathlib.Path(path)
    if not path.is_file():
        raise WrongCall(f"{path}: no such list of pairs; tests/lab/pairs holds some")
    pairs = []
    place = Place(folder=path.parent)
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        fields = re.split(r"[,\s]+", line.split("#")[0].strip(" ,\t"))
        if fields == [""]:
            continue
        where = f"{path}, line {number}"
        if fields[0] == "simulate":
            place = Place(simulate=tuple(fields[1:]))
        elif fields[0] == "drives":
            place = Place(folder=path.parent / " ".join(fields[1:]))
            if not place.folder.is_dir():
                raise LabError(f"{where}: {place.folder}: no such folder of drives; put the drives "
                               "there or name another folder")
        else:
            pairs.append(pair_of(fields, place, where, pairs))
    if not pairs:
        raise WrongCall(f"{path}: holds no pair; write 'NAME MAP_DRIVE QUERY_DRIVE' on a line")
    return pairs


def pair_of(fields, place, where, earlier):
    if len(fields) < 3:
        raise WrongCall(f"{where}: a pair is NAME MAP_DRIVE QUERY_DRIVE [TAG...], not '{' '.join(fields)}'")
    pair = Pair(fields[0], place, fields[1], fields[2], frozenset(fields[3:]))
    if not NAME.fullmatch(pair.name):
        raise WrongCall(f"{where}: '{pair.name}' cannot name a pair; use letters, digits, '-', '_' and '.'")
    if any(other.name == pair.name for other in earlier):
        raise WrongCall(f"{where}: there is a pair '{pair.name}' already; give this one another name")
    if place.folder:
        for drive in (pair.map_drive, pair.query_drive):
            if not (place.folder / drive / "drive.json").is_file():
                raise LabError(f"{where}: {place.folder / drive}: is no drive folder (no drive.json); "
                               "correct the path")
    return pair


def study_pairs(pairs):
    """Those tagged `study`, or all."""
    return [pair for pair in pairs if "study" in pair.tags] or list(pairs)
