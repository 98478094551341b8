"""milepost's commands as stages: drives are simulated, mapped, and localized with every method."""
import dataclasses
import os
import pathlib
import re
import subprocess
import typing

from .errors import LabError, WrongCall
from .stages import Stage

PROJECT = pathlib.Path(__file__).resolve().parents[3]
ALTER_DRIVE = pathlib.Path(__file__).with_name("altered_drive.py")
STARTS = pathlib.Path(__file__).with_name("starts.py")
BUILT = {"milepost-mapper": "mapper", "milepost-client": "client", "milepost-simulator": "tests/simulator",
         "milepost-relocalizations": "tests/lab"}


def program(name):
    """The built program: $MILEPOST_MAPPER and so on, else that of build/release."""
    variable = name.upper().replace("-", "_")
    path = pathlib.Path(os.environ.get(variable) or PROJECT / "build/release" / BUILT[name] / name)
    if not path.is_file():
        raise LabError(f"{path}: no such program; tests/lab/run builds it")
    return path


def help_of(command):
    called = subprocess.run([program("milepost-client"), command, "--help"], capture_output=True, text=True,
                            stdin=subprocess.DEVNULL, check=False)
    return called.stdout


def known_methods():
    """The names of the methods that the client has, as its help lists them."""
    listed = re.search(r"^\s*--method.*?:\s*((?:[\w-]+,\s*)*[\w-]+)\s*$", help_of("evaluate"), re.MULTILINE)
    if not listed:
        raise LabError("milepost-client evaluate --help: lists no methods; is the program of this version?")
    return re.split(r",\s*", listed.group(1))


def chosen_methods(wanted):
    """The wanted methods in the client's order, or all."""
    known = known_methods()
    for method in wanted:
        if method not in known:
            raise WrongCall(f"--method: '{method}' is no method; choose from {', '.join(known)}")
    return [method for method in known if method in wanted] if wanted else known


def name_with(name, settings):
    """malaga, malaga-max-features-125."""
    return "-".join([name, *(word.lstrip("-") for word in settings)])


@dataclasses.dataclass(frozen=True)
class Alteration:
    """What is altered in a drive: arguments of altered_drive.py, and another drive below a place for its --onto."""

    name: str
    arguments: tuple[str, ...] = ()
    onto: tuple | None = None  # (Place, path)


AS_RECORDED = Alteration("as recorded")


@dataclasses.dataclass
class Run:
    """A pair's evaluation with one setting of the mapper and drives that are altered in one way."""

    pair: object
    map_stage: Stage
    evaluation: Stage
    find_query: typing.Callable  # the folder of the query drive, once its stages are done
    find_taken: typing.Callable | None = None  # of the drive that tells where its frames were taken, if that is another one

    @property
    def map_file(self):
        return self.map_stage.result / "drive.map"

    @property
    def query_drive(self):
        return self.find_query()

    @property
    def taken_drive(self):
        """Of frames that are laid onto another road of one simulated town: where they were taken, in the map's world."""
        return self.find_taken and self.find_taken()


