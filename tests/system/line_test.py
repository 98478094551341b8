"""The whole line: drive -> map -> server -> client over HTTP -> fixes, on the simulated street."""
import contextlib
import hashlib
import json
import math
import socket
import sqlite3
import struct
import zlib

import commands
from commands import CLIENT, CommandTest, STREET, Server, report_data, rows_of, run

FIX_COLUMNS = ["timestamp_s", "filename", "status", "segment", "along_m", "sigma_m", "latitude_deg",
               "longitude_deg", "matches", "latency_ms"]
POSE_COLUMNS = ["lateral_m", "heading_deg", "lateral_sigma_m"]  # of methods that estimate them
TRUTH_COLUMNS = ["truth_lateral_m", "lateral_error_m", "heading_error_deg", "truth_segment", "distance_m"]
SUMMARY_KEYS = ["method", "mean_error_m", "std_error_m", "max_error_m", "p50_error_m", "p95_error_m", "frames",
                "localized_frames", "within_2_sigma", "map_kb_per_m", "latency_ms_p50", "latency_ms_p99",
                "mean_lateral_error_m", "p95_lateral_error_m", "max_lateral_error_m", "lateral_within_2_sigma",
                "mean_heading_error_deg", "p95_heading_error_deg", "max_heading_error_deg",
                "mean_distance_m", "p95_distance_m", "max_distance_m", "wrong_segment_frames",
                "within_2_sigma_map"]
# Every method, and a bound on its mean error in metres: those that interpolate nothing are worse.
# Bounds of the mean error on the street: about 1.6 times what is measured.
METHODS = {"wisurf": 2.5, "scale-only": 0.85, "tracklet-matching": 0.35, "tracklet-regression": 0.35,
           "tracklet-regression-kalman": 0.3, "tracklet-regression-particle": 0.3,
           "tracklet-regression-unaveraged": 0.36, "inverse-scale": 0.13, "milepost": 0.010}
LATERAL_M = 0.010  # of milepost
STATUSES = {"initializing", "tracking", "predicted", "lost", "off-map"}


def black_png(width, height):
    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
    rows = bytes((1 + width) * height)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def canonical(value):
    """JSON by RFC 8785 (FORMAT.md 7.1), for numbers that need no exponent."""
    if isinstance(value, dict):
        return "{" + ",".join(f"{json.dumps(key)}:{canonical(value[key])}" for key in sorted(value)) + "}"
    if isinstance(value, list):
        return "[" + ",".join(map(canonical, value)) + "]"
    if isinstance(value, float):
        return str(int(value)) if value.is_integer() else repr(value)
    return json.dumps(value)


def digest_of(content):
    return hashlib.blake2b(content, digest_size=16).hexdigest()


def tum_rows(file):
    lines = file.read_text().splitlines()
    assert lines[0] == "# timestamp tx ty tz qx qy qz qw", lines[0]
    return [[float(word) for word in line.split()] for line in lines[1:]]


