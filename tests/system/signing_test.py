"""Signed maps: the commands, what the server sends, and that no byte on the way or in a cache can be exchanged."""
import contextlib
import hashlib
import json
import os
import pathlib
import shutil
import sqlite3
import stat
import unittest
import urllib.error
import urllib.request

import commands
from commands import CLIENT, CommandTest, MAPPER, SERVER, STREET, Server, rows_of, run
from proxies import proxied


def digest(content):
    return hashlib.blake2b(content, digest_size=16).hexdigest()


def raised(body):
    """The segment's document with its line 1 m higher, and all else as before."""
    document = json.loads(body)
    for vertex in document["line"]:
        vertex[2] += 1
    return json.dumps(document, separators=(",", ":"), sort_keys=True).encode()


class Forger:
    """Exchanges a map on its way for one of the forger's own making, as whole as the true one: its manifest, build, documents
    and lists fit one another."""

    def __init__(self, url):
        with urllib.request.urlopen(url + "/v1/maps") as answer:
            self.build = json.loads(answer.read())["maps"][0]["build"]
        root = f"{url}/v1/maps/street/builds/{self.build}"
        with urllib.request.urlopen(root + "/segments/street-map-0") as answer:
            self.segment = raised(answer.read())
        with urllib.request.urlopen(root + "/manifest") as answer:
            manifest = json.loads(answer.read())
        manifest["segments"][0].update(bytes=len(self.segment), digest=digest(self.segment))
        self.manifest = json.dumps(manifest, separators=(",", ":"), sort_keys=True).encode()
        self.forged = digest(self.manifest)
        self.signature = None  # None: the true build's

    def changed(self, request, status, body):
        path = request.path.split("?")[0]
        if path.endswith("/manifest.sig"):
            return body if self.signature is None else self.signature
        if status != 200 or path.startswith("/v1/maps/street/builds/" + self.build):
            return body
        if path.endswith("/manifest"):
            return self.manifest
        if path.endswith("/segments/street-map-0"):
            return self.segment
        if "/builds/" not in path:
            return body.replace(self.build.encode(), self.forged.encode())
        return body


@contextlib.contextmanager
def forged(url):
    forger = Forger(url)

    class ToServer(str):
        """The URL of the server, for paths that name the forged build."""
        def __add__(self, path):
            return str.__add__(self, path.replace(forger.forged, forger.build))

    with proxied(ToServer(url), changed=forger.changed) as proxy:
        proxy.forger = forger
        yield proxy


