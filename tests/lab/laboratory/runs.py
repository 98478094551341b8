"""milepost's commands as stages: drives are simulated, mapped, and localized with every method."""
import dataclasses
import os
import pathlib
import re
import subprocess

from .errors import LabError, WrongCall
from .stages import Stage

PROJECT = pathlib.Path(__file__).resolve().parents[3]
ALTER_DRIVE = pathlib.Path(__file__).with_name("altered_drive.py")
BUILT = {"milepost-mapper": "mapper", "milepost-client": "client", "milepost-simulator": "tests/simulator"}


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
class Calibration:
    """What a query drive says of its camera, against what was recorded."""

    name: str
    focal_factor: float = 1
    yaw_deg: float = 0

    @property
    def as_recorded(self):
        return self.focal_factor == 1 and self.yaw_deg == 0


AS_RECORDED = Calibration("as recorded")


@dataclasses.dataclass
class Run:
    """A pair's evaluation with one setting of the mapper and one calibration of the query's camera."""

    pair: object
    map_stage: Stage
    evaluation: Stage

    @property
    def map_file(self):
        return self.map_stage.result / "drive.map"


class Planner:
    """Plans the stages of runs. The same map or simulation is planned once, whoever asks for it."""

    def __init__(self, methods):
        self.methods = methods
        self.estimates = ("--estimates",) if "--estimates" in help_of("evaluate") else ()
        self.planned = {}

    def run(self, pair, mapper_settings=(), methods=None, estimates=False, calibration=AS_RECORDED):
        """`mapper_settings` are words of `milepost-mapper build`; `methods` are the planner's by default."""
        mapping = self.map(pair, tuple(mapper_settings))
        evaluation = self.evaluate(pair, name_with(pair.name, mapper_settings), mapping,
                                   tuple(methods or self.methods), self.estimates if estimates else (), calibration)
        return Run(pair, mapping, evaluation)

    def simulate(self, place):
        return self.once(("simulate", place), lambda: Stage(
            "simulate", "drives", program("milepost-simulator"), place.simulate,
            lambda out, threads: ["--out", out, "--threads", threads, *place.simulate]))

    def map(self, pair, settings):
        def plan():
            needs, drive = self.drive(pair.place, pair.map_drive)
            return Stage(
                "map", name_with(pathlib.PurePath(pair.map_drive).name, settings), program("milepost-mapper"), settings,
                lambda out, threads: ["build", "--drive", drive(), "--map", out / "drive.map", "--lab",
                                      "--jobs", threads, *settings],
                lambda: [drive()], needs)
        return self.once(("map", pair.place, pair.map_drive, settings), plan)

    def alter(self, place, path, calibration):
        settings = (str(calibration.focal_factor), str(calibration.yaw_deg))

        def plan():
            needs, drive = self.drive(place, path)
            return Stage(
                "alter", name_with(pathlib.PurePath(path).name, settings), ALTER_DRIVE, settings,
                lambda out, threads: [drive(), out / "drive", *settings], lambda: [drive()], needs)
        return self.once(("alter", place, path, settings), plan)

    def evaluate(self, pair, name, mapping, methods, flags, calibration):
        def plan():
            needs, drive = self.drive(pair.place, pair.query_drive, calibration)
            return Stage(
                "evaluate", name, program("milepost-client"), (*methods, *flags),
                lambda out, threads: ["evaluate", "--map", mapping.result / "drive.map", "--drive", drive(),
                                      "--out", out, *flags, "--method", *methods],
                lambda: [mapping.result / "drive.map", drive()], (mapping, *needs))
        return self.once(("evaluate", pair, mapping, methods, flags, calibration), plan)

    def drive(self, place, path, calibration=AS_RECORDED):
        """What has to be done before the drive is there, and a function that says where it is then."""
        if not calibration.as_recorded:
            alteration = self.alter(place, path, calibration)
            return (alteration,), lambda: alteration.result / "drive"
        if place.folder:
            return (), lambda: place.folder / path
        simulation = self.simulate(place)
        return (simulation,), lambda: simulation.result / path

    def drive_folder(self, place, path):
        """Where the drive is, once its stages have been run."""
        return self.drive(place, path)[1]()

    def once(self, key, plan):
        if key not in self.planned:
            self.planned[key] = plan()
        return self.planned[key]