class MapFile:
    """The documents of a map file, written by FORMAT.md 7 alone."""
    def __init__(self, file):
        with contextlib.closing(sqlite3.connect(file)) as store:
            self.store = store
            self.meta = dict(store.execute("SELECT key, value FROM meta"))
            self.manifest = {"areas": self.listed({"cells": self.cells()}), "format": 3,
                             "map": self.listed(self.summary()), "mapping": self.listed(json.loads(self.meta["mapping"])),
                             "segments": self.segments()}

    def listed(self, document):
        content = canonical(document).encode()
        return {"bytes": len(content), "digest": digest_of(content)}

    def rows(self, names, source, *values):
        names = names.split()
        return [dict(zip(names, row)) for row in self.store.execute(f"SELECT {', '.join(names)} FROM {source}", values)]

    def cells(self):
        assert not self.store.execute("SELECT * FROM cells").fetchall()
        return {}

    def summary(self):
        layers = dict(self.store.execute("SELECT name, parameters FROM layers ORDER BY name"))
        total_m = 0.0
        for segments, (length_m,) in enumerate(self.store.execute("SELECT length_m FROM segments ORDER BY id"), 1):
            total_m += length_m
        return {"layers": sorted(layers), "layer_parameters": {name: json.loads(layers[name]) for name in layers},
                "feature": json.loads(self.meta["feature"]), "segment_count": segments, "length_m": total_m,
                "bounds": {side: self.meta[side] for side in ("west_deg", "south_deg", "east_deg", "north_deg")}}

    def segments(self):
        return [{**self.listed(self.segment(name)), "segment": name}
                for (name,) in self.store.execute("SELECT id FROM segments ORDER BY id").fetchall()]

    def segment(self, name):
        (length_m,), = self.store.execute("SELECT length_m FROM segments WHERE id = ?", (name,))
        line = self.store.execute("SELECT latitude_deg, longitude_deg, altitude_m, along_m FROM vertices"
                                  " WHERE segment = ? ORDER BY position", (name,))
        tiles = {}
        for tile in self.rows("layer number from_m to_m items bytes digest",
                              "tiles WHERE segment = ? ORDER BY layer, number", name):
            tile["index"] = tile.pop("number")
            tiles.setdefault(tile.pop("layer"), []).append(tile)
        sigma_m, correlation_m, assumed = self.store.execute(
            "SELECT position_sigma_m, position_correlation_m, assumed FROM segments WHERE id = ?", (name,)).fetchone()
        error = {"position_sigma_m": sigma_m, "position_correlation_m": correlation_m, **({"assumed": True} if assumed else {})}
        return {**error, "segment": name, "length_m": length_m, "line": [list(vertex) for vertex in line], "tiles": tiles,
                "successors": [], "passes": self.rows("drive from_m to_m", "passes WHERE segment = ?", name)}