class Signing(CommandTest):
    def setUp(self):
        super().setUp()
        self.maps = self.folder / "maps"
        self.maps.mkdir()
        self.map = self.maps / "street.map"
        self.expect_done(self.build(STREET / "street-map", self.map))
        self.key = self.keygen("key")
        self.fixes = self.folder / "fixes.csv"

    def keygen(self, name):
        self.expect_done(run(SERVER, "keygen", "--out", self.folder / name))
        return self.folder / name

    def sign(self, key=None):
        return run(SERVER, "sign", "--maps", self.maps, "--key", key or self.key)

    def localize(self, url, cache, *keys, drive=STREET / "street-query"):
        words = [word for key in keys for word in ("--key", str(key) + ".pub")]
        return run(CLIENT, "localize", "--server", url, "--cache", self.folder / cache, "--drive", drive, "--out",
                   self.fixes, *words, timeout=120)

    def expect_localized(self, result):
        self.expect_done(result)
        self.assertGreater(sum(row["status"] == "tracking" for row in rows_of(self.fixes)), 20)
        self.fixes.unlink()

    def expect_no_fix(self, result, *parts):
        self.expect_refused(result, 1, *parts)
        if self.fixes.exists():
            self.assertFalse([row for row in rows_of(self.fixes) if row["along_m"]])

    def test_keys(self):
        self.assertEqual(stat.S_IMODE(self.key.stat().st_mode), 0o600)
        public = pathlib.Path(str(self.key) + ".pub")
        secret, opened = self.key.read_text(), public.read_text()
        self.assertRegex(secret, r"^milepost-secret-key-1 [0-9a-f]{64}\n$")
        self.assertRegex(opened, r"^milepost-public-key-1 [0-9a-f]{64}\n$")
        self.expect_refused(run(SERVER, "keygen", "--out", self.key), 1, str(self.key), "not replaced")
        public.unlink()
        self.expect_refused(run(SERVER, "keygen", "--out", self.key), 1, str(self.key), "not replaced")
        self.assertFalse(public.exists())
        self.assertEqual(self.key.read_text(), secret)
        self.expect_refused(run(SERVER, "keygen", "--out", self.folder / "no" / "key"), 1, "no/key", "cannot be written")
        self.expect_refused(run(SERVER, "keygen"), 2, "--out")
        for command in ("keygen", "sign"):
            self.expect_teaches(run(SERVER, command, "--help"), "--key", "Example")

    def test_a_map_is_signed_beside_it(self):
        before = self.map.read_bytes()
        self.expect_done(self.sign())
        self.assertEqual(self.map.read_bytes(), before)
        self.assertEqual(set(os.listdir(self.maps)), {"street.map", "street.map.sig"})
        first = (self.maps / "street.map.sig").read_text()
        self.assertIn("\nmap street\n", first)
        self.expect_done(run(SERVER, "sign", "--key", self.key, self.map))
        second = (self.maps / "street.map.sig").read_text()
        times = [int(text.split("signed_s ")[1].split()[0]) for text in (first, second)]
        self.assertLess(*times)  # also within one second
        (self.maps / "street.map.sig").write_text("shopping list")
        self.expect_refused(self.sign(), 1, "street.map.sig", "not a milepost signature")
        self.expect_refused(run(SERVER, "sign", "--key", str(self.key) + ".pub", self.map), 1, "key.pub", "keygen")
        self.expect_refused(run(SERVER, "sign", "--key", self.key, self.key), 1, "is not a milepost map")
        self.expect_refused(run(SERVER, "sign", "--key", self.key), 2, "--maps")

    def test_the_server_sends_the_signature_of_this_build(self):
        with Server(self.maps) as server:
            with urllib.request.urlopen(server.url + "/v1/maps") as answer:
                build = json.loads(answer.read())["maps"][0]["build"]
            url = f"{server.url}/v1/maps/street/builds/{build}/manifest.sig"
            with self.assertRaises(urllib.error.HTTPError) as refused:
                urllib.request.urlopen(url)
            self.assertEqual(refused.exception.code, 404)
            refused.exception.close()
            self.expect_done(self.sign())  # while it is served
            with urllib.request.urlopen(url) as answer:
                self.assertEqual(answer.headers["Cache-Control"], "no-cache")
                self.assertEqual(answer.read(), (self.maps / "street.map.sig").read_bytes())
            text = (self.maps / "street.map.sig").read_text()
            (self.maps / "street.map.sig").write_text(text.replace("map street", "map village"))
            with self.assertRaises(urllib.error.HTTPError) as refused:
                urllib.request.urlopen(url)
            self.assertEqual(refused.exception.code, 404)
            self.assertIn("map village", refused.exception.read().decode())

    def test_signed_maps_and_no_others(self):
        other = self.keygen("other")
        with Server(self.maps) as server:
            self.expect_localized(self.localize(server.url, "open"))
            self.expect_no_fix(self.localize(server.url, "a", self.key), "manifest.sig", "is not signed")
            # Neither is what the cache holds.
            self.expect_no_fix(self.localize(server.url, "open", self.key), "manifest.sig", "is not signed")
            self.expect_done(self.sign(other))
            self.expect_no_fix(self.localize(server.url, "a", self.key), "manifest.sig", "not by one of the given keys")
            self.expect_localized(self.localize(server.url, "b", self.key, other))
            self.expect_done(self.sign())
            self.expect_localized(self.localize(server.url, "a", self.key))
            url = server.url
        self.expect_localized(self.localize(url, "a", self.key))  # from the cache
        self.expect_refused(self.localize(url, "a", self.map), 1, "street.map.pub", "no such file")
        shutil.copy(self.key, self.folder / "secret.pub")
        self.expect_refused(self.localize(url, "a", self.folder / "secret"), 1, "secret.pub", "KEY.pub")
        self.expect_refused(run(CLIENT, "localize", "--map", self.map, "--key", str(self.key) + ".pub", "--drive",
                                STREET / "street-query", "--out", self.fixes), 2, "--server")

    def test_another_towns_map_under_this_name(self):
        self.expect_done(self.sign())
        town = self.folder / "town"
        town.mkdir()
        shutil.copy(self.map, town / "village.map")
        shutil.copy(self.maps / "street.map.sig", town / "village.map.sig")
        with Server(town) as server:
            self.expect_no_fix(self.localize(server.url, "a", self.key), "manifest.sig", "is not signed")

    def test_a_map_exchanged_on_the_way(self):
        self.expect_done(self.sign())
        with Server(self.maps) as server, forged(server.url) as proxy:
            # Without a key the forgery is believed: it is whole.
            self.expect_localized(self.localize(proxy.url, "open"))
            self.assertTrue(self.holds(proxy.forger, "open"))
            self.expect_no_fix(self.localize(proxy.url, "a", self.key), "manifest.sig", "one of build")
            self.assertFalse(self.holds(proxy.forger, "a"))
            true = (self.maps / "street.map.sig").read_bytes()
            proxy.forger.signature = true.replace(proxy.forger.build.encode(), proxy.forger.forged.encode())
            self.expect_no_fix(self.localize(proxy.url, "a", self.key), "manifest.sig", "not by one of the given keys")
            self.assertFalse(self.holds(proxy.forger, "a"))
            # Nor is it believed from the cache.
            self.expect_no_fix(self.localize(proxy.url, "open", self.key), "manifest.sig")
            self.expect_localized(self.localize(server.url, "a", self.key))

    def holds(self, forger, cache):
        """Whether the client's cache has anything of the forged build."""
        file = next((self.folder / cache).glob("tiles-*.sqlite"))
        with contextlib.closing(sqlite3.connect(file)) as opened:
            rows = opened.execute("SELECT build, content FROM entries").fetchall()
        return any(build == forger.forged or content == forger.segment for build, content in rows)

    def test_one_byte_of_anything_on_the_way(self):
        self.expect_done(self.sign())
        with Server(self.maps) as server:
            self.expect_localized(self.localize(server.url, "whole", self.key))
            for end in ("/manifest.sig", "/manifest", "/map", "/segments/street-map-0"):
                def spoil(request, status, body, end=end):
                    at = len(body) // 2
                    hit = status == 200 and request.path.endswith(end)
                    return body[:at] + bytes([body[at] ^ 1]) + body[at + 1:] if hit else body
                with self.subTest(end=end), proxied(server.url, changed=spoil) as proxy:
                    cache = "cache" + end.replace("/", "-")
                    self.expect_no_fix(self.localize(proxy.url, cache, self.key), end, "; ")
                    self.expect_localized(self.localize(server.url, cache, self.key))

    def test_an_older_build_does_not_come_back(self):
        self.expect_done(self.sign())
        old = self.folder / "old"
        shutil.copytree(self.maps, old)
        self.expect_done(run(MAPPER, "build", "--drive", STREET / "street-map", "--map", self.map, "--lab"))
        self.expect_done(self.sign())
        with Server(self.maps) as server:
            self.expect_localized(self.localize(server.url, "a", self.key))
        with Server(old) as server:
            self.expect_localized(self.localize(server.url, "b", self.key))
            self.expect_no_fix(self.localize(server.url, "a", self.key), "signed later")
            self.expect_done(run(SERVER, "sign", "--maps", old, "--key", self.key))
            self.expect_localized(self.localize(server.url, "a", self.key))


if __name__ == "__main__":
    commands.main()
