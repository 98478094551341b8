"""The cache of stages: nothing is done twice, nothing out of date or half done is taken for a result."""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from laboratory.errors import LabError
from laboratory.stages import PARTIAL, Cache, Stage

# Notes each call in a file, and writes what it read.
PROGRAM = """#!/bin/sh
echo called >>"$1"
cat "$2" >"$3/answer"
[ "$4" != fail ] || { echo "input.txt, line 3: is wrong; mend it" >&2; exit 1; }
[ "$4" != meddle ] || echo "# other" >>"$0"
[ "$4" != sleep ] || exec sleep 60
"""


class Stages(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.program = self.folder / "program"
        self.program.write_text(PROGRAM)
        self.program.chmod(0o755)
        self.input = self.folder / "input.txt"
        self.input.write_text("one")
        self.calls_file = self.folder / "calls"

    def stage(self, setting="go", inputs=None, needs=()):
        inputs = inputs or (lambda: [self.input])
        return Stage("kind", "name", self.program, (setting,),
                     lambda out, threads: [self.calls_file, inputs()[0], out, setting], inputs, needs)

    def run_stages(self, *stages, jobs=2):
        with Cache(self.folder / "cache", jobs).opened() as cache:
            cache.run(stages)
        return stages[-1]

    def calls(self):
        return len(self.calls_file.read_text().splitlines()) if self.calls_file.exists() else 0

    def results(self):
        return [each for each in (self.folder / "cache").glob("*") if each.is_dir()]

    def test_unchanged_inputs_are_not_run_again(self):
        first = self.run_stages(self.stage())
        second = self.run_stages(self.stage())
        self.assertEqual(self.calls(), 1)
        self.assertEqual((first.cached, second.cached), (False, True))
        self.assertEqual(first.result, second.result)
        self.assertEqual((second.result / "answer").read_text(), "one")

    def test_a_changed_input_is_run_again(self):
        self.run_stages(self.stage())
        self.input.write_text("two")
        self.assertEqual((self.run_stages(self.stage()).result / "answer").read_text(), "two")
        self.input.write_text("one")
        self.assertEqual((self.run_stages(self.stage()).result / "answer").read_text(), "one")
        self.assertEqual(self.calls(), 2)

    def test_a_changed_setting_or_program_is_run_again(self):
        self.run_stages(self.stage())
        self.run_stages(self.stage("other"))
        self.program.write_text(PROGRAM + "true\n")
        self.run_stages(self.stage())
        self.assertEqual(self.calls(), 3)

    def test_a_file_that_moved_to_another_name_is_another_input(self):
        drive = self.folder / "drive"
        drive.mkdir()
        (drive / "a").write_text("x")
        before = Cache(self.folder / "cache", 1).digest(drive)
        (drive / "a").rename(drive / "b")
        self.assertNotEqual(Cache(self.folder / "cache", 1).digest(drive), before)

    def test_a_need_is_done_before_and_shared(self):
        need = self.stage("need")
        after = [self.stage(name, lambda: [need.result / "answer"], (need,)) for name in ("x", "y")]
        self.run_stages(*after)
        self.assertEqual(self.calls(), 3)
        self.assertEqual((after[1].result / "answer").read_text(), "one")

    def test_a_failed_stage_says_its_last_line_and_leaves_no_result(self):
        with self.assertRaisesRegex(LabError, "kind name: input.txt, line 3: is wrong; mend it"):
            self.run_stages(self.stage("fail"))
        self.assertEqual([each.name[:len(PARTIAL)] for each in self.results()], [PARTIAL])
        self.run_stages(self.stage())
        self.assertEqual(len(self.results()), 1)  # what the failed one left is gone

    def test_a_program_that_is_built_anew_meanwhile_has_no_result(self):
        with self.assertRaisesRegex(LabError, "kind name: .*changed while it ran"):
            self.run_stages(self.stage("meddle"))
        self.assertEqual([each.name[:len(PARTIAL)] for each in self.results()], [PARTIAL])

    def test_a_killed_run_leaves_no_result_and_the_next_goes_on(self):
        code = ("from stages_test import Stages\n"
                "import pathlib\n"
                "test = Stages(); test.folder = pathlib.Path(%r)\n"
                "files = (test.folder / name for name in ('program', 'input.txt', 'calls'))\n"
                "test.program, test.input, test.calls_file = files\n"
                "test.run_stages(test.stage(), test.stage('sleep'), jobs=1)\n" % str(self.folder))
        run = subprocess.Popen([sys.executable, "-B", "-c", code], cwd=pathlib.Path(__file__).parent,
                               start_new_session=True)
        deadline = time.monotonic() + 30
        while self.calls() < 2 and time.monotonic() < deadline:
            time.sleep(0.02)
        self.assertEqual(self.calls(), 2)  # the first is done, the second at work
        os.killpg(run.pid, signal.SIGKILL)
        run.wait()
        self.run_stages(self.stage())
        self.assertEqual(self.calls(), 2)  # the first is still there
        self.program.write_text(PROGRAM.replace("exec sleep 60", "true"))
        self.assertFalse(self.run_stages(self.stage("sleep")).cached)

    def test_two_runs_do_not_share_a_cache(self):
        with Cache(self.folder / "cache", 1).opened():
            with self.assertRaisesRegex(LabError, "another run"):
                self.run_stages(self.stage())


if __name__ == "__main__":
    unittest.main(verbosity=2)
