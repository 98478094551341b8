"""What counts as wrong, as in time, and which runs a study of honesty asks for."""
import math
import os
import pathlib
import subprocess
import tempfile
import types
import unittest
from unittest import mock

import numpy as np

from laboratory import honesty
from laboratory.errors import WrongCall
from laboratory.honesty import Drive, Situation
from laboratory.pairs import Pair, Place
from laboratory.road import LocalFrame, Road
from laboratory.runs import STARTS, Planner
from made_up import write_drive

PLACE = Place(folder=pathlib.Path("/drives"))
PAIRS = [Pair("a", PLACE, "a-map", "a-query"), Pair("a2", PLACE, "a-map", "a-query2"), Pair("b", PLACE, "b-map", "b-query"),
         Pair("c", Place(simulate=("--seed", "2")), "a-map", "a-query"),
         Pair("back", PLACE, "a-map", "a-back", frozenset({"reversed"}))]
METHODS = ["tracklet-regression-kalman", "milepost"]


def drive(error_m, sigma_m=0.1, tracking=True, on_map=True, has_begun=True, step_m=1.0, along_m=None, taken_m=math.inf):
    def of_frames(values, kind=float):
        return np.broadcast_to(np.asarray(values, kind), len(error_m)).copy()
    return Drive("a", "milepost", of_frames(tracking, bool), of_frames(error_m), of_frames(sigma_m),
                 of_frames(error_m if along_m is None else along_m), of_frames(sigma_m), 0.0, of_frames(on_map, bool),
                 of_frames(has_begun, bool), of_frames(step_m), of_frames(taken_m), of_frames(sigma_m) / 2)


def cells(situation, *drives):
    headings = [f"{heading} {unit}".strip() for heading, unit, _ in honesty.COLUMNS]
    return dict(zip(headings, honesty.cells_of(situation, drives)))


class Counting(unittest.TestCase):
    def test_confidently_wrong_is_beyond_a_metre_and_five_sigmas(self):
        found = cells(Situation("s", ""), drive([0.9, 1.1, 3.0, 3.0, math.nan], [0.1, 0.3, 0.5, 0.7, math.nan]))
        self.assertEqual((found["frames"], found["wrong"]), (5, 1))
        self.assertAlmostEqual(found["max sigmas"], 9)
        self.assertEqual(found["beyond 4 %"], 75)

    def test_spread_is_of_tracked_frames_and_shares_of_all_told(self):
        found = cells(Situation("s", ""), drive([0.1, 0.3, 8], [0.2, 0.2, 10], tracking=[True, True, False]))
        self.assertAlmostEqual(found["mean m"], 0.2)
        self.assertAlmostEqual(found["max m"], 0.3)
        self.assertEqual(found["tracked"], 2)
        self.assertAlmostEqual(found["within 1 %"], 200 / 3)
        self.assertEqual(found["within 2 %"], 100)
        self.assertAlmostEqual(found["map: within 2 %"], 200 / 3)  # half the sigma: of 1, 3, 1.6

    def test_on_a_strange_road_every_claim_is_wrong(self):
        strange = Situation("s", "", "strange")
        found = cells(strange, drive([0, 0, 0, math.nan], [20, 0.9, 20, math.nan], tracking=[True, False, False, False]))
        self.assertEqual((found["wrong"], found["in time"]), (2, "–"))
        self.assertTrue(math.isnan(found["mean m"]))

    def test_on_a_shared_street_of_a_strange_road_the_true_place_is_right(self):
        strange = Situation("s", "", "strange")
        self.assertEqual(cells(strange, drive([50] * 4, [0.1, 0.1, 0.1, 0.4], taken_m=[0.1, 0.9, 1.1, 1.1]))["wrong"], 1)
        self.assertEqual(cells(strange, drive([50, math.nan], 0.1, taken_m=math.nan))["wrong"], 2)

    def test_nothing_told_is_counted_as_nothing(self):
        found = cells(Situation("s", ""), drive([math.nan], math.nan, tracking=False))
        self.assertEqual((found["frames"], found["wrong"], found["tracked"]), (1, 0, 0))
        self.assertTrue(math.isnan(found["max sigmas"]))

    def test_a_start_tracks_within_its_frames_and_its_sigma(self):
        start = Situation("s", "", "start", in_frames=3)
        late = drive([9, 9, 9, 0.1], tracking=[False, False, False, True])
        wide = drive([0.1] * 3, sigma_m=0.31)
        off = drive([0.1] * 3, along_m=0.31)
        good = drive([9, 9, 0.1, 9], tracking=[False, False, True, False])
        self.assertEqual(cells(start, late, wide, off, good)["in time"], "1 of 4")

    def test_onto_a_part_within_frames_of_its_beginning(self):
        part = Situation("s", "", "part", in_frames=3)
        before = [False, False, True, True, True, True, True]
        near = drive([0.1] * 7, on_map=True, has_begun=before, tracking=[False] * 5 + [True] * 2)
        late = drive([0.1] * 7, on_map=True, has_begun=before, tracking=[False] * 6 + [True])
        never = drive([0.1] * 7, on_map=False, tracking=False)
        self.assertEqual(cells(part, near, late, never)["in time"], "1 of 2")

    def test_a_push_is_found_out_and_nothing_wrong_is_claimed_meanwhile(self):
        push = Situation("s", "", "push", in_frames=5)
        step_m = [1, 1, 10, 1, 1, 1, 1, 1, 1]
        said = drive([0] * 9, step_m=step_m, tracking=[True, True, False] + [True] * 6)
        believed = drive([0, 0, 9, 9, 9, 0, 0, 0, 0], step_m=step_m)
        late = drive([0, 0] + [0.5, 1.1] * 3 + [0], sigma_m=1, step_m=step_m, tracking=True)
        self.assertEqual(cells(push, said)["in time"], "1 of 1")
        self.assertEqual(cells(push, believed)["in time"], "0 of 1")
        self.assertEqual(cells(push, late)["in time"], "1 of 1")
        wide = drive([0, 0] + [2] * 7, sigma_m=1, step_m=step_m)
        self.assertEqual(cells(push, wide)["in time"], "0 of 1")

    def test_first_fixes_are_the_first_that_are_tracked(self):
        first = honesty.first_fixes(drive([math.nan, 5, 1, 2, 3, 4], tracking=[False, False, True, True, True, True]))
        np.testing.assert_equal(first.error_m, [1, 2, 3])
        self.assertEqual(cells(Situation("s", "", "first"), honesty.first_fixes(drive([1.0], tracking=False)))["frames"], 0)


