"""The server in operation: behind nginx with TLS and a cache, and started by a service manager."""
import contextlib
import http.client
import json
import os
import pathlib
import re
import signal
import socket
import ssl
import subprocess
import time
import urllib.request

import commands
from commands import CommandTest, SERVER, STREET, Server, certificate, run
from static_stores import NGINX, free_port, wait_for

ROOT = pathlib.Path(__file__).resolve().parents[2]


class FrontTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.maps = self.folder / "maps"
        self.maps.mkdir()
        self.expect_done(self.build(STREET / "street-map", self.maps / "street.map"))

    @contextlib.contextmanager
    def nginx(self, upstream):
        """deploy/nginx-front.conf with this folder's certificate and cache; its port."""
        chain, key = certificate(self.folder, "front")
        port = free_port()
        text = (ROOT / "deploy" / "nginx-front.conf").read_text()
        for known, here in (("/var/cache/nginx/milepost", str(self.folder / "cache")),
                            ("127.0.0.1:8080", upstream), ("listen 443", f"listen 127.0.0.1:{port}"),
                            ("/etc/ssl/milepost/fullchain.pem", str(chain)),
                            ("/etc/ssl/milepost/key.pem", str(key))):
            self.assertIn(known, text)
            text = text.replace(known, here)
        main = self.folder / "nginx.conf"
        user = "user root; " if os.getuid() == 0 else ""
        main.write_text(f"daemon off; {user}worker_processes 1; pid {self.folder}/pid; error_log {self.folder}/error.log;\n"
                        "events { worker_connections 512; }\n"
                        "http { access_log off;" + "".join(
                            f" {kind}_temp_path {self.folder}/{kind};"
                            for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")) + "\n" + text + "}\n")
        process = subprocess.Popen([NGINX, "-c", str(main), "-p", str(self.folder)], stderr=subprocess.DEVNULL)
        try:
            wait_for(port, process)
            yield port
        finally:
            process.send_signal(signal.SIGTERM)
            process.communicate(timeout=30)

    def get(self, port, path, **headers):
        trusting = ssl._create_unverified_context()  # the certificate is this test's
        connection = http.client.HTTPSConnection("127.0.0.1", port, timeout=30, context=trusting)
        connection.request("GET", path, headers=headers)
        answer = connection.getresponse()
        body = answer.read()
        connection.close()
        return answer, body

    def sent_by_the_server(self, server):
        """How many tiles it has sent, by its own count."""
        address = server.url.removeprefix("http://")
        connection = http.client.HTTPConnection(address, timeout=30)
        connection.request("GET", "/metrics")
        text = connection.getresponse().read().decode()
        connection.close()
        found = re.search(r'^milepost_map_tiles_total{map="street"} (\d+)$', text, re.MULTILINE)
        return int(found[1]) if found else 0

    def test_tiles_come_from_the_cache_and_the_current_state_does_not(self):
        with Server(self.maps) as server, self.nginx(server.url.removeprefix("http://")) as port:
            current = json.loads(self.get(port, "/v1/maps/street")[1])
            segment = f"/v1/maps/street/builds/{current['build']}/segments/{current['segments'][0]}"
            layer = next(iter(json.loads(self.get(port, segment)[1])["tiles"]))
            tile = f"{segment}/tiles/{layer}/0"
            answer, first = self.get(port, tile)
            self.assertEqual(answer.status, 200)
            self.assertEqual(answer.headers["X-Cache"], "MISS")
            self.assertIn("immutable", answer.headers["Cache-Control"])
            for _ in range(20):
                answer, again = self.get(port, tile)
                self.assertEqual(answer.headers["X-Cache"], "HIT")
                self.assertEqual(again, first)
            self.assertEqual(self.sent_by_the_server(server), 1)
            # Past every cache, as a client asks that found damage.
            self.assertEqual(self.get(port, tile, **{"Cache-Control": "no-cache"})[1], first)
            self.assertEqual(self.sent_by_the_server(server), 2)
            # A new build is seen at once; the old one's tiles are in the cache.
            self.expect_done(self.build(STREET / "street-query", self.maps / "street.map"))
            for _ in range(500):
                new = json.loads(self.get(port, "/v1/maps/street")[1])
                if new["build"] != current["build"]:
                    break
                time.sleep(0.02)
            self.assertNotEqual(new["build"], current["build"])
            self.assertEqual(self.get(port, tile)[1], first)
            self.assertEqual(self.get(port, "/metrics")[0].status, 404)
            self.assertEqual(self.get(port, tile.rsplit("/", 1)[0] + "/99")[0].status, 404)


class DashboardTest(CommandTest):
    def test_it_asks_for_what_the_server_tells(self):
        maps = self.folder / "maps"
        maps.mkdir()
        self.expect_done(self.build(STREET / "street-map", maps / "street.map"))
        chain, key = certificate(self.folder, "server")
        with Server(maps, "--listen", "plain:127.0.0.1:0", "--tls-cert", chain, "--tls-key", key) as server:
            url = server.url + "/v1/maps/street"
            current = json.loads(urllib.request.urlopen(url, timeout=30).read())
            segment = f"{url}/builds/{current['build']}/segments/{current['segments'][0]}"
            layer = next(iter(json.loads(urllib.request.urlopen(segment, timeout=30).read())["tiles"]))
            urllib.request.urlopen(f"{segment}/tiles/{layer}/0", timeout=30).read()
            text = urllib.request.urlopen(server.url + "/metrics", timeout=30).read().decode()
        told = set(re.findall(r"^(\w+)", text, re.MULTILINE)) | {"milepost_map_damaged"}  # only with a damaged map
        dashboard = json.loads((ROOT / "deploy" / "grafana" / "milepost-server.json").read_text())
        asked = set()
        for panel in dashboard["panels"]:
            for target in panel["targets"]:
                asked |= set(re.findall(r"\b((?:milepost|process)_\w+)", target["expr"]))
        self.assertGreater(len(asked), 10)
        self.assertLessEqual(asked, told)


class ServiceTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.maps = self.folder / "maps"
        self.maps.mkdir()
        self.expect_done(self.build(STREET / "street-map", self.maps / "street.map"))

    def test_the_units_are_sound_and_hardened(self):
        units = self.folder / "units"
        units.mkdir()
        for unit in (ROOT / "deploy" / "systemd").glob("milepost-server.*"):
            text = unit.read_text().replace("/usr/bin/milepost-server", SERVER)
            (units / unit.name).write_text(text)
        service = units / "milepost-server.service"
        verified = run("systemd-analyze", "verify", "--man=no", service)
        self.assertEqual((verified.returncode, verified.stderr), (0, ""))
        security = run("systemd-analyze", "security", "--offline=true", service)
        exposure = float(re.search(r"exposure level for \S+: ([\d.]+)", security.stdout)[1])
        self.assertLessEqual(exposure, 1.5)

    def test_it_takes_the_socket_of_the_service_manager(self):
        config = self.folder / "server.toml"
        text = (ROOT / "deploy" / "systemd" / "server.toml").read_text()
        self.assertIn('"/srv/milepost"', text)
        config.write_text(text.replace("/srv/milepost", str(self.maps)))
        port = free_port()
        activator = subprocess.Popen(["systemd-socket-activate", "-l", f"127.0.0.1:{port}", SERVER, "--config",
                                      str(config)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        try:
            for _ in range(500):
                with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1):
                    break
                time.sleep(0.02)
            connection = http.client.HTTPConnection("127.0.0.1", port, timeout=30)
            connection.request("GET", "/v1/maps")
            self.assertIn(b"street", connection.getresponse().read())
            self.assertIn(f"listening on 127.0.0.1:{port} (1 maps)", activator.stdout.readline())
        finally:
            activator.send_signal(signal.SIGTERM)
            _, log = activator.communicate(timeout=30)
        self.assertEqual(activator.returncode, 0, log)
        lines = [json.loads(line) for line in log.splitlines() if line.startswith("{")]
        self.assertIn("stopping on SIGTERM", [line["message"] for line in lines])
        self.assertEqual({"time", "level", "message"}, set(lines[0]))

    def test_it_tells_the_service_manager_when_it_is_ready_and_when_it_stops(self):
        path = self.folder / "notify"
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
            manager.bind(str(path))
            manager.settimeout(30)
            process = subprocess.Popen([SERVER, "--maps", str(self.maps), "--listen", "127.0.0.1:0"],
                                       env={**os.environ, "NOTIFY_SOCKET": str(path)}, stdout=subprocess.PIPE,
                                       stderr=subprocess.DEVNULL)
            self.assertEqual(manager.recv(100), b"READY=1")
            process.send_signal(signal.SIGTERM)
            self.assertEqual(manager.recv(100), b"STOPPING=1")
            process.communicate(timeout=30)
            self.assertEqual(process.returncode, 0)


if __name__ == "__main__":
    commands.main()
