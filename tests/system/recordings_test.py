"""Repeated recordings of real roads: tracklet-regression is no worse in the mean than an independent implementation of
the paper's measurement (the figures of ../shared/drives/README.md), milepost is near what README.md states for each pair.

Skipped, with a message, without the recordings, which cannot be part of the project.
"""
import json
import unittest

import commands
from commands import CLIENT, CommandTest, SHARED, Server, rows_of, run

# pair: mean error of the paper's model and mean; mean errors of milepost, longitudinal and lateral
MEASURED_M = {
    "kitti-00-query": (0.22, 0.018, 0.009), "kitti-00-query-right": (0.24, 0.024, 0.016),
    "kitti-05-query": (0.23, 0.007, 0.011), "kitti-06-query": (0.45, 0.004, 0.007),
    "kitti-06-query-right": (0.87, 0.012, 0.009), "kitti-raw-0013-query": (0.57, 0.033, 0.015),
    "malaga-07a-query": (0.25, 0.116, 0.132), "torcs-street-1-query1": (0.37, 0.008, 0.007),
    "torcs-street-1-query2": (0.55, 0.025, 0.018),
}
TOLERANCE = 1.15
TOLERANCE_M = 0.002
METHODS = ("tracklet-regression", "milepost")


@unittest.skipUnless((SHARED / "drives").is_dir(), f"there are no recorded drives in {SHARED / 'drives'}")
class Recordings(CommandTest):
    def test_mean_errors_over_all_pairs(self):
        drives = SHARED / "drives"
        maps = self.folder / "maps"
        maps.mkdir()
        for name in sorted({pair.split("-query")[0] for pair in MEASURED_M}):
            self.expect_done(self.build(drives / f"{name}-map", maps / f"{name}.map", "--lab"))
        means = {method: [] for method in METHODS}
        frames, localized = ({method: 0 for method in METHODS} for _ in range(2))
        with Server(maps) as server:
            for pair in MEASURED_M:
                out = self.folder / pair
                self.expect_done(run(CLIENT, "evaluate", "--server", server.url, "--cache", self.folder / "cache",
                                     "--drive", drives / pair, "--out", out, "--method", *METHODS, timeout=1200))
                for entry in json.loads((out / "summary.json").read_text()):
                    means[entry["method"]].append(entry["mean_error_m"])
                    rows = rows_of(out / f"fixes-{entry['method']}.csv")
                    self.assertEqual(len(rows), len(rows_of(drives / pair / "trajectory.csv")))
                    frames[entry["method"]] += entry["frames"]
                    localized[entry["method"]] += entry["localized_frames"]
                    if entry["method"] == "milepost":
                        self.check_pair(pair, entry)
        reference_m = sum(figures[0] for figures in MEASURED_M.values()) / len(MEASURED_M)
        mean_m = sum(means["tracklet-regression"]) / len(MEASURED_M)
        print(f"tracklet-regression: {mean_m:.3f} m over the pairs, reference {reference_m:.3f} m")
        self.assertLessEqual(mean_m, reference_m)
        for method in METHODS:
            self.assertGreaterEqual(localized[method], 0.99 * frames[method], method)

    def check_pair(self, pair, entry):
        for key, measured_m in zip(("mean_error_m", "mean_lateral_error_m"), MEASURED_M[pair][1:]):
            print(f"{pair}: {key} {entry[key]:.4f}, measured before {measured_m:.3f}")
            self.assertLessEqual(entry[key], TOLERANCE * measured_m + TOLERANCE_M, (pair, key))


commands.main() if __name__ == "__main__" else None
