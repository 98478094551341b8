"""Maps published as plain files: what static servers make of them, and what clients make of these."""
import hashlib
import http.client
import json
import os
import resource
import shutil
import signal
import subprocess
import time
import unittest
import urllib.parse

import commands
from commands import CLIENT, CommandTest, SERVER, STREET, Server, rows_of, run
from static_stores import nginx, object_store


def get(url):
    """(status, header fields, body), following nothing."""
    parts = urllib.parse.urlsplit(url)
    connection = http.client.HTTPConnection(parts.netloc, timeout=30)
    connection.request("GET", parts.path + ("?" + parts.query if parts.query else ""))
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer.status, answer.headers, body


def url_of(path):
    """The server's URL for a file of the tree."""
    return "/" + path.removesuffix("/index.json")


def places(file):
    return [{key: value for key, value in row.items() if key != "latency_ms"} for row in rows_of(file)]


def check_valid(test, tree):
    """What the tree's documents point to is there, and has the digest that they give."""
    if not (tree / "v1/maps/index.json").exists():
        return 0
    maps = json.loads((tree / "v1/maps/index.json").read_bytes())
    test.assertIs(maps["static"], True)
    segments = json.loads((tree / "v1/segments").read_bytes())
    test.assertIs(segments["static"], True)
    versions = {(entry["name"], entry["build"]) for entry in maps["maps"]}
    for file in (tree / "v1/maps").glob("*/index.json"):
        document = json.loads(file.read_bytes())
        versions.add((document["name"], document["build"]))
    versions |= {(entry["map"], entry["build"]) for entry in segments["segments"]}
    for name, build in versions:
        check_build(test, tree / "v1/maps" / name / "builds" / build, build)
    return len(versions)


def check_build(test, folder, build):
    def content(path, listed):
        body = (folder / path).read_bytes()
        test.assertEqual(len(body), listed["bytes"], path)
        test.assertEqual(hashlib.blake2b(body, digest_size=16).hexdigest(), listed["digest"], path)
        return body

    manifest = (folder / "manifest").read_bytes()
    test.assertEqual(hashlib.blake2b(manifest, digest_size=16).hexdigest(), build)
    manifest = json.loads(manifest)
    content("map", manifest["map"])
    for layer, cells in json.loads(content("areas/index.json", manifest["areas"]))["cells"].items():
        for cell in cells:
            content(f"areas/{layer}/{cell['cell']}", cell)
    for listed in manifest["segments"]:
        root = "segments/" + listed["segment"]
        for layer, tiles in json.loads(content(root + "/index.json", listed))["tiles"].items():
            for tile in tiles:
                content(f"{root}/tiles/{layer}/{tile['index']}", tile)


class PublishTest(CommandTest):
    """With the street's map in `maps`, to be published to `tree`."""

    def setUp(self):
        super().setUp()
        self.maps = self.folder / "maps"
        self.maps.mkdir()
        self.tree = self.folder / "tree"
        self.expect_done(self.build(STREET / "street-map", self.maps / "street.map"))

    def publish(self, *words):
        return run(SERVER, "publish", "--maps", self.maps, "--out", self.tree, *words)

    def publish_done(self, *words):
        result = self.publish(*words)
        self.expect_done(result)
        check_valid(self, self.tree)
        return result.stdout

    def builds(self, name="street"):
        return {folder.name for folder in (self.tree / "v1/maps" / name / "builds").iterdir()}

    def build_anew(self, *words):
        self.expect_done(self.build(STREET / "street-map", self.maps / "street.map", *words))


