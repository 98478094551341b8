"""A network that responds instead of the server (captive portal), and a cache that another process locks."""
import contextlib
import fcntl
import http.server
import threading

import commands
from commands import CLIENT, CommandTest, STREET, Server, rows_of, run

PAGE = b"<!DOCTYPE html><html><body>Welcome! Please log in.</body></html>"
HTML = {"Content-Type": "text/html; charset=utf-8"}
JSON = {"Content-Type": "application/json"}
# Responses to any URL: status, header, body. tests/client/fetch/portal_test.cc has more.
ANSWERS = {
    "page": (200, HTML, PAGE),
    "forbidden": (403, HTML, PAGE),
    "loop of redirects": (302, {"Location": "/"}, b""),
    "lists in lists": (200, JSON, b'{"segments": ' + b"[" * 1000000 + b"]" * 1000000 + b"}"),
}


@contextlib.contextmanager
def portal(status, header, body):
    """Responds to every request in the same way; yields the URL."""
    class Handler(http.server.BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def do_GET(self):
            self.send_response(status)
            for name, value in header.items():
                self.send_header(name, value)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_):
            pass

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_address[1]}"
        server.shutdown()


class Portal(CommandTest):
    def setUp(self):
        super().setUp()
        maps = self.folder / "maps"
        maps.mkdir()
        self.expect_done(self.build(STREET / "street-map", maps / "street.map"))
        self.cache = self.folder / "cache"
        self.fixes = self.folder / "fixes.csv"
        with Server(maps) as server:
            self.expect_done(self.localize(server.url, self.cache))
        self.expected = self.places()

    def localize(self, url, cache):
        return run(CLIENT, "localize", "--server", url, "--cache", cache, "--drive", STREET / "street-query",
                   "--out", self.fixes, timeout=120)

    def places(self):
        """The fixes without their latency."""
        return [{key: value for key, value in row.items() if key != "latency_ms"} for row in rows_of(self.fixes)]

    def test_the_vehicle_goes_on_with_what_its_cache_holds(self):
        for name, answer in ANSWERS.items():
            with self.subTest(name), portal(*answer) as url:
                self.expect_done(self.localize(url, self.cache))
                self.assertEqual(self.places(), self.expected)
                self.expect_refused(self.localize(url, self.folder / f"cold {name}"), 1, url,
                                    "something other than a milepost server answered", "log in")
        with self.subTest("a lock that another process holds"), open(self.cache / "lock", "wb") as lock, \
                Server(self.folder / "maps") as server:
            fcntl.flock(lock, fcntl.LOCK_EX)
            self.expect_done(self.localize(server.url, self.cache))
            self.assertEqual(self.places(), self.expected)


if __name__ == "__main__":
    commands.main()
