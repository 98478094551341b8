#!/usr/bin/env python3
"""Two drives of a small city make one map, on which a tour passes every junction without a receiver."""
import csv
import json
import pathlib
import shutil
import statistics
import tempfile
import unittest

from commands import CLIENT, MAPPER, SIMULATOR, CommandTest, Server, rows_of, run



class City(CommandTest):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.city = pathlib.Path(temporary.name)
        made = run(SIMULATOR, "--out", cls.city, "--city", "--small", "--camera-px", "360", "300", timeout=1200)
        assert made.returncode == 0, made.stderr
        cls.maps = cls.city / "maps"
        cls.maps.mkdir()
        cls.drives = [cls.city / "city-1-map", cls.city / "city-2-map"]
        cls.map = cls.maps / "city.map"
        built = cls.build_of(cls.drives, cls.map)
        assert built.returncode == 0, built.stderr

    @staticmethod
    def build_of(drives, map_file, *words):
        return run(MAPPER, "build", *(word for drive in drives for word in ("--drive", drive)), "--map", map_file, *words)

    def roads(self, map_file):
        exported = self.folder / "roads.geojson"
        self.expect_done(run(MAPPER, "export", "--map", map_file, "--layer", "segments", "--geojson", exported))
        return [feature["properties"] for feature in json.loads(exported.read_text())["features"]]

    def test_the_drives_make_one_network(self):
        roads = {road["id"]: road for road in self.roads(self.map)}
        self.assertEqual({drive["drive"] for road in roads.values() for drive in road["passes"]}, {"city-1-map", "city-2-map"})
        self.assertTrue(any(len(road["passes"]) > 1 for road in roads.values()))
        self.assertTrue(any(len(road["successors"]) > 1 for road in roads.values()))
        for road in roads.values():
            for successor in road["successors"]:
                self.assertEqual(successor["map"], "city")
                self.assertIn(successor["segment"], roads)
        driven_m = sum(drive["to_m"] - drive["from_m"] for road in roads.values() for drive in road["passes"])
        self.assertLess(sum(road["length_m"] for road in roads.values()), driven_m - 50)

    def test_neither_order_nor_threads_play_a_part(self):
        other = self.folder / "city.map"
        self.expect_done(self.build_of(self.drives[::-1], other, "--jobs", "1"))
        self.assertEqual(other.read_bytes(), self.map.read_bytes())

    def test_a_tour_passes_every_junction_without_a_receiver(self):
        figures = self.evaluated(self.maps, "out")
        self.assertEqual(figures["localized_frames"], figures["frames"])
        self.assertEqual(figures["wrong_segment_frames"], 0)
        self.assertLess(figures["mean_error_m"], 0.011)  # 0.008 is usual with this small camera
        self.assertLess(figures["mean_lateral_error_m"], 0.011)
        self.assertLess(figures["max_distance_m"], 0.15)
        self.assertLess(figures["map_kb_per_m"], 0.485)
        rows = rows_of(self.folder / "out" / "fixes-milepost.csv")
        driven = {row["segment"] for row in rows}
        self.assertEqual(driven, {road["id"] for road in self.roads(self.map)})
        self.assertGreater(sum(row["status"] == "tracking" for row in rows), 0.97 * len(rows))

    def test_from_map_to_map_is_as_through_a_junction(self):
        tour = rows_of(self.city / "city-1-tour" / "gps.csv")
        longitude_deg = statistics.median(float(row["longitude_deg"]) for row in tour)
        latitude_deg = float(tour[0]["latitude_deg"])
        divided = self.folder / "divided"
        divided.mkdir()
        border = f"{latitude_deg - 0.1},{longitude_deg},{latitude_deg + 0.1},{longitude_deg}"
        self.expect_done(self.build_of(self.drives, divided / "west.map", "--border", border, "--beyond", divided / "east.map"))
        for here, there in (("west", "east"), ("east", "west")):
            roads = self.roads(divided / f"{here}.map")
            self.assertIn(there, {successor["map"] for road in roads for successor in road["successors"]})
        whole, parts = self.evaluated(self.maps, "whole"), self.evaluated(divided, "parts")
        driven = {row["segment"] for row in rows_of(self.folder / "parts" / "fixes-milepost.csv")}
        for name in ("west", "east"):
            self.assertGreater(len(driven & {road["id"] for road in self.roads(divided / f"{name}.map")}), 1, name)
        self.assertEqual(parts["localized_frames"], parts["frames"])
        self.assertEqual(parts["wrong_segment_frames"], 0)
        for figure in ("mean_error_m", "mean_lateral_error_m", "mean_distance_m"):
            self.assertLess(parts[figure], whole[figure] + 0.002, figure)

    def moved(self, drive, east_m, north_m):
        """A copy of a drive whose positions are all off by this."""
        copy = self.folder / "moved" / drive.name
        copy.mkdir(parents=True)
        shutil.copy(drive / "drive.json", copy)
        (copy / "frames").symlink_to(drive / "frames")
        rows = rows_of(drive / "trajectory.csv")
        for row in rows:
            row["east_m"] = float(row["east_m"]) + east_m
            row["north_m"] = float(row["north_m"]) + north_m
        with open(copy / "trajectory.csv", "w", newline="") as table:
            writer = csv.DictWriter(table, rows[0].keys(), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        return copy

    def test_drives_that_contradict_each_other_are_fused(self):
        moved = [self.moved(self.drives[0], 0.3, 0.3), self.moved(self.drives[1], -0.3, -0.3)]
        errors_m = {}
        for passes in ("fuse", "keep-best"):
            maps = self.folder / passes
            maps.mkdir()
            built = self.build_of(moved, maps / "city.map", "--passes", passes)
            self.expect_done(built)
            self.assertEqual("seen by two drives or more" in built.stdout, passes == "fuse")
            figures = self.evaluated(maps, passes + "-out")
            self.assertEqual(figures["localized_frames"], figures["frames"])
            errors_m[passes] = figures["mean_error_m"]
        self.assertGreater(errors_m["keep-best"], 0.2)
        self.assertLess(errors_m["fuse"], 0.1)

    def evaluated(self, maps, name):
        """The figures of the tour against a server of these maps, with one position at the start."""
        out = self.folder / name
        with Server(maps) as server:
            self.expect_done(run(CLIENT, "evaluate", "--server", server.url, "--cache", self.folder / f"{name}-cache", "--drive",
                                 self.city / "city-1-tour", "--out", out, "--receiver-until-s", "0"))
        figures, = json.loads((out / "summary.json").read_text())
        return figures

    def test_without_the_network_beyond_its_drive_it_is_off_the_map(self):
        one = self.folder / "one.map"
        self.expect_done(self.build_of(self.drives[:1], one))
        out = self.folder / "out"
        self.expect_done(run(CLIENT, "evaluate", "--map", one, "--drive", self.city / "city-1-tour", "--out", out,
                             "--receiver-until-s", "0"))
        rows = rows_of(out / "fixes-milepost.csv")
        self.assertIn("off-map", {row["status"] for row in rows})
        for row in rows:
            if row["distance_m"]:
                sigma_m = float(row["sigma_m"]) + float(row["lateral_sigma_m"] or 0)
                self.assertLess(float(row["distance_m"]), max(1, 5 * sigma_m), row)


if __name__ == "__main__":
    unittest.main(verbosity=2)
