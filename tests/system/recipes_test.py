"""The recipes of PROTOCOL.md, its blocks of shell commands, run as they are and do what they promise.

A recipe runs in a folder with maps/town.map, a map of a drive `monday`. What is promised is in its comments:
  COMMAND    # the same     its first word is that of the output before
  COMMAND    # WORDS        it prints these words
  # {JSON}                  on a line of its own: the command before prints this, but for its numbers, its digests
                            (0f6b...) and what the sign for an omission stands for
All else after a # is for the reader. The port of the server is exchanged for a free one.
"""
import filecmp
import json
import os
import pathlib
import re
import subprocess

import commands
from commands import CommandTest, MAPPER, SERVER, STREET, main, run
from static_stores import free_port

PROTOCOL = pathlib.Path(__file__).resolve().parents[2] / "schema" / "PROTOCOL.md"
PLACE = {"latitude_deg": 49.0106, "longitude_deg": 8.4011}  # of the drive, so that it passes where the recipes ask
MARK = "-- command "
OMISSION = "\u2026"


def recipes():
    return re.findall(r"^```sh\n(.*?)^```$", PROTOCOL.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)


class Command:
    """One command of a recipe, and what it promises to print."""

    def __init__(self, text):
        self.text = text
        comment = re.search(r"(?<=\s)# ([^'\"]*)$", text)
        self.promise = comment[1] if comment else None
        self.form = None

    def check(self, test, printed, before):
        if self.form:
            test.assertRegex(printed, pattern_of(self.form))
        if self.promise == "the same":
            test.assertEqual(printed.split()[0], before.split()[0])
        elif self.promise:
            test.assertEqual(printed.strip(), self.promise)


def pattern_of(form):
    pattern = re.sub("[0-9a-f]{4}" + OMISSION, "[0-9a-f]{32}", re.escape(form)).replace(OMISSION, ".*")
    return "^" + re.sub(r'(?<=":)\d+(\\\.\d+)?', r"[0-9.e+-]+", pattern) + "\n?$"


def commands_of(recipe):
    """Its commands; one may have several lines, which end in a backslash."""
    found = []
    for line in recipe.replace("\\\n", "\0").splitlines():
        if line.startswith(("# {", "# [")):
            found[-1].form = line[2:]
        elif line and not line.startswith("#"):
            found.append(Command(line.replace("\0", "\\\n")))
    return found


class Recipes(CommandTest):
    def setUp(self):
        super().setUp()
        drive = self.copy_of(STREET / "street-map", "monday")
        commands.edit_json(drive / "drive.json", lambda drive: (drive.update(name="monday"), drive["origin"].update(PLACE)))
        maps, self.programs = self.folder / "maps", self.folder / "programs"
        maps.mkdir()
        self.expect_done(self.build(drive, maps / "town.map"))
        self.programs.mkdir()
        # What the server prints is not among what the recipe prints.
        self.program("milepost-server", f'case $* in *--listen*) exec "{SERVER}" "$@" >server.out 2>server.err ;; esac\n'
                                        f'exec "{SERVER}" "$@"')
        self.program("milepost-mapper", f'exec "{MAPPER}" "$@"')

    def program(self, name, text):
        file = self.programs / name
        file.write_text(f"#!/bin/sh\n{text}\n")
        file.chmod(0o755)

    def printed_by(self, steps):
        """What each of the commands prints, which all succeed without a word on standard error."""
        script = ["trap 'kill $(jobs -p) 2>/dev/null || true' EXIT"]
        for number, step in enumerate(steps):
            script += [f"echo; echo '{MARK}{number}'", step.text]
            if step.text.rstrip().endswith("&"):  # a reader takes longer than a server to start
                script.append("for i in $(seq 100); do grep -q listening server.out 2>/dev/null && break; sleep 0.1; done")
        text = "\n".join(script).replace(":8080", f":{free_port()}") + "\n"
        (self.folder / "rclone.conf").write_text("")
        environment = {**os.environ, "PATH": f"{self.programs}:{os.environ['PATH']}", "LC_ALL": "C.UTF-8",
                       # The store of the recipes is a folder here.
                       "RCLONE_CONFIG": str(self.folder / "rclone.conf"), "RCLONE_CONFIG_STORE_TYPE": "alias",
                       "RCLONE_CONFIG_STORE_REMOTE": str(self.folder / "store")}
        result = subprocess.run(["bash", "-eu", "-o", "pipefail", "-c", text], cwd=self.folder, env=environment, timeout=120,
                                stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
        printed = re.split(rf"\n{MARK}\d+\n", result.stdout)[1:]
        self.assertEqual(len(printed), len(steps))
        return printed

    def test_each_recipe_does_what_it_says(self):
        self.assertGreaterEqual(len(recipes()), 2)
        for number, recipe in enumerate(recipes()):
            with self.subTest(number=number, recipe=recipe[:80]):
                before = ""
                steps = commands_of(recipe)
                for step, printed in zip(steps, self.printed_by(steps)):
                    with self.subTest(command=step.text):
                        step.check(self, printed, before)
                    before = printed if printed.strip() else before

    def test_the_example_promises_much(self):
        steps = commands_of(recipes()[-1])
        self.assertEqual([step.promise for step in steps if step.promise], ["the same"] * 4 + ["304"])
        self.assertEqual(len([step for step in steps if step.form]), 1)

    def test_a_bucket_has_the_whole_tree(self):
        recipe, = [recipe for recipe in recipes() if "rclone" in recipe]
        self.expect_done(run(SERVER, "keygen", "--out", self.folder / "key"))
        self.expect_done(run(SERVER, "sign", "--maps", self.folder / "maps", "--key", self.folder / "key"))
        self.expect_done(run(MAPPER, "aerial", "--map", self.folder / "maps" / "yard.map", "--footprints", self.footprint()))
        self.printed_by(commands_of(recipe))
        tree, bucket = self.folder / "tree", self.folder / "store" / "bucket"
        files = sorted(str(file.relative_to(tree)) for file in tree.rglob("*") if file.is_file())
        self.assertEqual(sorted(str(file.relative_to(bucket)) for file in bucket.rglob("*") if file.is_file()),
                         [file for file in files if file != "headers.json"])
        for name in ("manifest", "manifest.sig", "map", "mapping", "segments", "tracklets", "walls"):
            self.assertTrue(any(f"/{name}" in file for file in files), name)
        for file in files[1:]:
            self.assertTrue(filecmp.cmp(tree / file, bucket / file, shallow=False), file)

    def footprint(self):
        file = self.folder / "yard.geojson"
        corners = [[8.4, 49.0], [8.4001, 49.0], [8.4001, 49.0001], [8.4, 49.0001], [8.4, 49.0]]
        file.write_text(json.dumps({"type": "Polygon", "coordinates": [corners]}))
        return file


if __name__ == "__main__":
    main()