class Line(CommandTest):
    def setUp(self):
        super().setUp()
        self.maps = self.folder / "maps"
        self.maps.mkdir()
        self.map = self.maps / "street.map"
        self.query = STREET / "street-query"
        self.fixes = self.folder / "fixes.csv"

    def build_map(self, *words):
        self.expect_done(self.build(STREET / "street-map", self.map, *words))

    def localize(self, *words):
        return run(CLIENT, "localize", "--drive", self.query, "--out", self.fixes, *words)

    def over_http(self, url):
        return ("--server", url, "--cache", self.folder / "cache")

    def expect_fixes(self):
        rows = rows_of(self.fixes)
        self.assertEqual(list(rows[0]), FIX_COLUMNS + POSE_COLUMNS + ["sigma_map_m"])
        self.assertEqual([row["filename"] for row in rows],
                         [row["filename"] for row in rows_of(self.query / "trajectory.csv")])
        self.assertLessEqual({row["status"] for row in rows}, STATUSES)
        self.assertGreaterEqual(sum(row["status"] == "tracking" for row in rows), 0.9 * len(rows))
        return rows

    def test_over_http_as_from_the_file(self):
        self.build_map()
        with Server(self.maps) as server:
            self.expect_done(self.localize(*self.over_http(server.url)))
        by_http = self.expect_fixes()
        # With the cache filled and the server stopped:
        self.expect_done(self.localize(*self.over_http(server.url)))
        by_cache = self.expect_fixes()
        self.expect_done(self.localize("--map", self.map))
        by_file = self.expect_fixes()
        for rows in (by_http, by_cache, by_file):
            for row in rows:
                row.pop("latency_ms")
        self.assertEqual(by_http, by_file)
        self.assertEqual(by_cache, by_file)

    def test_the_build_by_the_format_alone(self):
        """Whoever has FORMAT.md finds the same bytes, and so the same digests."""
        self.build_map("--lab")
        manifest = MapFile(self.map)
        content = canonical(manifest.manifest)
        self.assertEqual(content, manifest.meta["manifest"])
        self.assertEqual(digest_of(content.encode()), manifest.meta["build"])

    def test_evaluate(self):
        self.build_map("--lab")
        out = self.folder / "results"
        with Server(self.maps) as server:
            result = run(CLIENT, "evaluate", "--drive", self.query, "--out", out, "--method", *METHODS,
                         *self.over_http(server.url))
        self.expect_done(result)
        summary = json.loads((out / "summary.json").read_text())
        self.assertEqual([entry["method"] for entry in summary], list(METHODS))
        frames = rows_of(self.query / "trajectory.csv")
        for entry in summary:
            self.assertEqual(list(entry), SUMMARY_KEYS)
            self.assertEqual(entry["frames"], len(frames))
            self.assertGreaterEqual(entry["localized_frames"], 0.9 * len(frames))
            self.assertGreater(entry["map_kb_per_m"], 0.02)
            self.assertLess(entry["mean_error_m"], METHODS[entry["method"]], entry["method"])
            if entry["method"] == "milepost":
                self.assertLess(entry["mean_lateral_error_m"], LATERAL_M)
            self.check_against_rows(entry, rows_of(out / f"fixes-{entry['method']}.csv"))
        error_m = {entry["method"]: entry["mean_error_m"] for entry in summary}
        self.assertLess(error_m["milepost"], error_m["tracklet-regression"])
        self.assertLess(error_m["tracklet-regression"], error_m["scale-only"])
        self.assertAlmostEqual(error_m["tracklet-regression-particle"], error_m["tracklet-regression-kalman"], delta=0.1)
        report = (out / "report.html").read_text()
        knows_lateral = any(entry["mean_lateral_error_m"] is not None for entry in summary)
        tables = [part for part in report_data(report)["parts"] if part["part"] == "table"]
        self.assertEqual(len(tables), 1 + knows_lateral)
        self.assertEqual([row["cells"][0] for row in tables[0]["rows"]], list(METHODS))
        self.assertNotRegex(report, r"(src|href)=\"http")  # self-contained

    def test_poses_for_other_evaluators(self):
        """An independent reader finds the mean error of evaluate in the two trajectories."""
        self.build_map()
        file, truth, out = self.folder / "run.tum", self.folder / "run-truth.tum", self.folder / "out"
        self.expect_done(run(CLIENT, "evaluate", "--map", self.map, "--drive", self.query, "--out", out,
                             "--method", "milepost", "--tum", file))
        recorded = {row[0]: row for row in tum_rows(truth)}
        self.assertEqual(len(recorded), len(rows_of(self.query / "trajectory.csv")))
        off_m, turned = [], []
        for row in tum_rows(file):
            real = recorded[row[0]]
            off_m.append(math.dist(row[1:3], real[1:3]))
            turned.append(math.degrees(2 * math.acos(min(1, abs(sum(a * b for a, b in zip(row[4:], real[4:])))))))
        distances = [float(row["distance_m"]) for row in rows_of(out / "fixes-milepost.csv")]
        self.assertEqual(len(off_m), len(distances))
        self.assertAlmostEqual(sum(off_m) / len(off_m), sum(distances) / len(distances), places=3)
        self.assertLess(max(turned), 1.5)  # pitch and roll are not recorded
        first = rows_of(self.query / "trajectory.csv")[0]
        for axis, metres in zip(("east_m", "north_m", "up_m"), tum_rows(truth)[0][1:4]):
            self.assertAlmostEqual(float(first[axis]), metres, places=3)
        self.expect_done(self.localize("--map", self.map, "--tum", file))
        self.assertEqual(len(tum_rows(file)), len(off_m))

    def test_walls_beside_the_tracklets_change_nothing(self):
        self.build_map()
        self.expect_done(self.localize("--map", self.map))
        alone = self.expect_fixes()
        summaries = [self.summary_of_evaluation()]
        corner = [float(alone[-1][key]) for key in ("longitude_deg", "latitude_deg")]
        house = [[corner[0] + east, corner[1] + north] for east, north in
                 ((0, 0), (1e-4, 0), (1e-4, 1e-4), (0, 1e-4), (0, 0))]
        (self.folder / "house.json").write_text(json.dumps({"type": "Polygon", "coordinates": [house]}))
        self.expect_done(run(commands.MAPPER, "aerial", "--footprints", self.folder / "house.json", "--map", self.map))
        self.expect_done(self.localize("--map", self.map))
        beside = self.expect_fixes()
        with Server(self.maps) as server:
            self.expect_done(self.localize(*self.over_http(server.url)))
        by_http = self.expect_fixes()
        for rows in (alone, beside, by_http):
            for row in rows:
                row.pop("latency_ms")
        self.assertEqual(beside, alone)
        self.assertEqual(by_http, alone)
        summaries.append(self.summary_of_evaluation())
        for summary in summaries:
            for key in ("latency_ms_p50", "latency_ms_p99"):
                summary.pop(key)
        self.assertEqual(*summaries)

    def summary_of_evaluation(self):
        out = self.folder / "results"
        self.expect_done(run(CLIENT, "evaluate", "--map", self.map, "--drive", self.query, "--out", out))
        summary, = json.loads((out / "summary.json").read_text())
        return summary

    def test_estimates(self):
        self.build_map("--lab")
        out = self.folder / "results"
        methods = ["wisurf", "tracklet-matching", "tracklet-regression"]
        self.expect_done(run(CLIENT, "evaluate", "--map", self.map, "--drive", self.query, "--out", out, "--estimates",
                             "--method", *methods))
        self.assertFalse((out / "estimates-wisurf.csv").exists())  # has no tracklets
        for method in methods[1:]:
            fixes = {row["filename"]: row for row in rows_of(out / f"fixes-{method}.csv")}
            estimates = {}
            for row in rows_of(out / f"estimates-{method}.csv"):
                self.assertEqual(list(row), ["timestamp_s", "filename", "along_m", "sigma_m", "truth_along_m", "error_m",
                                             "scale_px", "along_begin_m", "along_end_m", "r_squared"])
                self.assertAlmostEqual(float(row["along_m"]) - float(row["truth_along_m"]), float(row["error_m"]),
                                       delta=2e-4)
                self.assertGreaterEqual(float(row["r_squared"]), 0.8)
                estimates.setdefault(row["filename"], []).append(float(row["along_m"]))
            for filename, along_m in estimates.items():  # Eq. 4
                fix = fixes[filename]
                self.assertEqual(int(fix["matches"]), len(along_m))
                self.assertAlmostEqual(sum(along_m) / len(along_m), float(fix["along_m"]), delta=1e-3)
            self.assertGreaterEqual(len(estimates), 0.9 * len(fixes))
        regressions = {}
        for row in rows_of(out / "regressions.csv"):
            regressions.setdefault(row["tracklet"], []).append(row)
        self.assertGreater(len(regressions), 3)
        for rows in regressions.values():
            self.assertGreaterEqual(len(rows), 3)
            residuals = [float(r["offset_m"]) + float(r["slope"]) * float(r["scale_px"]) - float(r["along_m"]) for r in rows]
            self.assertAlmostEqual(sum(residuals) / len(rows), 0, delta=1e-2)  # least squares

    def test_wheels_carry_on_where_frames_are_black(self):
        self.build_map()
        sigmas_m = []
        for name in ("with-odometry", "without"):
            self.query = self.copy_of(STREET / "street-query", name)
            frames = rows_of(self.query / "trajectory.csv")
            for row in frames[12:18]:
                (self.query / "frames" / row["filename"]).write_bytes(black_png(600, 500))
            if name == "without":
                (self.query / "odometry.csv").unlink()
            self.expect_done(self.localize("--map", self.map))
            rows = rows_of(self.fixes)
            self.assertEqual({row["status"] for row in rows[12:18]}, {"predicted"})
            self.assertEqual(rows[18]["status"], "tracking")
            sigmas_m.append(float(rows[17]["sigma_map_m"]))
        self.assertLess(sigmas_m[0], 0.5 * sigmas_m[1])

    def check_against_rows(self, entry, rows):
        self.assertEqual(list(rows[0]), FIX_COLUMNS + ["truth_along_m", "error_m"] + POSE_COLUMNS + TRUTH_COLUMNS + ["sigma_map_m"])
        errors = []
        for row in rows:
            if not row["error_m"]:
                continue
            self.assertAlmostEqual(float(row["along_m"]) - float(row["truth_along_m"]), float(row["error_m"]), delta=2e-4)
            errors.append(abs(float(row["error_m"])))
        self.assertEqual(len(errors), entry["localized_frames"])
        self.assertAlmostEqual(sum(errors) / len(errors), entry["mean_error_m"], delta=1e-3)
        self.assertAlmostEqual(max(errors), entry["max_error_m"], delta=1e-3)
        self.assertEqual({row["truth_segment"] for row in rows}, {"street-map-0"})
        self.assertEqual(entry["wrong_segment_frames"], 0)
        distances = [float(row["distance_m"]) for row in rows if row["distance_m"]]
        self.assertAlmostEqual(max(distances), entry["max_distance_m"], delta=1e-3)
        lateral = [row for row in rows if row["lateral_m"]]
        self.assertEqual(bool(lateral), entry["mean_lateral_error_m"] is not None)
        for row in lateral:
            self.assertAlmostEqual(float(row["lateral_m"]) - float(row["truth_lateral_m"]), float(row["lateral_error_m"]),
                                   delta=2e-4)

    def test_refuses_methods_that_the_map_does_not_serve(self):
        self.build_map()
        for method, layer in {"wisurf": "wisurf", "scale-only": "frames", "tracklet-matching": "observations",
                              "tracklet-regression": "tracklets-scale",
                              "inverse-scale": "tracklets-inverse-scale"}.items():
            result = run(CLIENT, "evaluate", "--map", self.map, "--drive", self.query, "--out", self.folder / "results",
                         "--method", method)
            self.expect_refused(result, 1, f"'{layer}'", "--lab")
        result = run(CLIENT, "evaluate", "--map", self.map, "--drive", self.query, "--out", self.folder / "results",
                     "--method", "magic")
        self.expect_refused(result, 1, "'magic' is not a method", "milepost")

    def test_no_server(self):
        with socket.socket() as unused:
            unused.bind(("127.0.0.1", 0))
            port = unused.getsockname()[1]
        result = self.localize(*self.over_http(f"http://127.0.0.1:{port}"))
        self.expect_refused(result, 1, f"http://127.0.0.1:{port}/v1/segments")
        self.assertFalse(self.fixes.exists())

    def test_a_file_that_is_no_map(self):
        self.map.write_text("not a map")
        self.expect_refused(self.localize("--map", self.map), 1, "street.map")
        self.map.unlink()
        self.expect_refused(self.localize("--map", self.map), 1, "street.map", "no such file")

    def test_a_place_without_a_map(self):
        self.build_map()
        query = self.copy_of(self.query, "elsewhere")
        def move(drive):
            drive["origin"]["latitude_deg"] = 48.0
        commands.edit_json(query / "drive.json", move)
        lines = (query / "gps.csv").read_text().splitlines()
        moved = [lines[0]] + [",".join([c[0], f"{float(c[1]) - 1:.8f}", *c[2:]]) for c in (l.split(",") for l in lines[1:])]
        (query / "gps.csv").write_text("\n".join(moved) + "\n")
        self.query = query
        self.expect_done(self.localize("--map", self.map))
        rows = rows_of(self.fixes)
        self.assertEqual({row["status"] for row in rows} - {"off-map", "initializing"}, set())
        self.assertEqual({row["along_m"] for row in rows}, {""})

    def test_wrong_calls(self):
        self.expect_refused(run(CLIENT), 2, "a command is missing")
        self.expect_refused(run(CLIENT, "localise"), 2, "'localise' is not a command")
        self.expect_refused(self.localize(), 2, "--server or --map")
        self.expect_refused(self.localize("--server", "http://127.0.0.1:1"), 2, "--cache")
        self.expect_refused(self.localize("--map", "a", "--server", "b", "--cache", "c"), 2, "--map")
        self.expect_done(run(CLIENT, "--version"))

    def test_help_teaches(self):
        self.expect_teaches(run(CLIENT, "--help"), "localize", "evaluate")
        for command in ("localize", "evaluate"):
            self.expect_teaches(run(CLIENT, command, "--help"), "--drive DIR", "--cache-limit-mb MB", "1 to 1000000, default")


commands.main() if __name__ == "__main__" else None
