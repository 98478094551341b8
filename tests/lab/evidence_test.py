"""What counts as a place of a frame's own and what as elsewhere."""
import pathlib
import tempfile
import types
import unittest
from unittest import mock

import numpy as np

from laboratory import evidence
from laboratory.pairs import Pair, Place
from laboratory.road import LocalFrame, Road
from laboratory.runs import Planner
from made_up import write_drive

PAIR = Pair("p", Place(folder=pathlib.Path("/drives")), "a-map", "a-query")
HEADER = "filename,segment,along_m,latitude_deg,longitude_deg,matches,log_bayes_factor,lateral_m,up_m,turned_deg\n"
DEGREES_PER_M = 1 / 110574  # to the north, at the equator


def relocalization(name, north_m, factor, segment="s"):
    return f"{name}.jpg,{segment},{north_m},{north_m * DEGREES_PER_M:.10f},0,9,{factor},0,0,0\n"


class Evidence(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        write_drive(self.folder / "query", frames=3, step_m=10)
        self.run_ = types.SimpleNamespace(
            map_file="m", query_drive=self.folder / "query", pair=PAIR, evaluation=types.SimpleNamespace(result=self.folder))

    def rows(self, *relocalizations):
        (self.folder / "relocalizations.csv").write_text(HEADER + "".join(relocalizations))
        with mock.patch.object(evidence, "read_roads", lambda file: {"s": Road([0, 9], [[0, 0], [0, 9]], LocalFrame(0, 0, 0))}):
            outcome = evidence.outcome({"plain": [self.run_]})
        headings = [f"{heading} {unit}".strip() for heading, unit, _ in outcome.table.columns]
        return [dict(zip(headings, row)) for row in outcome.table.rows], outcome

    def test_its_own_place_is_near_and_elsewhere_far(self):
        rows, outcome = self.rows(relocalization(1, 10.4, 20), relocalization(1, 11, 7), relocalization(1, 13, 6), relocalization(2, 13, -3))
        own, elsewhere = rows[:2]
        self.assertEqual((own["places"], own["median"]), (1, 20))
        self.assertEqual((elsewhere["places"], elsewhere["greatest"], elsewhere["above 5 %"], elsewhere["below 0 %"]),
                         (2, 6, 50, 50))
        self.assertEqual([row["frames"] for row in rows], ["plain", "plain", "all", "all"])
        names = [layer["name"] for layer in outcome.figure[0]["layers"] if "name" in layer]
        self.assertEqual([name.split(",")[0] for name in names], ["elsewhere", "where the frame was taken"])

    def test_a_place_counts_once_a_frame(self):
        rows, _ = self.rows(relocalization(0, 0, 20), relocalization(0, 0.2, 20), relocalization(0, 0.1, 20, "t"), relocalization(1, 0.1, 1))
        self.assertEqual([row["places"] for row in rows[:2]], [2, 1])

    def test_frames_without_a_place_are_no_places(self):
        rows, _ = self.rows()
        self.assertEqual([row["places"] for row in rows], [0, 0, 0, 0])
        self.assertTrue(np.isnan(rows[0]["median"]))

    def test_every_kind_is_looked_with(self):
        planned = evidence.plan(Planner(["milepost"]), [PAIR])
        self.assertEqual(list(planned), ["plain", "blur", "soft", "noise", "half", "dark"])
        for (run,) in planned.values():
            self.assertEqual(run.evaluation.kind, "relocalizations")
        self.assertEqual(len({run.map_stage for (run,) in planned.values()}), 1)


if __name__ == "__main__":
    unittest.main(verbosity=2)