class Plans(unittest.TestCase):
    def test_every_situation_has_its_runs(self):
        planned = honesty.plan(Planner(METHODS), PAIRS, METHODS)
        names = {situation.name: runs for situation, runs in planned.items()}
        self.assertEqual([run.pair.name for run in names["whole map"]], ["a", "a2", "b", "c"])
        self.assertEqual([run.pair.name for run in names["opposite direction"]], ["back"])
        self.assertEqual(len(names["part of the map, soft"]), 8)
        self.assertEqual(len({run.map_stage for run in names["part of the map, soft"]}), 6)
        self.assertEqual({run.map_stage for run in names["part of the map, soft"]},
                         {run.map_stage for run in names["part of the map, plain"]})
        self.assertEqual([run.evaluation.kind for run in names["start, dark"]], ["starts"] * 4)
        a, b, c = (names["whole map"][index].map_stage for index in (0, 2, 3))
        wrong = [(run.pair.name, run.map_stage) for run in names["wrong road"]]
        self.assertCountEqual(wrong, [("b", a), ("c", a), ("a", b), ("a2", b), ("c", b), ("a", c), ("a2", c), ("b", c)])
        self.assertEqual({run.taken_drive for run in names["wrong road"]}, {None})
        self.assertIn("--max-features", names["125 features a frame"][0].map_stage.settings)
        for run in names["whole map"]:
            self.assertEqual(run.evaluation.settings, ("milepost",))

    def test_only_what_is_wanted_is_run(self):
        planned = honesty.plan(Planner(METHODS), PAIRS, METHODS, ["wrong", "start, s"])
        self.assertEqual([situation.name for situation in planned], ["start, soft", "wrong road"])
        with self.assertRaisesRegex(WrongCall, "'rain'.*whole map"):
            honesty.plan(Planner(METHODS), PAIRS, METHODS, ["wrong", "rain"])

    def test_frames_of_one_town_tell_where_they_were_taken(self):
        town = Place(simulate=("--seed", "3"))
        pairs = [Pair("a", town, "a-map", "a-query"), Pair("b", town, "b-map", "b-query"),
                 Pair("c", Place(simulate=("--seed", "4")), "a-map", "a-query")]
        planner = Planner(METHODS)
        names = {situation.name: runs for situation, runs in honesty.plan(planner, pairs, METHODS).items()}
        planner.simulate(town).result = pathlib.Path("/made")
        told = {(run.pair.name, run.map_stage.name, run.pair.place == town): run.taken_drive for run in names["wrong road"]
                if run.find_taken}
        self.assertEqual(told, {("a", "b-map", True): pathlib.Path("/made/a-query"),
                                ("b", "a-map", True): pathlib.Path("/made/b-query")})