class Stores(PublishTest):
    def localize(self, url, cache):
        fixes = self.folder / "fixes.csv"
        self.expect_done(run(CLIENT, "localize", "--server", url, "--cache", self.folder / cache, "--drive",
                             STREET / "street-query", "--out", fixes, timeout=120))
        return places(fixes)

    def test_every_file_is_what_the_server_sends(self):
        key = self.folder / "key"
        self.expect_done(run(SERVER, "keygen", "--out", key))
        self.expect_done(run(SERVER, "sign", "--maps", self.maps, "--key", key))
        self.publish_done()
        headers = json.loads((self.tree / "headers.json").read_bytes())
        files = {str(file.relative_to(self.tree)) for file in self.tree.rglob("*") if file.is_file()}
        self.assertEqual(set(headers["ETag"]), files - {"headers.json"})
        work = self.folder / "nginx"
        work.mkdir()
        with Server(self.maps) as server, nginx(self.tree, work) as store:
            for path, tag in headers["ETag"].items():
                with self.subTest(path=path):
                    group, = [group for group in headers["groups"] if self.fits(path, group)]
                    status, fields, body = get(server.url + url_of(path))
                    if path not in ("v1/maps/index.json", "v1/segments"):
                        self.assertEqual(status, 200)
                        self.assertEqual(body, (self.tree / path).read_bytes())
                        self.assertEqual(fields["ETag"], tag)
                        for name in ("Content-Type", "Cache-Control"):
                            self.assertEqual(fields[name], group[name])
                    for url in {"/" + path, url_of(path)}:
                        status, fields, body = get(store + url)
                        self.assertEqual(status, 200, url)
                        self.assertEqual(body, (self.tree / path).read_bytes())
                        self.assertEqual(fields["Content-Type"], group["Content-Type"])
                        self.assertEqual(fields["Cache-Control"], group["Cache-Control"])
            for path, expected in (("/v1/maps/village", 404), ("/v1/maps/street/builds/" + "0" * 32 + "/manifest", 410),
                                   ("/v1/maps/street/builds/" + "0" * 32 + "/manifest.sig", 404)):
                status, fields, body = get(store + path)
                self.assertEqual((status, fields["Content-Type"]), (expected, "application/problem+json"))
                self.assertEqual(json.loads(body)["status"], expected)

    @staticmethod
    def fits(path, group):
        words = path.split("/")
        return any(len(words) == len(parts) and all(part in ("*", word) for part, word in zip(parts, words))
                   for parts in (pattern.lstrip("/").split("/") for pattern in group["patterns"]))

    def test_clients_localize_alike(self):
        self.publish_done()
        work = self.folder / "nginx"
        work.mkdir()
        with Server(self.maps) as server:
            truth = self.localize(server.url, "by-server")
        self.assertGreater(sum(place["status"] == "tracking" for place in truth), 0.9 * len(truth))
        with nginx(self.tree, work) as store:
            self.assertEqual(self.localize(store, "by-nginx"), truth)
            log = (work / "access.log").read_text()
            self.assertNotIn("/tiles?", log)
            self.assertEqual(log.count("GET /v1/segments?"), 1)  # it lists them all
            self.assertEqual(log.count(" 404 "), 0)
        self.assertEqual(self.localize("http://127.0.0.1:9", "by-nginx"), truth)  # from its cache
        with object_store(self.tree) as store:
            self.assertEqual(self.localize(store, "by-store"), truth)

    def test_a_signed_tree_is_accepted_and_a_spoilt_one_refused(self):
        key = self.folder / "key"
        self.expect_done(run(SERVER, "keygen", "--out", key))
        self.expect_done(run(SERVER, "sign", "--maps", self.maps, "--key", key))
        self.publish_done()
        fixes = self.folder / "fixes.csv"
        words = ["--drive", STREET / "street-query", "--out", fixes, "--key", str(key) + ".pub"]
        with object_store(self.tree) as store:
            self.expect_done(run(CLIENT, "localize", "--server", store, "--cache", self.folder / "a", *words))
            signature, = (self.tree / "v1/maps/street/builds").glob("*/manifest.sig")
            signature.write_text(signature.read_text().replace("map street", "map strees"))
            refused = run(CLIENT, "localize", "--server", store, "--cache", self.folder / "b", *words)
            self.expect_refused(refused, 1, "manifest.sig", "'strees'")