class Planner:
    """Plans the stages of runs. The same map or simulation is planned once, whoever asks for it."""

    def __init__(self, methods):
        self.methods = methods
        self.estimates = ("--estimates",) if "--estimates" in help_of("evaluate") else ()
        self.planned = {}

    def run(self, pair, mapper_settings=(), methods=None, estimates=False, query=AS_RECORDED, map_drive=AS_RECORDED,
            map_of=None, starts=False, relocalizations=0):
        """`mapper_settings` are arguments of `milepost-mapper build`; `methods` are the planner's by default. `map_of`:
        another pair, whose map it is. `starts`: the query is driven in pieces, as starts.py says. `relocalizations`: not driven
        at all, but one frame in so many is looked with everywhere on the map."""
        mapping = self.map(map_of or pair, tuple(mapper_settings), map_drive)
        needs, find_query = self.drive(pair.place, pair.query_drive, query)
        name = name_with(pair.name, mapper_settings)
        chosen = tuple(methods or self.methods)
        if relocalizations:
            evaluation = self.relocalizations(pair, name, mapping, relocalizations, needs, find_query)
        elif starts:
            evaluation = self.starts(pair, name, mapping, chosen, needs, find_query)
        else:
            evaluation = self.evaluate(pair, name, mapping, chosen, self.estimates if estimates else (), needs, find_query)
        find_taken = None
        if query.onto and pair.place.simulate and query.onto[0] == pair.place:
            _, find_taken = self.drive(pair.place, pair.query_drive)
        return Run(pair, mapping, evaluation, find_query, find_taken)

    def simulate(self, place):
        return self.once(("simulate", place), lambda: Stage(
            "simulate", "drives", program("milepost-simulator"), place.simulate,
            lambda out, threads: ["--out", out, "--threads", threads, *place.simulate]))

    def map(self, pair, settings, alteration=AS_RECORDED):
        needs, drive = self.drive(pair.place, pair.map_drive, alteration)

        def plan():
            return Stage(
                "map", name_with(pathlib.PurePath(pair.map_drive).name, settings), program("milepost-mapper"), settings,
                lambda out, threads: ["build", "--drive", drive(), "--map", out / "drive.map", "--lab",
                                      "--jobs", threads, *settings],
                lambda: [drive()], needs)
        return self.once(("map", pair.place, pair.map_drive, settings, alteration), plan)

    def alter(self, place, path, alteration):
        needs, drive = self.drive(place, path)
        more_needs, onto = self.drive(*alteration.onto) if alteration.onto else ((), None)

        def plan():
            return Stage(
                "alter", name_with(pathlib.PurePath(path).name, alteration.arguments), ALTER_DRIVE, alteration.arguments,
                lambda out, threads: [drive(), out / "drive", *alteration.arguments, *(["--onto", onto()] if onto else [])],
                lambda: [drive(), *([onto()] if onto else [])], (*needs, *more_needs))
        return self.once(("alter", place, path, alteration), plan)

    def evaluate(self, pair, name, mapping, methods, flags, needs, drive):
        def plan():
            return Stage(
                "evaluate", name, program("milepost-client"), (*methods, *flags),
                lambda out, threads: ["evaluate", "--map", mapping.result / "drive.map", "--drive", drive(),
                                      "--out", out, *flags, "--method", *methods],
                lambda: [mapping.result / "drive.map", drive()], (mapping, *needs))
        return self.once(("evaluate", pair, mapping, methods, flags, needs), plan)

    def relocalizations(self, pair, name, mapping, every, needs, drive):
        def plan():
            return Stage(
                "relocalizations", name, program("milepost-relocalizations"), (str(every),),
                lambda out, threads: [mapping.result / "drive.map", drive(), every, out / "relocalizations.csv"],
                lambda: [mapping.result / "drive.map", drive()], (mapping, *needs))
        return self.once(("relocalizations", pair, mapping, every, needs), plan)

    def starts(self, pair, name, mapping, methods, needs, drive):
        def plan():
            client = program("milepost-client")
            return Stage(
                "starts", name, STARTS, methods,
                lambda out, threads: [client, mapping.result / "drive.map", drive(), out, *methods],
                lambda: [client, mapping.result / "drive.map", drive(), ALTER_DRIVE], (mapping, *needs))
        return self.once(("starts", pair, mapping, methods, needs), plan)

    def drive(self, place, path, alteration=AS_RECORDED):
        """What has to be done before the drive is there, and a function that says where it is then."""
        if alteration != AS_RECORDED:
            stage = self.alter(place, path, alteration)
            return (stage,), lambda: stage.result / "drive"
        if place.folder:
            return (), lambda: place.folder / path
        simulation = self.simulate(place)
        return (simulation,), lambda: simulation.result / path

    def once(self, key, plan):
        if key not in self.planned:
            self.planned[key] = plan()
        return self.planned[key]