class Reading(unittest.TestCase):
    def test_errors_are_distances_in_plan(self):
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            write_drive(folder / "query", frames=4, step_m=10)
            write_drive(folder / "taken", frames=4, step_m=12)
            (folder / "result").mkdir()
            header = "filename,status,latitude_deg,longitude_deg,sigma_m,lateral_sigma_m,error_m,sigma_map_m\n"
            (folder / "result/fixes-milepost.csv").write_text(
                header + f"0.jpg,initializing,,,,,,\n1.jpg,tracking,{10 / 110574:.10f},{3 / 111320:.10f},0.3,0.4,0.01,0.1\n"
                f"2.jpg,predicted,{24 / 110574:.10f},0,0.2,,4,0.2\n3.jpg,off-map,,,,,,\n")
            run = types.SimpleNamespace(pair=PAIRS[0], query_drive=folder / "query", taken_drive=folder / "taken", map_file=folder / "drive.map",
                                        evaluation=types.SimpleNamespace(kind="evaluate", result=folder / "result"))
            with mock.patch.object(honesty, "read_roads", lambda file: {"road": self.northwards()}):
                (read,) = honesty.read_drives(run)
        self.assertEqual((read.name, read.method), ("a", "milepost"))
        np.testing.assert_allclose(read.error_m, [math.nan, 3, 4, math.nan], atol=0.01)
        np.testing.assert_allclose(read.taken_error_m, [math.nan, math.hypot(3, 2), 0, math.nan], atol=0.02)
        np.testing.assert_allclose(read.sigma_m, [math.nan, 0.5, 0.2, math.nan])
        np.testing.assert_allclose(read.sigma_map_m, [math.nan, 0.3, 0.2, math.nan])  # 0.09 less 0.08, 0.16 less 0.08
        np.testing.assert_equal(read.on_map, [True, True, True, False])
        np.testing.assert_equal(read.has_begun, [False, True, True, True])
        np.testing.assert_equal(read.tracking, [False, True, False, False])
        np.testing.assert_allclose(read.step_m, [0, 10, 10, 10], atol=0.01)

    @staticmethod
    def northwards():
        return Road([0, 12], [[0, 5], [0, 17]], LocalFrame(0, 0, 0))


CLIENT = """#!/bin/sh
while [ $# -gt 0 ]; do
  case "$1" in --drive) drive=$2 ;; --out) out=$2 ;; esac
  shift
done
mkdir -p "$out"
cp "$drive/trajectory.csv" "$drive/gps.csv" "$out"
[ -z "$FAIL" ] || { echo "milepost-client: no map; make one" >&2; exit 1; }
"""


class Starts(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        (self.folder / "client").write_text(CLIENT)
        (self.folder / "client").chmod(0o755)
        write_drive(self.folder / "query", frames=45)
        (self.folder / "out").mkdir()

    def run_starts(self, **environment):
        return subprocess.run([STARTS, self.folder / "client", "a.map", self.folder / "query", self.folder / "out", "milepost"],
                              capture_output=True, text=True, check=False, env={**os.environ, **environment})

    def test_pieces_of_twenty_frames_are_told_one_position(self):
        self.assertEqual(self.run_starts().returncode, 0)
        out = self.folder / "out"
        self.assertEqual(sorted(each.name for each in out.iterdir()), ["0000", "0012", "0024"])
        frames = (out / "0012/trajectory.csv").read_text().splitlines()[1:]
        self.assertEqual((len(frames), frames[0].split(",")[0]), (20, "12.jpg"))
        (told,) = (out / "0012/gps.csv").read_text().splitlines()[1:]
        self.assertEqual(told, f"1.2000,{12 / 111_200:.8f},0,5")

    def test_what_fails_says_why(self):
        failed = self.run_starts(FAIL="1")
        self.assertEqual((failed.returncode, failed.stderr), (1, "milepost-client: no map; make one\n"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
