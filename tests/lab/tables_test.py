"""Tables of made-up fixes files, from the files to the cells."""
import csv
import io
import json
import math
import pathlib
import sqlite3
import tempfile
import types
import unittest

import numpy as np

from laboratory import claims, results, studies, tables
from laboratory.fixes import read_run
from laboratory.road import tracklets_per_m
from laboratory.regressions import regression_table, samples_of
from made_up import fixes, regression_rows

HEADER = ("timestamp_s,filename,status,segment,along_m,sigma_m,latitude_deg,longitude_deg,matches,latency_ms,"
          "truth_along_m,error_m,lateral_m,heading_deg,lateral_sigma_m,truth_lateral_m,lateral_error_m,"
          "heading_error_deg,sigma_map_m\n")
DEGREES_PER_M = 1 / 111319.49  # of longitude on the equator


def write_map(path):
    """A map of one segment of 40 m that runs east along the equator, with 80 tracklets."""
    with sqlite3.connect(path) as store:
        store.executescript(
            "CREATE TABLE segments (id, length_m); CREATE TABLE tiles (layer, items);"
            "CREATE TABLE vertices (segment, position, latitude_deg, longitude_deg, altitude_m, along_m);")
        store.execute("INSERT INTO segments VALUES ('road', 40)")
        store.executemany("INSERT INTO tiles VALUES (?, ?)", [("tracklets", 50), ("tracklets", 30), ("other", 9)])
        store.executemany("INSERT INTO vertices VALUES ('road', ?, 0, ?, 0, ?)",
                          [(i, 4 * i * DEGREES_PER_M, 4 * i) for i in range(11)])


