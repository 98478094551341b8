"""Slow errors as they are drawn, and what is counted of the maps that have them."""
import json
import math
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

from laboratory import draws
from made_up import write_drive

LAB = pathlib.Path(__file__).parent

MAPPER = """#!/bin/sh
drives=0
while [ $# -gt 0 ]; do
  case "$1" in --map) map=$2 ;; --drive) drives=$((drives + 1)); cat "$2/trajectory.csv" >> "$map.seen" ;; esac
  shift
done
echo "$drives" > "$map"
[ "$drives" = 1 ] || echo "$map: 4 tracklets, 30 % seen by two drives or more"
"""
# Off by 0.1 m along with a map of one drive, by 0.05 m with one of two; the last frame is not told.
CLIENT = """#!/bin/sh
while [ $# -gt 0 ]; do
  case "$1" in --map) map=$2 ;; --drive) drive=$2 ;; --out) out=$2 ;; esac
  shift
done
mkdir -p "$out"
error=$(awk '{print 0.1 / $1}' "$map")
echo '[{"method": "milepost", "map_kb_per_m": 0.25}]' > "$out/summary.json"
awk -F, -v error="$error" 'NR == 1 {print "error_m,lateral_error_m,sigma_m,lateral_sigma_m"} NR > 1 {
  if (NR < 41) print error ",-0.02,0.04,0.1"; else print ",,,"}' "$drive/trajectory.csv" > "$out/fixes-milepost.csv"
"""


def rows(east_m, north_m, heading_deg=0.0):
    return [{"east_m": str(east), "north_m": str(north), "up_m": "0", "heading_deg": str(heading_deg)}
            for east, north in zip(east_m, north_m)]


class Drawing(unittest.TestCase):
    def errors(self, noise, draws_count=800):
        places = np.stack([np.zeros(101), np.arange(101) * 4.0, np.zeros(101)], axis=1)
        return np.array([draws.drawn_errors(places, noise, np.random.default_rng(seed)) for seed in range(draws_count)])

    def test_bias_and_drift_add_up_everywhere(self):
        errors = self.errors(draws.Noise(0.1, 0.15))
        np.testing.assert_allclose(errors.std(axis=0), math.hypot(0.1, 0.15), rtol=0.12)

    def test_a_drift_is_alike_over_its_length_and_a_bias_for_ever(self):
        drift = self.errors(draws.Noise(0, 0.15))[:, :, 0] / 0.15
        self.assertGreater(np.mean(drift[:, 0] * drift[:, 12]), 0.9)    # 48 m
        self.assertLess(np.mean(drift[:, 0] * drift[:, 100]), 0)        # 400 m
        self.assertLess(np.abs(np.diff(drift, axis=1)).max(), 0.12)     # 4 m
        bias = self.errors(draws.Noise(0.1, 0), 5)
        np.testing.assert_allclose(bias[:, 0], bias[:, -1])

    def test_the_part_of_a_drive_that_goes_the_same_way(self):
        query = rows(np.zeros(20), np.arange(20) * 5.0)
        there_and_back = rows([3] * 40, [*np.arange(20) * 10.0 - 50, *(140 - np.arange(20) * 10.0)])
        for row in there_and_back[20:]:
            row["heading_deg"] = "180"
        part = draws.part_near(there_and_back, query, near_m=8, margin_m=20)
        self.assertEqual([float(row["north_m"]) for row in part], [*np.arange(-20, 121, 10.0)])
        self.assertEqual(draws.part_near(there_and_back[20:], query, near_m=8, margin_m=20), [])
        self.assertEqual(draws.part_near(rows([50] * 20, np.arange(20) * 5.0), query, 8, 20), [])

    def test_the_best_is_the_mean_error_in_the_querys_directions(self):
        query = rows([0, 5], [0, 0], heading_deg=90)
        drives = [(rows([0, 5], [2, 2]), np.array([[0.2, 0.1, 0], [0.4, 0.1, 0]])),
                  (rows([0, 5], [-2, -2]), np.array([[0, 0.3, 0], [0, 0.3, 0]]))]
        along_m, across_m = draws.mean_errors_at(query, drives)
        np.testing.assert_allclose(along_m, [0.1, 0.2])
        np.testing.assert_allclose(across_m, [-0.2, -0.2])  # south is right


class Command(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        for name, text in (("mapper", MAPPER), ("client", CLIENT)):
            (self.folder / name).write_text(text)
            (self.folder / name).chmod(0o755)
        for name in ("a", "b", "query"):
            write_drive(self.folder / name, frames=40)

    def run_draws(self, *arguments):
        return subprocess.run([LAB / "draws", self.folder / "mapper", self.folder / "client", "--map-drive", self.folder / "a",
                               self.folder / "b", "--query", self.folder / "query", *map(str, arguments)],
                              capture_output=True, text=True, check=False)

    def test_a_row_for_each_number_of_drives(self):
        result = self.run_draws("--numbers", 1, 2, "--draws", 3)
        self.assertEqual(result.returncode, 0, result.stderr)
        header, one, two = result.stdout.splitlines()[3:]
        self.assertIn("to one", header)
        one, two = one.split(), two.split()
        rms_m = math.sqrt((0.1 ** 2 + 0.02 ** 2) / 2)
        self.assertEqual(one[:5], ["1", "0.1000", "0.0200", f"{rms_m:.4f}", "1.00"])
        self.assertEqual(two[:4], ["2", "0.0500", "0.0200", f"{math.sqrt((0.05 ** 2 + 0.02 ** 2) / 2):.4f}"])
        self.assertEqual(one[6:9], ["117/120", "0.0/100.0", "0.00%"])  # 0.1 m are 2.5 sigma
        self.assertEqual(two[7:9], ["100.0/100.0", "0.00%"])
        self.assertEqual(one[9], "6.25/0.04")
        self.assertEqual((one[-2:], two[-2:]), (["0.25", "0%"], ["0.25", "30%"]))

    def test_maps_have_the_drawn_errors_and_the_query_has_none(self):
        options = draws.argparse.Namespace(
            mapper=self.folder / "mapper", client=self.folder / "client", map_drive=[self.folder / "a", self.folder / "b"],
            query=self.folder / "query", part=(0, 0.5), every=2, near_m=8, numbers=[2], bias_m=0.5, drift_m=0)
        (self.folder / "out").mkdir()
        measured = draws.measure(options, 1, self.folder / "out")
        self.assertEqual(measured[2].frames, 10)
        exact = (self.folder / "query/trajectory.csv").read_text().splitlines()
        self.assertEqual([float(line.split(",")[3]) for line in (self.folder / "out/query/trajectory.csv").read_text().splitlines()[1:]],
                         [float(line.split(",")[3]) for line in exact[1:21:2]])
        mapped = draws.places_of(draws.read_trajectory(self.folder / "out/a"))
        off_m = mapped[:, 0]
        self.assertGreater(abs(off_m[0]), 0.01)
        np.testing.assert_allclose(off_m, off_m[0], atol=1e-6)
        self.assertEqual(json.loads((self.folder / "out/a/drive.json").read_text())["name"], "a")

    def test_a_wrong_call_and_a_failing_program_are_told(self):
        self.assertEqual(self.run_draws("--numbers", 3).returncode, 2)
        (self.folder / "mapper").write_text("#!/bin/sh\necho 'mapper: no disk; add one' >&2\nexit 1\n")
        result = self.run_draws("--numbers", 1, "--draws", 1)
        self.assertEqual((result.returncode, result.stderr), (1, "mapper: no disk; add one\n"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
