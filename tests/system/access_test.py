"""TLS, tokens and limits as an operator sets them up: the programs, their files, and a vehicle that asks."""
import os
import pathlib
import re
import signal
import socket
import ssl
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

import commands
from commands import CLIENT, MAPPER, SERVER, STREET, CommandTest, Server, certificate, rows_of, run


def get(url, token=None, **context):
    """Status and body."""
    request = urllib.request.Request(url, headers={"Authorization": f"Bearer {token}"} if token else {})
    try:
        with urllib.request.urlopen(request, **context) as answer:
            return answer.status, answer.read()
    except urllib.error.HTTPError as error:
        return error.code, error.read()


class Access(CommandTest):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.maps = pathlib.Path(folder.name) / "maps"
        cls.maps.mkdir()
        done = run(MAPPER, "build", "--drive", STREET / "street-map", "--map", cls.maps / "street.map")
        if done.returncode:
            raise RuntimeError(done.stderr)

    def make_token(self, *words):
        made = run(SERVER, "token", "--tokens", self.folder / "tokens.json", "--add", *words)
        self.expect_done(made)
        return made.stdout.strip()

    def localize(self, server, *words, out="fixes.csv"):
        return run(CLIENT, "localize", "--server", server.url, "--cache", self.folder / "cache", "--drive", STREET / "street-query",
                   "--out", self.folder / out, *words)

    def until(self, condition, what):
        for _ in range(400):
            if condition():
                return
            time.sleep(0.05)
        raise AssertionError(f"in vain: {what}")

    def expect_refused(self, result, *parts, code=1):
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        for part in parts:
            self.assertIn(str(part), result.stderr)

    def test_a_vehicle_over_tls_with_a_token(self):
        chain, key = certificate(self.folder, "first")
        token = self.folder / "fleet.token"
        token.write_text(self.make_token("fleet", "--map", "street") + "\n")
        with Server(self.maps, "--tls-cert", chain, "--tls-key", key, "--tokens", self.folder / "tokens.json", scheme="https") as server:
            refused = self.localize(server, "--token-file", token)
            self.expect_refused(refused, server.url, "certificate")
            refused = self.localize(server, "--ca-file", chain)
            self.expect_refused(refused, "a token is needed", server.url)
            self.expect_done(self.localize(server, "--ca-file", chain, "--token-file", token))
        fixes = rows_of(self.folder / "fixes.csv")
        self.assertGreater(len(fixes), 0)
        self.assertTrue(any(fix["status"] == "tracking" for fix in fixes), fixes[0])

    def test_a_renewed_certificate_is_taken_up(self):
        chain, key = certificate(self.folder, "first")
        with Server(self.maps, "--tls-cert", chain, "--tls-key", key, scheme="https") as server:
            host, port = re.search(r"//([^:]+):(\d+)", server.url).groups()

            def served():
                context = ssl.create_default_context()
                context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
                with socket.create_connection((host, int(port))) as plain, context.wrap_socket(plain) as secure:
                    return secure.getpeercert(binary_form=True)

            first = served()
            for part, new in zip((chain, key), certificate(self.folder, "second")):
                os.replace(new, part)
            server.process.send_signal(signal.SIGHUP)
            self.until(lambda: served() != first, "the second certificate")
            second = served()
            chain.write_text("no certificate\n")
            server.process.send_signal(signal.SIGHUP)
            context = ssl.create_default_context()
            context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
            self.until(lambda: b"milepost_file_failures_total 1" in get(server.url + "/metrics", context=context)[1], "the failure is counted")
            self.assertEqual(served(), second)

    def test_a_token_from_its_making_to_its_end(self):
        file = self.folder / "tokens.json"
        fleet, operator = self.make_token("fleet-7", "--map", "street"), self.make_token("operator", "--all-maps", "--days", "3")
        self.assertNotIn(fleet, file.read_text())
        os.chmod(file, 0o640)
        self.make_token("third", "--all-maps")
        self.assertEqual(file.stat().st_mode & 0o777, 0o640)
        listed = run(SERVER, "token", "--tokens", file, "--list")
        self.expect_done(listed)
        self.assertRegex(listed.stdout, r"(?m)^fleet-7  [0-9a-f]{16}  never expires  maps: street$")
        self.assertRegex(listed.stdout, r"(?m)^operator  [0-9a-f]{16}  expires \S+Z  maps: all$")
        with Server(self.maps, "--tokens", file) as server:
            self.assertEqual(get(server.url + "/v1/maps/street")[0], 401)
            self.assertEqual(get(server.url + "/v1/maps/street", fleet)[0], 200)
            self.assertEqual(get(server.url + "/metrics", fleet)[0], 403)
            self.assertEqual(get(server.url + "/metrics", operator)[0], 200)
            self.expect_done(run(SERVER, "token", "--tokens", file, "--remove", "fleet-7"))
            server.process.send_signal(signal.SIGHUP)
            self.until(lambda: get(server.url + "/v1/maps/street", fleet)[0] == 401, "the token is taken back")
            self.assertEqual(get(server.url + "/v1/maps/street", operator)[0], 200)
            file.write_text("{}")
            server.process.send_signal(signal.SIGHUP)
            self.until(lambda: b"milepost_file_failures_total 1" in get(server.url + "/metrics", operator)[1], "the failure is counted")
            self.assertEqual(get(server.url + "/v1/maps/street", operator)[0], 200)

    def test_calls_that_make_no_token(self):
        file = self.folder / "tokens.json"
        token = [SERVER, "token", "--tokens", file]
        self.make_token("fleet", "--map", "street")
        before = file.read_bytes()
        self.expect_refused(run(*token, "--add", "fleet", "--map", "street"), file, "already")
        self.expect_refused(run(*token, "--add", "a b", "--map", "street"), "a b", "is no name")
        self.expect_refused(run(*token, "--add", "other"), "--map", "--all-maps")
        self.expect_refused(run(*token, "--add", "other", "--map", "x", "--all-maps"), "--all-maps")
        self.expect_refused(run(*token, "--add", "other", "--map", "../x"), "../x")
        self.expect_refused(run(*token, "--add", "other", "--map", "x", "--expires", "soon"), "soon", "2027-01-01")
        self.expect_refused(run(*token, "--remove", "other"), file, "has no token 'other'")
        self.expect_refused(run(*token, "--remove", "a", "--list"), code=2)
        self.expect_refused(run(*token), code=2)
        self.assertEqual(file.read_bytes(), before)
        drive = STREET / "street-query" / "drive.json"
        self.expect_refused(run(SERVER, "token", "--tokens", drive, "--add", "a", "--all-maps"), drive)
        self.expect_refused(run(SERVER, "token", "--tokens", self.folder / "no" / "tokens", "--add", "a", "--all-maps"), "no")
        self.expect_teaches(run(SERVER, "token", "--help"), "--add NAME", "--remove NAME", "--days N")

    def test_files_that_cannot_be_used_end_the_start(self):
        chain, key = certificate(self.folder, "first")
        _, other = certificate(self.folder, "other")
        serve = [SERVER, "--maps", self.maps, "--listen", "127.0.0.1:0"]
        self.expect_refused(run(*serve, "--tls-cert", chain, "--tls-key", other), other, "is no key for the certificate")
        self.expect_refused(run(*serve, "--tls-cert", self.folder / "absent", "--tls-key", key), "absent", "cannot be read")
        self.expect_refused(run(*serve, "--tls-cert", chain), "--tls-key", code=2)
        self.expect_refused(run(*serve, "--tokens", self.folder / "absent"), "absent")
        self.expect_refused(run(*serve, "--tokens", key), key, "milepost-server token")
        self.expect_refused(run(*serve, "--allow-origin", "maps.example.org"), "maps.example.org", "https://", code=2)
        self.expect_refused(run(*serve, "--requests-per-s", "-1"), "--requests-per-s", code=2)
        self.expect_refused(run(*serve, "--check-config", "--tls-cert", chain, "--tls-key", other), other)

    def test_the_configuration_file_sets_them_too(self):
        chain, key = certificate(self.folder, "first")
        self.make_token("fleet", "--map", "street")
        config = self.folder / "server.toml"
        config.write_text(f'tls-cert = "{chain}"\ntls-key = "{key}"\ntokens = "{self.folder / "tokens.json"}"\nrequests-per-s = 1\nburst = 2\n'
                          'allow-origin = ["https://a.example.org", "https://b.example.org"]\n')
        with Server(self.maps, "--config", config, scheme="https") as server:
            context = ssl.create_default_context(cafile=chain)
            for origin in ("https://a.example.org", "https://b.example.org"):
                request = urllib.request.Request(server.url + "/healthz", headers={"Origin": origin})
                with urllib.request.urlopen(request, context=context) as answer:
                    self.assertEqual(answer.headers["Access-Control-Allow-Origin"], origin)
            self.assertEqual(get(server.url + "/healthz", context=context)[0], 429)

    def test_a_token_file_of_the_client(self):
        empty = self.folder / "empty"
        empty.write_text("\n")
        with Server(self.maps) as server:
            self.expect_refused(self.localize(server, "--token-file", empty), empty, "holds no token")
            self.expect_refused(self.localize(server, "--token-file", self.folder / "absent"), "absent")
            self.expect_refused(self.localize(server, "--ca-file", self.folder / "absent"), "absent")

    def test_the_log_tells_whose_token(self):
        token = self.make_token("fleet", "--map", "street")
        with subprocess.Popen([SERVER, "--maps", self.maps, "--listen", "127.0.0.1:0", "--tokens", self.folder / "tokens.json"],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            url = "http://" + re.search(r"listening on (\S+)", process.stdout.readline())[1]
            get(url + "/v1/maps/street", token)
            get(url + "/v1/maps/street", "mp_unknown")
            process.send_signal(signal.SIGTERM)
            log = process.communicate()[1]
        self.assertRegex(log, r'127\.0\.0\.1 fleet "GET /v1/maps/street" 200')
        self.assertRegex(log, r'127\.0\.0\.1 "GET /v1/maps/street" 401')
        self.assertNotIn(token, log)


if __name__ == "__main__":
    commands.main()
