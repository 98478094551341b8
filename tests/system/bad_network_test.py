"""Networks and caches that hang while a drive is localized: no frame waits for them."""
import contextlib
import os
import pathlib
import signal
import sqlite3
import subprocess
import threading
import time
import unittest
import urllib.request

import commands
from commands import CLIENT, CommandTest, STREET, Server, rows_of, run, wait_until_caught
from proxies import proxied

LONGEST_S = 120       # of a drive
LONGEST_FRAME_MS = 3000


@contextlib.contextmanager
def between(url, spoil):
    """A proxy in front of the server at `url`; yields its URL. `spoil` may respond instead."""
    ending = threading.Event()
    with proxied(url, answers=lambda request: spoil(request, ending)) as proxy:
        yield proxy.url
        ending.set()


def never(_request, ending):
    """Accepts the request and does not respond."""
    ending.wait()
    return True


def drip(request, ending):
    """Two bytes per second."""
    request.send_response(200)
    request.send_header("Content-Type", "application/json")
    request.send_header("Content-Length", "100000")
    request.end_headers()
    while not ending.wait(1):
        request.wfile.write(b"{ ")
        request.wfile.flush()
    return True


def only_tiles(spoil):
    """Spoils tiles; documents are passed on."""
    return lambda request, ending: "/tiles" in request.path and spoil(request, ending)


class BadNetwork(CommandTest):
    drive = STREET / "street-query"

    def setUp(self):
        super().setUp()
        self.maps = self.folder / "maps"
        self.maps.mkdir()
        self.expect_done(self.build(STREET / "street-map", self.maps / "street.map"))
        self.fixes = self.folder / "fixes.csv"

    def localize(self, url, cache, timeout=LONGEST_S):
        began = time.monotonic()
        result = run(CLIENT, "localize", "--server", url, "--cache", cache, "--drive", self.drive,
                     "--out", self.fixes, timeout=timeout)
        self.assertLess(time.monotonic() - began, LONGEST_S)
        return result

    def rows(self):
        """The fixes: one per frame, none of which was delayed."""
        rows = rows_of(self.fixes)
        frames = len((self.drive / "trajectory.csv").read_text().splitlines()) - 1
        self.assertEqual(len(rows), frames)
        for row in rows:
            self.assertLess(float(row["latency_ms"]), LONGEST_FRAME_MS, row)
        return rows

    def places(self):
        return [{key: value for key, value in row.items() if key != "latency_ms"} for row in self.rows()]

    def test_a_server_that_never_answers(self):
        with Server(self.maps) as server, between(server.url, never) as url:
            self.expect_refused(self.localize(url, self.folder / "cold"), 1, url)
            self.assertEqual({row["status"] for row in self.rows()}, {"initializing"})
            self.expect_done(self.localize(server.url, self.folder / "warm"))
            expected = self.places()
            # The cache holds all of this drive's map: nothing has to be requested.
            cache = sqlite3.connect(next((self.folder / "warm").glob("tiles-*.sqlite")))
            cache.close()
        with between("http://127.0.0.1:1", never) as other:
            self.expect_done(self.localize(other, self.folder / "warm"))
            self.assertEqual(self.places(), expected)

    def test_a_server_that_drips(self):
        with Server(self.maps) as server, between(server.url, only_tiles(drip)) as url:
            self.expect_refused(self.localize(url, self.folder / "cold"), 1, url)
            self.assertEqual({row["status"] for row in self.rows()}, {"initializing"})

    def test_one_tile_in_the_middle_is_refused(self):
        """All is localized except where only that tile has landmarks."""
        with Server(self.maps) as server:
            self.expect_done(self.localize(server.url, self.folder / "whole"))
            tracked = sum(row["status"] == "tracking" for row in self.rows())
            cache = sqlite3.connect(next((self.folder / "whole").glob("tiles-*.sqlite")))
            tiles = [number for (number,) in cache.execute("SELECT number FROM entries WHERE layer = 'tracklets'")]
            cache.close()
            refused = sorted(tiles)[len(tiles) // 2]

            def refuse(request, _ending):
                path, _, query = request.path.partition("?")
                asked = {int(path.rsplit("/", 1)[1])} if not query and "/tiles/" in path else set()
                if query and "/tiles" in path:
                    with urllib.request.urlopen(server.url + request.path) as answer:
                        asked = {refused} if len(answer.read()) > 0 and self.holds(server.url, request.path, refused) \
                            else set()
                if refused not in asked:
                    return False
                request.send_response(500)
                request.send_header("Content-Length", "0")
                request.end_headers()
                return True

            with between(server.url, refuse) as url:
                self.localize(url, self.folder / "holed")
                rows = self.rows()
            found = sum(row["status"] == "tracking" for row in rows)
            self.assertGreater(found, tracked // 3)
            cache = sqlite3.connect(next((self.folder / "holed").glob("tiles-*.sqlite")))
            held = {number for (number,) in cache.execute("SELECT number FROM entries WHERE layer = 'tracklets'")}
            cache.close()
            self.assertEqual(held, set(tiles) - {refused})

    def holds(self, url, path, tile):
        """Whether the response to a range contains a tile, by the segment's document."""
        import json
        import re
        segment = path.split("/tiles")[0]
        with urllib.request.urlopen(url + segment) as answer:
            index = json.load(answer)["tiles"]["tracklets"]
        low, high = (float(re.search(name + r"=([-\d.]+)", path).group(1)) for name in ("from_m", "to_m"))
        return any(entry["index"] == tile and entry["from_m"] <= high and entry["to_m"] >= low for entry in index)

    def test_a_cache_that_another_process_has_locked(self):
        with Server(self.maps) as server:
            self.expect_done(self.localize(server.url, self.folder / "cache"))
            expected = self.places()
            other = sqlite3.connect(next((self.folder / "cache").glob("tiles-*.sqlite")), isolation_level=None)
            other.execute("PRAGMA locking_mode = EXCLUSIVE")
            other.execute("BEGIN EXCLUSIVE")
            try:
                self.expect_done(self.localize(server.url, self.folder / "cache"))
            finally:
                other.execute("ROLLBACK")
                other.close()
            self.assertEqual(self.places(), expected)

    def test_it_ends_when_it_is_asked_to(self):
        """Ctrl-C while the server is silent: at once, and nothing is written."""
        with between("http://127.0.0.1:1", never) as url:
            process = subprocess.Popen([CLIENT, "localize", "--server", url, "--cache", str(self.folder / "cache"),
                                        "--drive", str(self.drive), "--out", str(self.fixes)],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            wait_until_caught(process, signal.SIGINT)
            time.sleep(1)
            asked = time.monotonic()
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=60)
            self.assertLess(time.monotonic() - asked, 10)  # a second; the machines are noisy
            self.assertEqual(process.returncode, 1, errors)
            self.assertEqual(len(errors.splitlines()), 1, errors)
            self.assertFalse(self.fixes.exists())


if __name__ == "__main__":
    commands.main()
