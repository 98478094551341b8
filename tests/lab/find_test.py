"""Finding in several runs: what is counted of made-up fixes, and the command on the simulated street."""
import json
import math
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

from laboratory import find, found
from laboratory.found_figures import error_over_time
from laboratory.road import LocalFrame, earth_centred, geodetic
from made_up import data_of

MAPPER, CLIENT, SIMULATOR = (os.environ.get(f"MILEPOST_{name}", "") for name in ("MAPPER", "CLIENT", "SIMULATOR"))
STREET = pathlib.Path(os.environ.get("MILEPOST_STREET", ""))
COMMAND = pathlib.Path(__file__).parent / "find"
ORIGIN = (49.0, 8.4, 110.0)
FIXES_HEAD = "timestamp_s,filename,status,latitude_deg,longitude_deg,heading_deg,sigma_m,latency_ms,mass,explained\n"


def run_of(statuses, errors_m, sigma_m=1.0):
    """A FoundRun of frames half a second apart, 'i', 't', 'p' or 'l' of each status."""
    count = len(statuses)
    return found.FoundRun(
        time_s=np.arange(count) / 2, tracked=np.array([status in "tp" for status in statuses]),
        error_m=np.asarray(errors_m, float), turn_deg=np.full(count, 2.0), sigma_m=np.full(count, sigma_m),
        latency_ms=np.arange(count, dtype=float))


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class Reading(Folder):
    """A drive 1500 m north along a line of longitude; what is found lies 3 m east and 4 m north of it."""

    def write(self, frame):
        description = {"frame": frame}
        rows = ["filename,timestamp_s,east_m,north_m,up_m,heading_deg"]
        if frame == "local":
            description["origin"] = dict(zip(("latitude_deg", "longitude_deg", "altitude_m"), ORIGIN))
        else:
            rows = ["filename,timestamp_s,latitude_deg,longitude_deg,altitude_m,heading_deg"]
        local = LocalFrame(*ORIGIN)
        fixes = FIXES_HEAD
        for index, status in enumerate(("initializing", "lost", "tracking", "predicted")):
            at_m = np.array([0.0, 500.0 * index, 0.0])
            place = at_m if frame == "local" else geodetic(local.to_earth(at_m))
            rows.append(f"{index}.png,{100 + index},{','.join(map(repr, map(float, place)))},359")
            latitude, longitude, _ = geodetic(local.to_earth(at_m + [3, 4, 0]))
            fixes += f"{100 + index},{index}.png,{status},{latitude:.9f},{longitude:.9f},2.5,1.5,{10 * index},0.9,0.5\n"
        (self.folder / "drive.json").write_text(json.dumps(description))
        (self.folder / "trajectory.csv").write_text("\n".join(rows) + "\n")
        (self.folder / "fixes.csv").write_text(fixes)

    def test_errors_are_distances_from_the_recorded_positions(self):
        for frame in ("local", "geographic"):
            self.write(frame)
            run = found.read_found(self.folder / "fixes.csv", found.read_recording(self.folder))
            np.testing.assert_allclose(run.error_m, 5, atol=0.01, err_msg=frame)
            np.testing.assert_allclose(run.turn_deg, 3.5)
            np.testing.assert_array_equal(run.tracked, [False, False, True, True])
            np.testing.assert_array_equal(run.time_s, [0, 1, 2, 3])
            np.testing.assert_array_equal(run.sigma_m, 1.5)
            np.testing.assert_array_equal(run.latency_ms, [0, 10, 20, 30])

    def test_known_starts_are_off_as_asked_for(self):
        self.write("local")
        recording = found.read_recording(self.folder)
        offs_m = []
        for seed in range(1, 21):
            _, place, _, sigma_m = find.start_arguments(recording, 5.0, seed)
            self.assertEqual(sigma_m, "5.0")
            latitude_deg, longitude_deg = map(float, place.split(","))
            offs_m.append(recording.frame.from_earth(earth_centred(latitude_deg, longitude_deg, ORIGIN[2]))[:2])
        np.testing.assert_allclose(np.sqrt(np.square(offs_m).mean(axis=0)), 5, rtol=0.1)


