"""What studies ask the programs to do, and what they make of the answers."""
import json
import pathlib
import tempfile
import types
import unittest
from unittest import mock

from laboratory import studies
from laboratory.pairs import Pair, Place
from laboratory.runs import Alteration, Planner
from laboratory.stages import Cache
from made_up import fixes, write_drive

METHODS = ["tracklet-regression-kalman", "milepost"]
PAIR = Pair("p", Place(folder=pathlib.Path("/drives")), "a-map", "a-query")


def arguments_of(stage):
    return [str(word) for word in stage.arguments(pathlib.Path("/out"), 1)]


class Plans(unittest.TestCase):
    def plan(self, name):
        return studies.plan(studies.STUDIES[name], Planner(METHODS), [PAIR], METHODS)

    def test_size_builds_a_map_of_each_target_for_the_default_method(self):
        planned = self.plan("size")
        self.assertEqual(list(planned), [0.15, 0.25, 0.35, 0.5, 0.8, 1.5])
        for value, (run,) in planned.items():
            arguments = arguments_of(run.map_stage)
            self.assertEqual(arguments[arguments.index("--size-target-kb-per-m") + 1], str(value))
            run.map_stage.result = pathlib.Path("/map")
            self.assertEqual(arguments_of(run.evaluation)[-2:], ["--method", "milepost"])

    def test_calibration_error_localizes_an_altered_drive_on_one_map(self):
        planned = {calibration.name: run for calibration, (run,) in self.plan("calibration-error").items()}
        self.assertEqual(list(planned), ["as recorded", "focal -5 %", "focal +5 %", "yaw 2°"])
        self.assertEqual(len({run.map_stage for run in planned.values()}), 1)
        self.assertNotIn("--size-target-kb-per-m", arguments_of(planned["yaw 2°"].map_stage))
        for run in planned.values():
            for need in run.evaluation.needs:
                need.result = pathlib.Path("/results") / need.kind
        drives = {name: arguments_of(run.evaluation)[arguments_of(run.evaluation).index("--drive") + 1]
                  for name, run in planned.items()}
        self.assertEqual(drives["as recorded"], "/drives/a-query")
        self.assertEqual(drives["yaw 2°"], "/results/alter/drive")
        altered = {name: arguments_of(run.evaluation.needs[1])[-2:] for name, run in planned.items()
                   if name != "as recorded"}
        self.assertEqual(altered, {
            "focal -5 %": ["--focal-factor", "0.95"], "focal +5 %": ["--focal-factor", "1.05"], "yaw 2°": ["--yaw-deg", "2"]})

    def test_an_altered_drive_is_a_stage_that_needs_no_program_of_milepost(self):
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            write_drive(folder / "query")
            stage = Planner(METHODS).alter(Place(folder=folder), "query", Alteration("x", ("--focal-factor", "1.05")))
            with Cache(folder / "cache", 1).opened() as cache:
                cache.run([stage])
            camera = json.loads((stage.result / "drive/drive.json").read_text())["camera"]
            self.assertEqual(camera["focal_px"], [420, 210])


class Outcomes(unittest.TestCase):
    def outcome(self, name, of_value):
        """`of_value`: {value of the study: PairFixes}."""
        runs = {value: [types.SimpleNamespace(pair=PAIR, map_file="m", found=found)]
                for value, found in of_value.items()}
        with mock.patch.object(studies, "read_run", lambda run: run.found):
            return studies.outcome(studies.STUDIES[name], runs)

    def test_size_draws_along_and_lateral_against_the_size_that_came_out(self):
        outcome = self.outcome("size", {
            0.5: [fixes("p", "milepost", [0.1, -0.3], kb_per_m=0.48, lateral_error_m=[0.75, -0.25])],
            0.15: [fixes("p", "milepost", [0.4, 0.4], kb_per_m=0.16, lateral_error_m=0.2)]})
        self.assertEqual(outcome.points, {"milepost": [(0.16, 0.4, 0.2), (0.48, 0.2, 0.5)]})
        self.assertEqual([plot["y"]["label"] for plot in outcome.figure], ["mean error (m)", "mean lateral error (m)"])
        self.assertRegex(outcome.table.as_text(),
                         r"\n0\.5 +milepost +0\.200 +0\.100 +0\.30 +0\.500 +0\.725 +– +0\.48 ")

    def test_calibrations_stand_side_by_side(self):
        recorded, _, wide, _ = studies.CALIBRATIONS
        outcome = self.outcome("calibration-error", {
            recorded: [fixes("p", "inverse-scale", [0.1]), fixes("p", "milepost", [0.1], lateral_error_m=0.1)],
            wide: [fixes("p", "inverse-scale", [0.5]), fixes("p", "milepost", [0.2], lateral_error_m=0.3,
                                                             heading_error_deg=-1.5)]})
        self.assertEqual([point[:2] for point in outcome.points["inverse-scale"]], [(0, 0.1), (2, 0.5)])
        self.assertEqual(outcome.points["milepost"], [(0, 0.1, 0.1), (2, 0.2, 0.3)])
        self.assertIn("focal +5 %", outcome.figure[0]["x"]["names"])
        rows = [dict(zip((heading for heading, *_ in outcome.table.columns), row)) for row in outcome.table.rows]
        self.assertEqual(rows[3]["calibration"], "focal +5 %")
        self.assertEqual(rows[3]["heading mean"], 1.5)
        self.assertIn("| focal +5 % | inverse-scale | 0.500 | 0.000 | 0.50 | – | – | – |", outcome.table.as_markdown())


if __name__ == "__main__":
    unittest.main(verbosity=2)
