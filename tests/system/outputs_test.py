"""Outputs never replace an input, nor a file of another kind; errors are reported before any work."""
import json
import os
import pathlib
import stat
import struct
import subprocess
import tempfile
import zlib

import commands
from commands import CLIENT, CommandTest, MAPPER, STREET, edit_json, run

NOTES = "my notes, the only copy\n"
FIXES = "timestamp_s,filename,status,segment,along_m,sigma_m,latitude_deg,longitude_deg,matches,latency_ms\n"


def black_png(width, height):
    """A PNG of black 8-bit grey."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    rows = zlib.compress((b"\0" + b"\0" * width) * height)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", rows) + chunk(b"IEND", b"")


class Outputs(CommandTest):
    map: pathlib.Path

    @classmethod
    def setUpClass(cls):
        cls.made = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.made.cleanup)
        cls.map = pathlib.Path(cls.made.name) / "street.map"
        result = run(MAPPER, "build", "--drive", STREET / "street-map", "--map", cls.map)
        assert result.returncode == 0, result.stderr

    def notes(self, name):
        file = self.folder / name
        file.write_text(NOTES)
        return file

    def own_map(self):
        file = self.folder / "own.map"
        file.write_bytes(self.map.read_bytes())
        return file

    def expect_kept(self, file, content, result, *parts):
        self.expect_refused(result, 1, str(file), *parts)
        self.assertEqual(file.read_bytes(), content)
        self.assertEqual([entry.name for entry in file.parent.iterdir() if ".partial" in entry.name], [])

    def localize(self, out, drive=STREET / "street-query", **settings):
        return run(CLIENT, "localize", "--map", self.map, "--drive", drive, "--out", out, **settings)

    def export(self, out, map_file=None):
        return run(MAPPER, "export", "--map", map_file or self.map, "--layer", "segments", "--geojson", out)

    # build

    def test_a_map_does_not_replace_its_drive(self):
        drive = self.copy_of(STREET / "street-map")
        (self.folder / "link").symlink_to(drive / "trajectory.csv")
        os.link(drive / "drive.json", self.folder / "hard")
        for name in ("trajectory.csv", "drive.json", "../link", "../hard", "../drive/trajectory.csv"):
            file = drive / name
            self.expect_kept(file, file.read_bytes(), self.build(drive, file),
                             "the command reads this file", "--map")
        frame = next((drive / "frames").iterdir())
        self.expect_kept(frame, frame.read_bytes(), self.build(drive, frame), "the command reads this file")

    def test_a_map_replaces_maps_and_empty_files_only(self):
        drive = STREET / "street-map"
        notes = self.notes("notes.txt")
        self.expect_kept(notes, NOTES.encode(), self.build(drive, notes), "is not a milepost map", "--map")
        database = self.folder / "other.sqlite"
        database.write_bytes(b"SQLite format 3\0" + bytes(4080))
        self.expect_kept(database, database.read_bytes(), self.build(drive, database), "is not a milepost map")
        self.expect_refused(self.build(drive, self.folder), 1, "this is a folder")
        empty = self.folder / "empty.map"
        empty.touch()
        self.expect_done(self.build(drive, empty))
        self.assertEqual(empty.read_bytes(), self.map.read_bytes())
        older = self.own_map()
        content = bytearray(older.read_bytes())
        content[60:64] = struct.pack(">I", 1)  # user_version
        older.write_bytes(content)
        self.expect_done(self.build(drive, older))
        self.assertEqual(older.read_bytes(), self.map.read_bytes())

    def test_a_link_to_a_map_stays_a_link(self):
        target = self.own_map()
        link = self.folder / "current.map"
        link.symlink_to("own.map")
        self.expect_done(self.build(STREET / "street-map", link, "--size-target-kb-per-m", "0.3"))
        self.assertTrue(link.is_symlink())
        self.assertFalse(target.is_symlink())
        self.assertNotEqual(target.read_bytes(), self.map.read_bytes())
        self.assertEqual(sorted(entry.name for entry in self.folder.iterdir()), ["current.map", "own.map"])

    def test_a_map_is_no_pipe(self):
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        self.expect_refused(self.build(STREET / "street-map", pipe), 1, "pipe", "regular file", "--map")
        self.assertTrue(stat.S_ISFIFO(pipe.stat().st_mode))

    # An empty result

    def blacken(self, drive):
        size = json.loads((drive / "drive.json").read_text())["camera"]
        for frame in (drive / "frames").iterdir():
            frame.write_bytes(black_png(size["width_px"], size["height_px"]))

    def test_nothing_found_leaves_the_old_map(self):
        drive = self.copy_of(STREET / "street-map")
        self.blacken(drive)
        file = self.own_map()
        before = file.read_bytes()
        self.expect_refused(self.build(drive, file), 1, str(drive), "features 0", "grey values 0 to 0", "tracklets 0",
                            "--allow-empty")
        self.assertEqual(file.read_bytes(), before)
        result = self.build(drive, file, "--allow-empty")
        self.expect_done(result)
        self.assertIn("tracklets 0", result.stderr)
        self.assertIn("0 tracklets", result.stdout)

    def test_one_drive_without_anything_is_named(self):
        dark = self.copy_of(STREET / "street-query", "dark")
        self.blacken(dark)
        edit_json(dark / "drive.json", lambda drive: drive["origin"].__setitem__("longitude_deg", 8.5))  # another road
        words = ("build", "--drive", STREET / "street-map", "--drive", dark, "--map", self.folder / "two.map")
        self.expect_refused(run(MAPPER, *words), 1, str(dark), "tracklets 0")
        self.assertFalse((self.folder / "two.map").exists())
        result = run(MAPPER, *words, "--allow-empty")
        self.expect_done(result)
        for line in result.stderr.splitlines():  # of its images and its receiver, too
            self.assertIn(str(dark), line)
        self.assertIn("tracklets 0", result.stderr)

    # export

    def test_an_export_replaces_geojson_only(self):
        notes = self.notes("notes.txt")
        self.expect_kept(notes, NOTES.encode(), self.export(notes), "is not a GeoJSON FeatureCollection", "--geojson")
        own = self.own_map()
        self.expect_kept(own, own.read_bytes(), self.export(own, own), "the command reads this file")
        other = self.folder / "by-another-program.geojson"
        other.write_text('{\n  "type": "FeatureCollection",\n  "features": []\n}\n')
        self.expect_done(self.export(other))
        self.assertEqual(len(json.loads(other.read_text())["features"]), 1)

    def test_an_export_goes_down_a_pipe(self):
        result = self.export("/dev/stdout")
        self.expect_done(result)
        self.assertEqual(len(json.loads(result.stdout)["features"]), 1)
        self.assertIn("1 segments", result.stderr)

    # client

    def test_fixes_replace_fixes_only(self):
        drive = self.copy_of(STREET / "street-query")
        for name in ("trajectory.csv", "gps.csv", "drive.json"):
            file = drive / name
            self.expect_kept(file, file.read_bytes(), self.localize(file, drive), "the command reads this file")
        (drive / "odometry.csv").unlink(missing_ok=True)
        self.expect_refused(self.localize(drive / "odometry.csv", drive), 1, "the command reads this file")
        notes = self.notes("notes.csv")
        self.expect_kept(notes, NOTES.encode(), self.localize(notes), "is not a table of fixes", "--out")
        own = self.own_map()
        before = own.read_bytes()
        self.expect_refused(run(CLIENT, "localize", "--map", own, "--drive", drive, "--out", own), 1,
                            "the command reads this file")
        self.assertEqual(own.read_bytes(), before)
        self.expect_refused(self.localize(self.folder / "nowhere" / "fixes.csv"), 1, "there is no folder")
        fixes = self.folder / "fixes.csv"
        fixes.write_text(FIXES)
        self.expect_done(self.localize(fixes))
        self.assertGreater(len(fixes.read_text().splitlines()), 10)

    def test_fixes_go_down_a_pipe(self):
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        with subprocess.Popen(["cat", str(pipe)], stdout=subprocess.PIPE, text=True) as reader:
            result = self.localize(pipe)
            self.expect_done(result)
            self.assertTrue(stat.S_ISFIFO(pipe.stat().st_mode))
            text, _ = reader.communicate(timeout=60)
        self.assertTrue(text.startswith("timestamp_s,filename,status"))
        self.assertIn("frames localized", result.stdout)

    def test_fixes_go_to_standard_output_alone(self):
        result = self.localize("/dev/stdout")
        self.expect_done(result)
        self.assertTrue(result.stdout.startswith("timestamp_s,filename,status"))
        self.assertNotIn("localized", result.stdout)
        self.assertIn("frames localized", result.stderr)

    def test_fixes_that_nobody_wants(self):
        self.expect_done(self.localize("/dev/null"))
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/null").st_mode))

    def test_an_evaluation_replaces_its_own_files_only(self):
        def evaluate(out):
            return run(CLIENT, "evaluate", "--map", self.map, "--drive", STREET / "street-query", "--out", out)
        for name, kind in (("summary.json", "a summary of an evaluation"), ("report.html", "a report of milepost"),
                           ("fixes-milepost.csv", "a table of fixes")):
            folder = self.folder / name.replace(".", "-")
            folder.mkdir()
            (folder / name).write_text(NOTES)
            self.expect_kept(folder / name, NOTES.encode(), evaluate(folder), "is not " + kind, "--out")
            self.assertEqual(len(list(folder.iterdir())), 1)
        notes = self.notes("notes")
        self.expect_kept(notes, NOTES.encode(), evaluate(notes), "--out")
        out = self.folder / "results"
        self.expect_done(evaluate(out))
        self.expect_done(evaluate(out))

    def test_a_search_replaces_its_own_files_only(self):
        def find(*words):
            return run(CLIENT, "find", "--map", self.map, "--drive", STREET / "street-query", *words)
        notes = self.notes("notes.txt")
        fixes = self.folder / "found.csv"
        self.expect_kept(notes, NOTES.encode(), find("--out", notes), "is not a table of fixes", "--out")
        self.expect_kept(notes, NOTES.encode(), find("--out", fixes, "--report", notes), "is not a report of milepost",
                         "--report")
        self.expect_kept(notes, NOTES.encode(), find("--out", fixes, "--localize-out", notes),
                         "is not a table of fixes", "--localize-out")
        self.expect_refused(find("--out", fixes, "--localize-out", fixes), 1,
                            "--out and --localize-out name the same file")

    def test_directions_replace_directions_only(self):
        drive = self.copy_of(STREET / "street-query")
        frame = next((drive / "frames").iterdir())

        def vanishing(out):
            return run(CLIENT, "vanishing", "--camera", drive / "drive.json", "--out", out, frame)
        for file in (frame, drive / "drive.json"):
            self.expect_kept(file, file.read_bytes(), vanishing(file), "the command reads this file")
        notes = self.notes("notes.json")
        self.expect_kept(notes, NOTES.encode(), vanishing(notes), "is not a list of vanishing directions")
        out = self.folder / "found.json"
        self.expect_done(vanishing(out))
        self.expect_done(vanishing(out))


commands.main() if __name__ == "__main__" else None