class Counting(unittest.TestCase):
    runs = [run_of("iittpl", [90, 80, 1, 2, 3, 50]), run_of("ititit", [60, 40, 30, 1, 30, 1]),
            run_of("iiiiii", [9, 9, 9, 9, 9, 9])]

    def test_only_tracked_frames_count_for_errors(self):
        figures = found.figures_of(self.runs[:1])
        self.assertEqual((figures.found_after_s, figures.tracked, figures.frames, figures.wrong), (1, 3, 6, 0))
        self.assertEqual((figures.mean_m, figures.p50_m, figures.mean_turn_deg), (2, 2, 2))
        self.assertAlmostEqual(figures.p95_m, 2.9)
        self.assertAlmostEqual(figures.within_95, 2 / 3)
        self.assertEqual(figures.latency_p50_ms, 2.5)

    def test_95_percent_of_errors_in_the_plane_are_within_2_448_sigmas(self):
        self.assertEqual(found.figures_of([run_of("tt", [2.44, 2.46])]).within_95, 0.5)

    def test_runs_together_count_each_frame_alike(self):
        figures = found.figures_of(self.runs)
        self.assertEqual((figures.tracked, figures.frames, figures.wrong), (6, 18, 1))
        self.assertEqual(figures.found_after_s, 0.75)
        self.assertAlmostEqual(figures.mean_m, (6 + 42) / 6)

    def test_what_is_never_found_has_no_errors(self):
        figures = found.figures_of(self.runs[2:])
        for value in (figures.found_after_s, figures.mean_m, figures.p95_m, figures.within_95):
            self.assertTrue(math.isnan(value))
        self.assertIn("found in none of 1 runs", find.result_of(self.runs[2:]))
        self.assertIn(" - ", find.line("3", figures))

    def test_the_result_tells_wrong_places(self):
        self.assertEqual(find.result_of(self.runs), "found in 2 of 3 runs, after 0.5 to 1.0 s; 1 of 6 frames while found in a "
                                                    "wrong place, more than 10 m off")

    def test_a_course_is_of_all_runs(self):
        course = found.course_of(self.runs)
        np.testing.assert_allclose(course.median_m, [60, 40, 9, 2, 9, 9])
        np.testing.assert_allclose(course.high_m[0], 84)
        np.testing.assert_allclose(course.low_m[0], 19.2)
        np.testing.assert_allclose(course.right, np.array([0, 0, 1, 2, 1, 1]) / 3)
        np.testing.assert_allclose(course.wrong, np.array([0, 1, 0, 0, 0, 0]) / 3)

    def test_the_plots_hold_every_run_and_are_the_same_each_time(self):
        error, share = error_over_time(self.runs)
        self.assertEqual([error, share], error_over_time(self.runs))
        self.assertIn("error of 3 runs", error["title"])
        self.assertEqual(error["layers"][-1]["text"], ["the paper's mean, 3.40 m"])
        runs = [layer for layer in error["layers"] if layer.get("name") == "a run"]
        self.assertEqual([layer["y"][0] for layer in runs], [90, 60, 9])
        tracked, = (layer for layer in share["layers"] if layer.get("name") == "tracked")
        self.assertEqual(tracked["y"], [0, 33.333, 33.333, 66.667, 33.333, 33.333])
        error_over_time(self.runs[2:])


class Command(Folder):
    def command(self, *arguments):
        return subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True, check=False)

    def test_the_street_from_a_known_start(self):
        walls, street_map, page = (self.folder / name for name in ("walls.geojson", "street.map", "page.html"))
        # The town that the street's drives were made in.
        subprocess.run([SIMULATOR, "--seed", "3", "--walls", walls], check=True, capture_output=True)
        subprocess.run([MAPPER, "aerial", "--footprints", walls, "--map", street_map], check=True, capture_output=True)
        result = self.command(CLIENT, street_map, STREET / "street-query", "--seeds", 2, "--start-off-m", 1, "--report", page,
                              "--particles", 300)
        self.assertEqual(result.returncode, 0, result.stderr)
        head, *rows, last = result.stdout.splitlines()
        self.assertEqual(head, find.HEADER)
        self.assertEqual([row.split()[0] for row in rows], ["1", "2", "all"])
        self.assertRegex(last, "^found in [0-2]")
        facts = dict(data_of(page.read_text(encoding="utf-8"))["facts"])
        self.assertEqual(facts, {"Map": "street.map", "Start": "known, off by 1 m in each direction",
                                 "Options of find": "--particles 300"})

    def test_what_find_refuses_is_told_in_a_line(self):
        result = self.command(CLIENT, self.folder / "none.map", STREET / "street-query", "--seeds", 1)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, "^milepost-client find: .*none.map.*\n$")

    def test_further_words_go_to_find(self):
        result = self.command(CLIENT, "a.map", STREET / "street-query", "--seeds", 1, "--particles", 0)
        self.assertEqual(result.returncode, 1)
        self.assertIn("--particles", result.stderr)

    def test_no_runs_are_a_wrong_call(self):
        self.assertEqual(self.command(CLIENT, "a.map", STREET / "street-query", "--seeds", 0).returncode, 2)


if __name__ == "__main__":
    unittest.main(verbosity=2)
