"""The laboratory as a researcher calls it, on the simulated street."""
import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from made_up import data_of

STREET = pathlib.Path(os.environ["MILEPOST_STREET"])  # holds street-map and street-query
METHODS = ["tracklet-regression-kalman", "milepost"]


class Command(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        cls.pairs = cls.folder / "street.txt"
        cls.pairs.write_text(f"drives {STREET}\nstreet street-map street-query\n")

    def lab(self, *arguments):
        return subprocess.run([sys.executable, "-B", "-m", "laboratory", *map(str, arguments)], capture_output=True,
                              text=True, stdin=subprocess.DEVNULL, check=False)

    def measure(self, name, *arguments):
        called = self.lab(self.pairs, "--method", *METHODS, "--out", self.folder / name,
                          "--cache", self.folder / f"cache-{name}", *arguments)
        self.assertEqual(called.returncode, 0, called.stderr)
        return called, self.folder / name

    def expect_refused(self, code, arguments, *parts):
        called = self.lab(*arguments)
        self.assertEqual(called.returncode, code, called.stderr)
        self.assertEqual(called.stderr.count("\n"), 1, called.stderr)
        for part in parts:
            self.assertIn(part, called.stderr)

    def test_the_whole_line(self):
        results = self.folder / "RESULTS.md"
        called, out = self.measure("first", "--results", results)
        self.assertRegex(called.stdout, r"map +1 run")
        with (out / "table1.csv").open(newline="") as table:
            rows = {row["method"]: row for row in csv.DictReader(table)}
        self.assertEqual(list(rows), METHODS)
        for row in rows.values():
            self.assertEqual(row["localized"], row["frames"])
            self.assertTrue(0 < float(row["mean_m"]) < 0.5, row)
            self.assertGreater(float(row["map_kB_per_m"]), 0)
        self.assertEqual(rows["tracklet-regression-kalman"]["paper_mean_m"], "0.33")
        for name in ("report.html", "table2.txt", "calibration.csv", "claims.txt", "study-lateral.csv",
                     "table1-pairs.txt", "normality.csv", "regressions.csv", "precision.csv", "precision.txt",
                     "latency-precision.csv"):
            self.assertGreater((out / name).stat().st_size, 100, name)
        parts = data_of((out / "report.html").read_text())["parts"]
        headings = [part["heading"] for part in parts]
        self.assertIn("Precision: along, lateral and heading", headings)
        self.assertIn("### Precision: along, lateral and heading", results.read_text())
        self.assertIn(" p50 ms ", called.stdout)
        for number in (5, 6, 7, 8):
            figure = next(part for part in parts if part["heading"].startswith(f"Figure {number}: "))
            self.assertTrue(all(plot["layers"] for plot in figure["plots"]), number)
        self.assertIn(f"| milepost | **{rows['milepost']['mean_m']}** |", results.read_text())

        again = self.lab(self.pairs, "--method", *METHODS, "--out", self.folder / "again",
                         "--cache", self.folder / "cache-first")
        self.assertRegex(again.stdout, r"map +0 run")
        self.assertRegex(again.stdout, r"evaluate +0 run")

        _, second = self.measure("second", "--jobs", "1")  # all anew, in another order
        files = sorted(file.name for file in out.iterdir())
        self.assertEqual(files, sorted(file.name for file in second.iterdir()))
        for name in files:
            if not name.startswith("latency"):
                self.assertEqual((out / name).read_bytes(), (second / name).read_bytes(), name)

    def test_wrong_calls_are_one_line_and_exit_code_2(self):
        self.expect_refused(2, [], "PAIRS", "--help")
        self.expect_refused(2, [self.pairs, "--method", "magic"], "'magic'", "milepost")
        self.expect_refused(2, [self.pairs, "--studies", "weather"], "'weather'", "lateral")
        self.expect_refused(2, [self.pairs, "--situations", "wrong"], "--situations", "--studies honesty")
        self.expect_refused(2, [self.pairs, "--jobs", "0"], "--jobs")
        self.expect_refused(2, [self.pairs, "--colour"], "--colour")
        self.expect_refused(2, [self.folder / "none.txt"], "none.txt", "no such list")

    def test_missing_drives_are_one_line_and_exit_code_1(self):
        gone = self.folder / "gone.txt"
        gone.write_text("drives ../shared/drives-not-here\na a-map a-query\n")
        self.expect_refused(1, [gone], "gone.txt, line 1", "drives-not-here", "no such folder")

    def test_help_teaches(self):
        called = self.lab("--help")
        self.assertEqual(called.returncode, 0)
        for word in ("PAIRS", "--studies", "examples:", "report.html", "Exit code"):
            self.assertIn(word, called.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
