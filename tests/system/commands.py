"""Shared by the system tests: running the programs, and drives to run them on."""
import csv
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

MAPPER = os.environ.get("MILEPOST_MAPPER", "")
SERVER = os.environ.get("MILEPOST_SERVER", "")
CLIENT = os.environ.get("MILEPOST_CLIENT", "")
SIMULATOR = os.environ.get("MILEPOST_SIMULATOR", "")
STREET = pathlib.Path(os.environ.get("MILEPOST_STREET", ""))  # holds street-map and street-query
SHARED = pathlib.Path(os.environ.get("MILEPOST_SHARED", ""))  # recorded drives, if available


def run(*words, timeout=600):
    """Runs a command to its end and returns it with its output as text."""
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=timeout,
                          stdin=subprocess.DEVNULL, check=False)


def wait_until_caught(process, stop):
    """Waits until a process has a handler for a signal, according to the kernel, or has ended."""
    while process.poll() is None:
        status = pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="utf-8")
        if int(re.search(r"SigCgt:\s*(\w+)", status).group(1), 16) >> (stop - 1) & 1:
            return
        time.sleep(0.01)


class Server:
    """A tile server on a free port of the loopback address, for a `with` block. `words` are more of its options."""

    def __init__(self, maps, *words, scheme="http"):
        self.words, self.scheme = ["--maps", str(maps), *map(str, words)], scheme

    def __enter__(self):
        self.process = subprocess.Popen([SERVER, *self.words, "--listen", "127.0.0.1:0"],
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        line = self.process.stdout.readline()
        self.url = f"{self.scheme}://" + re.search(r"listening on (\S+)", line).group(1)
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGTERM)
        self.process.communicate(timeout=30)


def certificate(folder, name, days=30):
    """A certificate for 127.0.0.1 and its key, signed by itself."""
    files = folder / f"{name}.pem", folder / f"{name}.key"
    done = subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", str(days),
                           "-keyout", files[1], "-out", files[0], "-subj", f"/CN={name}", "-addext", "subjectAltName=IP:127.0.0.1"],
                          capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return files


def rows_of(file):
    with open(file, newline="") as table:
        return list(csv.DictReader(table))


def report_data(page):
    """The data of a report."""
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)[1])


class CommandTest(unittest.TestCase):
    """A test with a temporary folder and checks of the output of commands."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def expect_done(self, result):
        self.assertEqual(result.returncode, 0, result.stderr)

    def expect_teaches(self, result, *parts):
        """A help text that contains each part, and none of the parser's own terms for types and ranges."""
        self.expect_done(result)
        self.assertNotRegex(result.stdout, r"\b(U?INT|FLOAT|TEXT|BOOLEAN)\b| in [\[{]|\de[+-]\d")
        for part in parts:
            self.assertIn(part, result.stdout)

    def expect_refused(self, result, code, *parts):
        """The command ended with `code` and one line on standard error that contains each part."""
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        for part in parts:
            self.assertIn(part, result.stderr)

    def copy_of(self, drive, name="drive"):
        folder = self.folder / name
        shutil.copytree(drive, folder)
        return folder

    def build(self, drive, map_file, *words):
        return run(MAPPER, "build", "--drive", drive, "--map", map_file, *words)


def edit_json(file, change):
    content = json.loads(file.read_text())
    change(content)
    file.write_text(json.dumps(content))


def edit_lines(file, change):
    lines = file.read_text().splitlines()
    change(lines)
    file.write_text("\n".join(lines) + "\n")


def main():
    sys.exit(unittest.main(verbosity=2))
