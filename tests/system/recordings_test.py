"""Repeated recordings of real roads: no worse than an independent implementation of the paper's measurement.

The figures are those of ../shared/drives/README.md, as means over the pairs. Skipped, saying so, without
the recordings, which cannot be part of the project.
"""
import json
import unittest

import commands
from commands import CLIENT, CommandTest, SHARED, Server, rows_of, run

# pair: mean error of the paper's model and mean, of inverse scale and median
SANITY_M = {
    "kitti-00-query": (0.22, 0.10), "kitti-00-query-right": (0.24, 0.29), "kitti-05-query": (0.23, 0.08),
    "kitti-06-query": (0.45, 0.08), "kitti-06-query-right": (0.87, 0.38), "kitti-raw-0013-query": (0.57, 0.21),
    "malaga-07a-query": (0.25, 0.15), "torcs-street-1-query1": (0.37, 0.27), "torcs-street-1-query2": (0.55, 0.58),
}
METHODS = ("tracklet-regression", "milepost")


@unittest.skipUnless((SHARED / "drives").is_dir(), f"there are no recorded drives in {SHARED / 'drives'}")
class Recordings(CommandTest):
    def test_mean_errors_over_all_pairs(self):
        drives = SHARED / "drives"
        maps = self.folder / "maps"
        maps.mkdir()
        for name in sorted({pair.split("-query")[0] for pair in SANITY_M}):
            self.expect_done(self.build(drives / f"{name}-map", maps / f"{name}.map", "--lab"))
        means = {method: [] for method in METHODS}
        frames, localized = ({method: 0 for method in METHODS} for _ in range(2))
        with Server(maps) as server:
            for pair in SANITY_M:
                out = self.folder / pair
                self.expect_done(run(CLIENT, "evaluate", "--server", server.url, "--cache", self.folder / "cache",
                                     "--drive", drives / pair, "--out", out, "--method", *METHODS, timeout=1200))
                for entry in json.loads((out / "summary.json").read_text()):
                    means[entry["method"]].append(entry["mean_error_m"])
                    rows = rows_of(out / f"fixes-{entry['method']}.csv")
                    self.assertEqual(len(rows), len(rows_of(drives / pair / "trajectory.csv")))
                    frames[entry["method"]] += entry["frames"]
                    localized[entry["method"]] += entry["localized_frames"]
        for column, method in enumerate(METHODS):
            sanity_m = sum(figures[column] for figures in SANITY_M.values()) / len(SANITY_M)
            mean_m = sum(means[method]) / len(SANITY_M)
            print(f"{method}: {mean_m:.3f} m over the pairs, sanity {sanity_m:.3f} m")
            self.assertLessEqual(mean_m, sanity_m, method)
            self.assertGreaterEqual(localized[method], 0.99 * frames[method], method)


commands.main() if __name__ == "__main__" else None