class FromFiles(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        write_map(self.folder / "drive.map")
        (self.folder / "drive.json").write_text(json.dumps({
            "frame": "local", "origin": {"latitude_deg": 0, "longitude_deg": 0, "altitude_m": 0}}))
        (self.folder / "trajectory.csv").write_text(
            "filename,timestamp_s,east_m,north_m,up_m,heading_deg\n"
            "a.jpg,0,4,1.5,0,90\nb.jpg,1,8,-2,0,90\nc.jpg,2,12,0,0,90\n")
        (self.folder / "fixes-m.csv").write_text(
            HEADER + "0,a.jpg,tracking,road,4.5,0.2,0,0,9,1,4.0,0.5,-1.4,90.5,0.1,-1.5,0.1,0.5,0.19\n"
            "1,b.jpg,tracking,road,7.7,0.2,0,0,9,2,8.0,-0.3,,,,2,,,0.2\n2,c.jpg,lost,,,,,,0,3,12.0,,,,,0,,,\n")
        (self.folder / "summary.json").write_text(json.dumps([{"method": "m", "map_kb_per_m": 2.5}]))
        stage = types.SimpleNamespace(result=self.folder)
        self.run_ = types.SimpleNamespace(pair=types.SimpleNamespace(name="p"), map_stage=stage, evaluation=stage,
                                          map_file=self.folder / "drive.map", query_drive=self.folder)

    def test_errors_offsets_and_sizes(self):
        (read,) = read_run(self.run_)
        np.testing.assert_allclose(read.error_m, [0.5, -0.3, math.nan])
        np.testing.assert_allclose(read.lateral_m, [1.5, -2, math.nan], atol=1e-3)
        np.testing.assert_allclose(read.lateral_error_m, [0.1, math.nan, math.nan])
        np.testing.assert_allclose(read.sigma_m, [0.19, 0.2, math.nan])
        np.testing.assert_allclose(read.lateral_sigma_m, [math.sqrt(0.01 - 0.0039), math.nan, math.nan])
        np.testing.assert_allclose(read.heading_error_deg, [0.5, math.nan, math.nan])
        np.testing.assert_allclose(read.latency_ms, [1, 2, 3])
        self.assertEqual(list(read.curved), [False] * 3)
        self.assertEqual((read.map_kb_per_m, read.map_length_m), (2.5, 40))
        self.assertEqual(tables.figure_cells([read]), [0.4, np.std([0.5, 0.3]), 0.5, 0.4, 2.5, 2, 3])

    def test_tracklets_a_metre(self):
        self.assertEqual(tracklets_per_m(self.folder / "drive.map"), 2.0)


class Tables(unittest.TestCase):
    def setUp(self):
        self.fixes = [fixes("a", "wisurf", [4.0, 2.0]), fixes("a", "milepost", [0.1, -0.3]),
                      fixes("b", "wisurf", [1.0, 1.0]), fixes("b", "milepost", [math.nan, 0.5])]

    def test_table_1_pools_frames_and_stands_beside_the_paper(self):
        table = tables.table_1(self.fixes)
        self.assertEqual(table.rows[0][:2], ["wisurf", 2.0])
        self.assertEqual(table.rows[0][-4:], [3.71, 1.68, 4.61, 1.42])
        self.assertAlmostEqual(table.rows[1][1], 0.3)
        self.assertEqual(table.rows[1][6:8], [3, 4])
        self.assertEqual(table.rows[1][-4:], [None] * 4)

    def test_the_same_cells_in_every_form(self):
        table = tables.table_1(self.fixes)
        rows = list(csv.DictReader(io.StringIO(table.as_csv())))
        self.assertEqual(rows[1]["mean_m"], "0.300")
        self.assertEqual(rows[1]["paper_mean_m"], "")
        self.assertRegex(table.as_text(), r"milepost +0\.300 ")
        self.assertIn("| milepost | **0.300** |", table.as_markdown())
        data = table.as_data()
        self.assertEqual(data["columns"][1], {"heading": "mean", "unit": "m", "decimals": 3})
        self.assertEqual(data["rows"][1]["cells"][:2], ["milepost", 0.3])
        self.assertIn(1, data["rows"][1]["best"])
        self.assertIsNone(data["rows"][1]["cells"][-1])

    def test_by_pair_the_best_is_that_of_the_pair(self):
        table = tables.table_1_by_pair(self.fixes)
        self.assertEqual([row[:2] for row in table.rows],
                         [["a", "wisurf"], ["a", "milepost"], ["b", "wisurf"], ["b", "milepost"]])
        marked = [[table.is_best(row, 2) for row in table.rows]]
        self.assertEqual(marked, [[False, True, False, True]])

    def test_table_2_parts_curved_from_straight(self):
        curved = [True, False, True]
        table = tables.table_2([fixes("a", "tracklet-regression-kalman", [1.0, 5.0, 3.0], curved=curved)])
        self.assertEqual([row[:3] for row in table.rows], [["curved", "tracklet-regression-kalman", 2.0],
                                                           ["straight", "tracklet-regression-kalman", 5.0]])
        self.assertEqual(table.rows[0][-3:], [0.35, 0.31, 1.82])

    def precision_rows(self, table):
        return [dict(zip((heading for heading, *_ in table.columns), row)) for row in table.rows]

    def test_precision_pools_all_pairs_and_tells_each(self):
        table = tables.precision_table([
            fixes("a", "inverse-scale", [0.5, -0.1], sigma_m=0.1, kb_per_m=3.0),
            fixes("a", "milepost", [0.02, -0.04], sigma_m=0.015, kb_per_m=0.5, lateral_error_m=[-0.01, 0.03],
                  lateral_sigma_m=0.02, heading_error_deg=[0.2, -0.4]),
            fixes("b", "milepost", [0.06, math.nan], sigma_m=0.1, kb_per_m=0.7, lateral_error_m=[0.11, math.nan],
                  lateral_sigma_m=0.02, heading_error_deg=[0.6, math.nan])])
        rows = self.precision_rows(table)
        self.assertEqual([(row["pair"], row["method"]) for row in rows],
                         [("all pairs", "inverse-scale"), ("all pairs", "milepost"), ("a", "inverse-scale"),
                          ("a", "milepost"), ("b", "milepost")])
        ours = rows[1]
        for heading, value in {"along mean": 0.04, "along p95": 0.058, "along max": 0.06, "lateral mean": 0.05,
                               "lateral p95": 0.102, "lateral max": 0.11, "heading mean": 0.4, "map": 0.6,
                               "along in 2σ": 200 / 3, "lateral in 2σ": 200 / 3}.items():
            self.assertAlmostEqual(ours[heading], value, msg=heading)
        self.assertAlmostEqual(rows[3]["lateral mean"], 0.02)
        self.assertRegex(table.as_text(),
                         r"\na +inverse-scale +0\.300 +0\.480 +0\.50 +– +– +– +– +3\.00 +50\.0 +–\n")
        self.assertIn("| all pairs | milepost | **0.040** |", table.as_markdown())

    def test_the_time_of_a_frame_stands_in_a_table_of_its_own(self):
        of = [fixes("a", "milepost", [0.1, 0.2, 0.3], latency_ms=[60, 70, 500]),
              fixes("b", "milepost", [0.1], latency_ms=90)]
        table = tables.precision_latency_table(of)
        self.assertTrue(table.name.startswith("latency"))
        self.assertEqual([row["p50"] for row in self.precision_rows(table)], [80, 70, 90])
        self.assertIn(",map_kB_per_m,p50_ms,along_in_2σ_%,", table.as_csv())
        self.assertNotIn("ms", [unit for _, unit, _ in tables.precision_table(of).columns])

    def test_lateral_offsets_by_bins(self):
        outcome = studies.lateral_outcome([fixes("a", "milepost", [1.0, 3.0] * 10, lateral_m=[0.1, -0.7] * 10)])
        self.assertEqual([row[0] for row in outcome.table.rows], ["0 to 0.25", "0.5 to 1"])
        self.assertEqual([row[3] for row in outcome.table.rows], [1.0, 3.0])
        self.assertEqual(len(outcome.points["milepost"]), 2)


class Regressions(unittest.TestCase):
    def test_a_feature_of_fixed_size_is_linear_in_inverse_scale(self):
        first, second = samples_of(regression_rows())
        self.assertEqual((first.name, second.name, len(first.along_m)), ("A", "B", 6))
        inverse = second.fits["inverse scale"]  # s = 200 / (55 - along)
        self.assertAlmostEqual(inverse.intercept, 55)
        self.assertAlmostEqual(inverse.slope, 200)
        self.assertAlmostEqual(inverse.r_squared, 1)
        self.assertLess(first.fits["scale"].r_squared, 0.98)
        self.assertEqual(regression_table([first]).rows[0][:3], ["A", 6, 15.0])


class Claims(unittest.TestCase):
    def verdicts(self, fixes):
        return {claim.text: claim.verdict for claim in claims.claims_of(fixes)}

    def test_held_not_held_and_not_tested(self):
        noise = np.abs(np.random.default_rng(1).normal(1, 0.1, 400))
        verdicts = self.verdicts([
            fixes("a", "tracklet-matching", 2 * noise), fixes("a", "tracklet-regression", noise),
            fixes("a", "tracklet-regression-kalman", noise[::-1]),
            fixes("a", "tracklet-regression-unaveraged", noise, kb_per_m=8.0)])
        self.assertEqual(verdicts["Order of Table 1: regression is better than tracklet matching"], "held")
        self.assertEqual(verdicts["The Kalman filter lowers the mean error"], "not held")
        self.assertEqual(verdicts["Averaging the descriptors of a tracklet costs no accuracy"], "held")
        self.assertEqual(verdicts["Averaging descriptors halves the map"], "held")
        self.assertEqual(verdicts["The particle filter adds nothing significant"], "not tested")

    def test_a_difference_within_chance_holds_nothing_and_refutes_nothing(self):
        noise = 1 + np.random.default_rng(2).exponential(1.0, 60)
        verdicts = self.verdicts([fixes("a", "tracklet-regression", noise),
                                  fixes("a", "tracklet-regression-kalman", noise[::-1] - 0.02),
                                  fixes("a", "tracklet-regression-particle", np.roll(noise, 30) - 0.04)])
        self.assertEqual(verdicts["The Kalman filter lowers the mean error"], "not held")
        self.assertEqual(verdicts["The particle filter adds nothing significant"], "held")

    def test_the_whole_order_of_table_1(self):
        order = ("wisurf", "scale-only", "tracklet-matching", "tracklet-regression", "tracklet-regression-kalman")
        text = "The methods stand in the order of Table 1 by their mean errors"
        for errors_m, verdict in (((5, 4, 3, 2, 1), "held"), ((4, 5, 3, 2, 1), "not held")):
            self.assertEqual(self.verdicts([fixes("a", method, np.full(30, float(error_m)))
                                            for method, error_m in zip(order, errors_m)])[text], verdict)

    def test_a_steady_gain_that_is_tiny_is_none(self):
        verdicts = self.verdicts([fixes("a", "tracklet-regression-kalman", np.full(60, 0.5)),
                                  fixes("a", "tracklet-regression-particle", np.full(60, 0.499))])
        self.assertEqual(verdicts["The particle filter adds nothing significant"], "held")

    def test_a_better_particle_filter_refutes(self):
        verdicts = self.verdicts([fixes("a", "tracklet-regression-kalman", np.full(60, 0.5)),
                                  fixes("a", "tracklet-regression-particle", np.full(60, 0.4))])
        self.assertEqual(verdicts["The particle filter adds nothing significant"], "not held")
        self.assertEqual(verdicts["The particle filter adds nothing significant on curved road"], "not tested")

    def test_averaging_that_costs_accuracy_or_size_refutes(self):
        verdicts = self.verdicts([fixes("a", "tracklet-regression", np.full(60, 0.6), kb_per_m=7.0),
                                  fixes("a", "tracklet-regression-unaveraged", np.full(60, 0.5), kb_per_m=8.0)])
        self.assertEqual(verdicts["Averaging the descriptors of a tracklet costs no accuracy"], "not held")
        self.assertEqual(verdicts["Averaging descriptors halves the map"], "not held")


class Results(unittest.TestCase):
    def test_a_section_is_added_once_and_then_replaced(self):
        once = results.replaced("# Results\n", "town", "## town\n1\n")
        both = results.replaced(once, "street", "## street\n2\n")
        again = results.replaced(both, "town", "## town\n3\n")
        self.assertEqual(again, both.replace("\n1\n", "\n3\n"))
        self.assertTrue(again.startswith("# Results\n\n<!-- tests/lab/run: town -->\n## town\n3\n"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
