"""milepost-mapper build: the same bytes for any number of threads, and never half a map."""
import json
import os
import signal
import subprocess
import time
import unittest

import commands
from commands import CommandTest, MAPPER, STREET, run


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
