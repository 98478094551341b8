"""One bit or digit of the map changed, on its way or in the cache: every fix is the true one, or there is none."""
import contextlib
import hashlib
import json
import sqlite3
import unittest

import commands
from commands import CLIENT, CommandTest, STREET, Server, rows_of, run
from proxies import proxied


@contextlib.contextmanager
def spoiling(url):
    """A proxy in front of the server at `url`; yields it. Its `change` is applied to the bodies whose path it matches."""
    def changed_body(request, status, body):
        past_caches = request.headers.get("Cache-Control") == "no-cache"
        if status != 200 or not proxy.change or (past_caches and proxy.only_cached):
            return body
        return proxy.change(request.path, body)

    with proxied(url, changed=changed_body) as proxy:
        proxy.change = None
        proxy.only_cached = False  # requests past caches get the right bytes
        yield proxy


def changed(body, at):
    """The body with another digit at `at`, or another bit where there is no digit."""
    byte = body[at]
    other = 48 + (byte - 47) % 10 if 48 <= byte <= 57 else byte ^ (1 << at % 8)
    return body[:at] + bytes([other]) + body[at + 1:]


def changing(end_of_path, place):
    """Changes one byte, at that fraction of the body, of what has a path with this end."""
    def change(path, body):
        if not path.split("?")[0].endswith(end_of_path) or not body:
            return body
        return changed(body, int(place * (len(body) - 1)))
    return change


def moving_north(path, body):
    """One more in the fourth decimal of every latitude of a line: 11 m to the north."""
    if "/segments/" not in path or "/tiles" in path:
        return body
    document = json.loads(body)
    for vertex in document["line"]:
        vertex[0] = round(vertex[0] + 1e-4, 9)
    return json.dumps(document, separators=(",", ":")).encode()


class Damage(CommandTest):
    drive = STREET / "street-query"

    def setUp(self):
        super().setUp()
        self.maps = self.folder / "maps"
        self.maps.mkdir()
        self.expect_done(self.build(STREET / "street-map", self.maps / "street.map"))
        self.fixes = self.folder / "fixes.csv"

    def localize(self, url, cache):
        return run(CLIENT, "localize", "--server", url, "--cache", cache, "--drive", self.drive, "--out", self.fixes,
                   timeout=120)

    def places(self):
        return [{key: value for key, value in row.items() if key != "latency_ms"} for row in rows_of(self.fixes)]

    def expect_true_or_none(self, result, truth):
        """Either the true fixes, or an error of one line that says what to do, and no fix of another place: with a tile less it
        may be less sure, and so a little different."""
        places = self.places()
        self.assertEqual(len(places), len(truth))
        for place, true in zip(places, truth):
            if place["along_m"] and place != true:
                sigma_m = max(float(place["sigma_m"]), float(true["sigma_m"] or 0))
                self.assertEqual(place["segment"], true["segment"] or place["segment"])
                self.assertLess(sigma_m, 1)  # as at a start
                if true["along_m"]:
                    self.assertAlmostEqual(float(place["along_m"]), float(true["along_m"]), delta=3 * sigma_m)
        if places != truth:
            self.assertEqual(result.returncode, 1)
            line, = result.stderr.strip().splitlines()[-1:]
            self.assertIn("; ", line)

    def test_on_the_way(self):
        with Server(self.maps) as server, spoiling(server.url) as proxy:
            self.expect_done(self.localize(proxy.url, self.folder / "whole"))
            truth = self.places()
            self.assertGreater(sum(place["status"] == "tracking" for place in truth), 0.9 * len(truth))
            spoilt = [changing("/manifest", 0.6), changing("/map", 0.3), changing("/segments/street-map-0", 0.2),
                      changing("/segments/street-map-0", 0.9), changing("/tiles", 0.5), changing("/segments", 0.7),
                      moving_north]
            for number, change in enumerate(spoilt):
                with self.subTest(number=number):
                    proxy.change, proxy.only_cached = change, False
                    cache = self.folder / f"cache-{number}"
                    self.expect_true_or_none(self.localize(proxy.url, cache), truth)
                    # Nothing of it was stored.
                    proxy.change = None
                    self.expect_done(self.localize(proxy.url, cache))
                    self.assertEqual(self.places(), truth)

    def test_in_a_cache_on_the_way(self):
        with Server(self.maps) as server, spoiling(server.url) as proxy:
            self.expect_done(self.localize(proxy.url, self.folder / "whole"))
            truth = self.places()
            proxy.only_cached = True
            proxy.change = lambda path, body: changed(body, len(body) // 2) if "/builds/" in path and body else body
            self.expect_done(self.localize(proxy.url, self.folder / "cold"))
            self.assertEqual(self.places(), truth)

    def test_in_the_clients_cache(self):
        with Server(self.maps) as server:
            self.expect_done(self.localize(server.url, self.folder / "cache"))
            truth = self.places()
            url = server.url
        store = next((self.folder / "cache").glob("tiles-*.sqlite"))
        whole = store.read_bytes()
        with contextlib.closing(sqlite3.connect(store)) as cache:
            rows = cache.execute("SELECT id, content FROM entries WHERE layer = ''"
                                 " UNION ALL SELECT min(id), content FROM entries WHERE layer <> ''").fetchall()
        for key, content in rows:
            with self.subTest(key=key):
                store.write_bytes(whole)
                content = changed(content, len(content) // 3)
                digest = hashlib.blake2b(content, digest_size=16).hexdigest()
                with contextlib.closing(sqlite3.connect(store)) as cache, cache:
                    cache.execute("UPDATE entries SET content = ?, digest = ? WHERE id = ?", (content, digest, key))
                self.expect_true_or_none(self.localize(url, self.folder / "cache"), truth)


if __name__ == "__main__":
    commands.main()
