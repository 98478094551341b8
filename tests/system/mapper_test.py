"""milepost-mapper build: the same bytes for any number of threads, and never half a map."""
import json
import os
import shutil
import signal
import subprocess
import time
import unittest

import commands
from commands import CLIENT, CommandTest, MAPPER, STREET, rows_of, run


class Mapper(CommandTest):
    def setUp(self):
        super().setUp()
        self.map = self.folder / "street.map"

    def test_same_bytes_for_any_number_of_threads_and_each_run(self):
        maps = []
        for name, jobs in (("one", 1), ("two", 2), ("again", 2), ("five", 5)):
            maps.append(self.folder / f"{name}.map")
            self.expect_done(self.build(STREET / "street-map", maps[-1], "--jobs", jobs, "--lab"))
        for other in maps[1:]:
            self.assertEqual(maps[0].read_bytes(), other.read_bytes(), other.name)

    def test_a_setting_changes_the_build(self):
        first = self.build(STREET / "street-map", self.map)
        second = self.build(STREET / "street-map", self.map, "--size-target-kb-per-m", "0.3")
        self.expect_done(first)
        self.expect_done(second)
        self.assertNotEqual(first.stdout.split("build ")[1][:32], second.stdout.split("build ")[1][:32])

    def test_settings_from_a_file(self):
        config = self.folder / "mapper.conf"
        config.write_text("# a comment\nsize-target-kb-per-m = 0.3\n")
        by_file = self.build(STREET / "street-map", self.folder / "a.map", "--config", config)
        by_word = self.build(STREET / "street-map", self.folder / "b.map", "--size-target-kb-per-m",
                             "0.3")
        self.expect_done(by_file)
        self.expect_done(by_word)
        self.assertEqual((self.folder / "a.map").read_bytes(), (self.folder / "b.map").read_bytes())
        config.write_text("size-target-kb-a-m = 0.3\n")
        self.expect_refused(self.build(STREET / "street-map", self.map, "--config", config), 2, "size-target-kb-a-m")

    def test_export_of_the_road_network(self):
        self.expect_done(self.build(STREET / "street-map", self.map))
        roads = self.folder / "roads.geojson"
        self.expect_done(run(MAPPER, "export", "--map", self.map, "--layer", "segments", "--geojson", roads))
        collection = json.loads(roads.read_text())
        self.assertEqual(collection["type"], "FeatureCollection")
        feature, = collection["features"]
        self.assertEqual(feature["properties"]["id"], "street-map-0")
        self.assertEqual(feature["properties"]["successors"], [])
        driven, = feature["properties"]["passes"]
        self.assertEqual(driven, {"drive": "street-map", "from_m": 0, "to_m": feature["properties"]["length_m"]})
        self.assertAlmostEqual(feature["properties"]["length_m"], 60, delta=3)
        self.assertEqual(feature["geometry"]["type"], "LineString")
        self.assertGreater(len(feature["geometry"]["coordinates"]), 20)
        self.expect_refused(run(MAPPER, "export", "--map", self.map, "--layer", "walls", "--geojson", roads), 1,
                            "no layer 'walls'", "segments, tracklets")
        self.assertEqual(json.loads(roads.read_text()), collection)

    def copied(self, name, **stated):
        """The street's drive under another name, with further keys in drive.json."""
        drive = self.folder / name
        shutil.copytree(STREET / "street-map", drive)
        description = json.loads((drive / "drive.json").read_text())
        (drive / "drive.json").write_text(json.dumps({**description, "name": name, **stated}))
        return drive

    def test_a_recording_that_is_given_twice_is_told_and_counts_once(self):
        once, twice = self.folder / "once.map", self.folder / "twice.map"
        self.expect_done(self.build(STREET / "street-map", once))
        result = self.build(STREET / "street-map", twice, "--drive", self.copied("again"))
        self.expect_done(result)
        self.assertIn("warning: drive 'street-map': its frames are those of drive 'again'", result.stderr)
        roads = self.folder / "roads.geojson"
        positions = []
        for file in (once, twice):
            self.expect_done(run(MAPPER, "export", "--map", file, "--layer", "segments", "--geojson", roads))
            feature, = json.loads(roads.read_text())["features"]
            self.assertEqual(len(feature["properties"]["passes"]), 1)
            positions.append((feature["properties"]["position_sigma_m"], feature["properties"]["assumed"]))
        self.assertEqual(positions, [(0.18, True)] * 2)

    def test_what_a_drive_states_of_its_positions_is_in_each_fix(self):
        fixes = self.folder / "fixes.csv"
        for stated_m, in_plan_m in (({}, 0.18), ({"position_sigma_m": 0.05, "position_correlation_m": 80}, 0.05)):
            name = f"stating-{len(stated_m)}"
            result = self.build(self.copied(name, **stated_m), self.map)
            self.expect_done(result)
            self.assertIn(f"positions to {in_plan_m:.3f} m" + ("" if stated_m else " (assumed)"), result.stdout)
            self.expect_done(run(CLIENT, "localize", "--map", self.map, "--drive", STREET / "street-query", "--out", fixes))
            for row in rows_of(fixes):
                sigma_m, sigma_map_m = float(row["sigma_m"]), float(row["sigma_map_m"])
                self.assertAlmostEqual(sigma_m ** 2 - sigma_map_m ** 2, in_plan_m ** 2, delta=2e-4 * sigma_m + 1e-6)

    def test_a_statement_that_is_none_is_refused(self):
        self.expect_refused(self.build(self.copied("bad", position_sigma_m=-1), self.map), 1, "drive.json", "position_sigma_m is -1")

    def start_build(self):
        return subprocess.Popen([MAPPER, "build", "--drive", str(STREET / "street-map"), "--map", str(self.map),
                                 "--jobs", "1"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def wait_for_partial_file(self, process):
        while process.poll() is None:
            if any(entry.name.startswith(".street.map.partial") for entry in self.folder.iterdir()):
                return
            time.sleep(0.01)
        self.fail("the build ended before it could be disturbed")

    def test_killed_it_leaves_the_old_map(self):
        self.expect_done(self.build(STREET / "street-map", self.map, "--size-target-kb-per-m", "0.3"))
        before = self.map.read_bytes()
        process = self.start_build()
        self.wait_for_partial_file(process)
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=30)
        self.assertEqual(self.map.read_bytes(), before)

    def test_stopped_it_leaves_nothing_behind(self):
        process = self.start_build()
        self.wait_for_partial_file(process)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1, errors)
        self.assertIn("stopped on request", errors)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_wrong_calls(self):
        self.expect_refused(run(MAPPER), 2, "a command is missing")
        self.expect_refused(run(MAPPER, "bild"), 2, "'bild' is not a command")
        self.expect_refused(run(MAPPER, "build", "--map", self.map), 2, "--drive")
        self.expect_refused(self.build(STREET / "street-map", self.map, "--jobs", "none"), 2, "--jobs")
        self.expect_refused(self.build(STREET / "street-map", self.map, "--job", "2"), 2, "--job")
        self.expect_refused(self.build(STREET / "street-map", self.map, "--min-r-squared", "2"), 2, "--min-r-squared")
        for words in (("--version",), ("build", "--version")):
            self.expect_done(run(MAPPER, *words))

    def test_help_teaches(self):
        self.expect_teaches(run(MAPPER, "--help"), "build", "export")
        self.expect_teaches(run(MAPPER, "export", "--help"), "--layer NAME", "--geojson FILE", "walls.geojson")
        self.expect_teaches(run(MAPPER, "build", "--help"), "--drive DIR", "--max-features N", "0 to 1000000, default 1000")

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs /dev/full")
    def test_no_folder_to_write_to(self):
        result = self.build(STREET / "street-map", self.folder / "nowhere" / "street.map")
        self.expect_refused(result, 1, "nowhere")


commands.main() if __name__ == "__main__" else None