class Trees(PublishTest):
    def test_again_only_what_differs_is_written(self):
        first = self.publish_done()
        self.assertRegex(first, r"1 maps, (\d+) files, \1 written, 0 old builds removed")
        stamps = {file: file.stat().st_mtime_ns for file in self.tree.rglob("*") if file.is_file()}
        self.assertIn(" 0 written", self.publish_done())
        self.assertEqual(stamps, {file: file.stat().st_mtime_ns for file in stamps})
        tile = next(self.tree.glob("v1/maps/*/builds/*/segments/*/tiles/*/0"))
        tile.write_bytes(tile.read_bytes()[:-1])
        self.assertIn(" 1 written", self.publish_done())

    def test_old_builds_stay_until_they_are_removed(self):
        self.publish_done()
        old, = self.builds()
        self.build_anew("--jobs", "1", "--lab")
        shutil.copy(self.maps / "street.map", self.maps / "lane.map")
        self.publish_done()
        self.assertEqual(len(self.builds()), 2)
        check_build(self, self.tree / "v1/maps/street/builds" / old, old)
        listed = json.loads((self.tree / "headers.json").read_bytes())["ETag"]
        self.assertIn(f"v1/maps/street/builds/{old}/manifest", listed)
        (self.maps / "lane.map").unlink()
        (self.tree / "v1/maps/README").write_text("a foreign file stays")
        self.assertIn(" 2 old builds removed", self.publish_done("--remove-old"))
        self.assertNotIn(old, self.builds())
        self.assertEqual({entry.name for entry in (self.tree / "v1/maps").iterdir()},
                         {"street", "index.json", "README"})
        listed = json.loads((self.tree / "headers.json").read_bytes())["ETag"]
        files = {str(file.relative_to(self.tree)) for file in self.tree.rglob("*") if file.is_file()}
        self.assertEqual(set(listed), files - {"headers.json", "v1/maps/README"})

    def test_killed_at_any_instant_it_leaves_a_valid_tree(self):
        self.publish_done()
        old = self.folder / "old"
        shutil.copytree(self.tree, old)
        self.build_anew("--jobs", "1", "--lab")
        begun = time.monotonic()
        self.publish_done("--remove-old")
        whole_s = time.monotonic() - begun
        complete = {file.relative_to(self.tree): file.read_bytes() for file in self.tree.rglob("*") if file.is_file()}
        valid = 0
        for step in range(40):
            shutil.rmtree(self.tree)
            if step % 2:
                shutil.copytree(old, self.tree)
            process = subprocess.Popen([SERVER, "publish", "--maps", self.maps, "--out", self.tree, "--remove-old"],
                                       stdout=subprocess.DEVNULL)
            time.sleep(whole_s * step / 40)
            process.send_signal(signal.SIGKILL)
            process.wait()
            if self.tree.exists():
                valid += check_valid(self, self.tree)
            self.publish_done("--remove-old")
            self.assertEqual({file.relative_to(self.tree): file.read_bytes()
                              for file in self.tree.rglob("*") if file.is_file()}, complete)
        self.assertGreater(valid, 0)

    def test_wrong_calls_and_failures_are_one_line(self):
        self.expect_refused(run(SERVER, "publish", "--maps", self.maps), 2, "--out")
        self.expect_refused(run(SERVER, "publish", "--maps", self.folder / "no", "--out", self.tree), 1, "no")
        self.tree.mkdir()
        (self.tree / "thesis.tex").write_text("precious")
        self.expect_refused(self.publish(), 1, str(self.tree), "neither empty nor a published tree")
        self.assertEqual(os.listdir(self.tree), ["thesis.tex"])
        (self.tree / "thesis.tex").unlink()
        (self.tree / "v1").write_text("a file in the way")
        (self.tree / "headers.json").write_text('{"ETag": {}}')
        self.expect_refused(self.publish(), 1, "v1", "cannot be written")
        (self.tree / "headers.json").write_text("{}")
        self.expect_refused(self.publish(), 1, "headers.json")
        shutil.rmtree(self.tree)
        broken = self.maps / "broken.map"
        broken.write_bytes((self.maps / "street.map").read_bytes()[:5000])
        self.expect_refused(self.publish(), 1, "broken.map")
        self.assertFalse(self.tree.exists())
        broken.unlink()
        shutil.copy(self.maps / "street.map", self.maps / "index.json.map")
        self.expect_refused(self.publish(), 1, "'index.json'", "rename")

    def test_a_full_disk_is_one_line(self):
        limit = 4_000  # bytes of a file

        def limited():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        result = subprocess.run([SERVER, "publish", "--maps", self.maps, "--out", self.tree], capture_output=True,
                                text=True, preexec_fn=limited, check=False)
        self.assertNotIn(".partial", os.listdir(self.tree))
        self.expect_refused(result, 1, "cannot be written", "; ")
        check_valid(self, self.tree)
        self.publish_done()

    def test_a_damaged_tile_is_one_line(self):
        file = self.maps / "street.map"
        content = bytearray(file.read_bytes())
        at = content.rfind(b"\x28\xb5\x2f\xfd")  # the beginning of a tile
        content[at + 100] ^= 1
        file.write_bytes(content)
        self.expect_refused(self.publish(), 1, "street.map", "tile")
        check_valid(self, self.tree)
        self.assertFalse((self.tree / "v1/maps/index.json").exists())

    def test_help_teaches(self):
        self.expect_teaches(run(SERVER, "publish", "--help"), "rclone", "--remove-old", "index.json")
        self.expect_teaches(run(SERVER, "--help"), "publish", "sign", "keygen")


if __name__ == "__main__":
    commands.main()
