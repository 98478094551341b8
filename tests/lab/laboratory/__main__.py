"""The command line of the laboratory; tests/lab/run builds the programs and calls it."""
import argparse
import os
import pathlib
import shlex
import signal
import sys
import time

from . import results
from .errors import LabError, WrongCall
from .pairs import read_pairs
from .runs import PROJECT, chosen_methods

STUDIES = ("features", "tracklets", "spacing", "size", "calibration-error", "lateral", "honesty", "evidence")

DESCRIPTION = """\
Measures every method of milepost on a list of map and query drives, and sets the tracklet paper's figures beside
them: Table 1 (methods), Table 2 (estimators on curved and straight road), Figures 5 to 8, precision along, lateral and
in heading, calibration, the paper's claims one by one, and studies of what the error depends on.

PAIRS is a text file, one pair a line: NAME MAP_DRIVE QUERY_DRIVE [TAG...]. A line 'drives FOLDER' says where the
drives after it are, a line 'simulate OPTION...' that milepost-simulator makes them. tests/lab/pairs holds lists."""

EPILOG = """\
examples:
  tests/lab/run tests/lab/pairs/street.txt                                 a simulated street, in a minute
  tests/lab/run tests/lab/pairs/town.txt --studies all                     the town, with every study
  tests/lab/run tests/lab/pairs/recordings.txt --method milepost tracklet-regression-kalman
  tests/lab/run tests/lab/pairs/town.txt --results tests/lab/RESULTS.md    and notes the figures there

Results in OUT: report.html (open it in a browser), table1, table1-pairs, table2, precision, calibration, normality,
study-NAME, latency and latency-precision as .txt and .csv, claims.txt. The same programs and drives give the same bytes, but for latency*.
Stages are cached: a second call is quick, a run that was interrupted goes on where it was.
Exit code: 0 all was done, 1 something failed, 2 a wrong call. tests/lab/README.md explains each table and figure."""


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise WrongCall(f"{message}; see tests/lab/run --help")


def parse(arguments):
    parser = Parser(prog="tests/lab/run", description=DESCRIPTION, epilog=EPILOG,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pairs", metavar="PAIRS", help="list of map and query drives")
    parser.add_argument("--out", metavar="DIR", type=pathlib.Path,
                        help="folder for the results (build/lab/NAME, after the list)")
    parser.add_argument("--method", metavar="M", nargs="+", default=[],
                        help="methods to measure (all that milepost-client has)")
    parser.add_argument("--studies", metavar="S", nargs="+", default=["lateral"],
                        help=f"studies to run: {', '.join(STUDIES)}, all or none (lateral, which needs no further run)")
    parser.add_argument("--situations", metavar="WORDS", nargs="+", default=[],
                        help="of the study honesty only situations whose names begin so, 'wrong road' for example (all)")
    parser.add_argument("--jobs", metavar="N", type=int, default=len(os.sched_getaffinity(0)),
                        help="processes at a time (the number of processors)")
    parser.add_argument("--cache", metavar="DIR", type=pathlib.Path, default=PROJECT / "build/lab/cache",
                        help="folder of stages that are done (build/lab/cache)")
    parser.add_argument("--results", metavar="FILE", type=pathlib.Path,
                        help="Markdown file in which to write, or replace, this list's section")
    parser.add_argument("--check", action="store_true", help=argparse.SUPPRESS)  # of the call only
    options = parser.parse_intermixed_args(arguments)
    if options.jobs < 1:
        raise WrongCall(f"--jobs: {options.jobs} is no number of processes; give 1 or more")
    options.studies = chosen_studies(options.studies)
    if options.situations and "honesty" not in options.studies:
        raise WrongCall("--situations: these belong to the study honesty; give --studies honesty, too")
    return options


def chosen_studies(arguments):
    for word in arguments:
        if word not in (*STUDIES, "all", "none"):
            raise WrongCall(f"--studies: '{word}' is no study; choose from {', '.join(STUDIES)}, all, none")
    return [study for study in STUDIES if study in arguments or "all" in arguments]


def shown_command(options):
    """The call as it stands in RESULTS.md: what changes the figures."""
    arguments = ["tests/lab/run", options.pairs]
    if options.method:
        arguments += ["--method", *options.method]
    arguments += ["--studies", *(options.studies or ["none"])]
    if options.situations:
        arguments += ["--situations", *options.situations]
    return shlex.join(arguments)


def timing(stages, seconds):
    """Where the processors' time went."""
    lines = []
    for kind in dict.fromkeys(stage.kind for stage in stages):
        of_kind = [stage for stage in stages if stage.kind == kind]
        ran = [stage for stage in of_kind if not stage.cached]
        lines.append(f"  {kind:10} {len(ran):4} run, {sum(stage.seconds for stage in ran):7.1f} processor seconds; "
                     f"{len(of_kind) - len(ran):4} from the cache")
    return "\n".join([f"Stages ({seconds:.0f} s in all):", *lines])


def run(options):
    from .laboratory import Laboratory  # numpy and scipy are slow to load: not for a wrong call
    from .stages import Cache

    began = time.monotonic()
    name = pathlib.Path(options.pairs).stem
    lab = Laboratory(name, read_pairs(options.pairs), chosen_methods(options.method), options.studies, options.situations)
    with Cache(options.cache, options.jobs, say=lambda text: print(text, flush=True)).opened() as cache:
        lab.measure(cache)
    out = options.out or PROJECT / "build/lab" / name
    lab.write(out)
    if options.results:
        old = options.results.read_text(encoding="utf-8") if options.results.exists() else ""
        options.results.write_text(results.replaced(old, name, lab.results_section(shown_command(options))),
                                   encoding="utf-8")
    print(f"\n{lab.text()}")
    print(timing(lab.planner.planned.values(), time.monotonic() - began))
    print(f"Report: {out / 'report.html'}")


def main(arguments):
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    try:
        options = parse(arguments)
        if options.check:
            read_pairs(options.pairs)
        else:
            run(options)
        return 0
    except LabError as error:
        print(f"tests/lab/run: {error}", file=sys.stderr)
        return error.code
    except KeyboardInterrupt:
        print("tests/lab/run: interrupted; the next call goes on from here", file=sys.stderr)
        return 128 + signal.SIGINT


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
