"""Cached stages: a command's result, kept under a digest of everything that it depends on.

A stage runs a command that fills a folder. The folder's name holds the digest of the program's bytes,
of the files that it reads and of its settings, so whatever changes makes another folder and nothing is
ever out of date. The command writes into a partial folder, which is renamed once all is done: a stage
that was killed has no result.
"""
import concurrent.futures
import contextlib
import dataclasses
import fcntl
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import time
import typing

from .errors import LabError

RECORD = "stage.json"  # in each result: the command, and the seconds it took
LOG = "stage.log"
PARTIAL = ".partial-"


def digest_of_files(path):
    """Digest of a file's bytes, or of the names and bytes of all files below a folder."""
    path = pathlib.Path(path)
    files = [path] if path.is_file() else sorted(each for each in path.rglob("*") if each.is_file())
    whole = hashlib.blake2b(digest_size=16)
    for file in files:
        if file.name in (RECORD, LOG):
            continue
        name = str(file.relative_to(path)) if file != path else ""
        whole.update(f"{name}\0{file.stat().st_size}\0".encode())
        whole.update(hashlib.blake2b(file.read_bytes()).digest())
    return whole.hexdigest()


@dataclasses.dataclass(eq=False)
class Stage:
    """One command to run. Equal digests of inputs and settings mean equal results."""

    kind: str  # "map", "evaluate", ...: what the timing table adds up
    name: str
    program: pathlib.Path
    settings: tuple[str, ...]  # the options that change the result
    # (folder to fill, threads to use) -> the arguments after the program
    arguments: typing.Callable[[pathlib.Path, int], list]
    inputs: typing.Callable[[], list] = list  # files and folders read; asked for once `needs` are done
    needs: tuple["Stage", ...] = ()
    result: pathlib.Path | None = None  # the folder, once the stage is done
    seconds: float = 0  # of processors, when it ran
    cached: bool = False


class Cache:
    """The folder of results. One laboratory at a time uses it."""

    def __init__(self, folder, jobs, say=lambda text: None):
        self.folder = pathlib.Path(folder)
        self.jobs = jobs
        self.say = say
        self.digests = {}
        self.running = set()
        self.stopped = False

    @contextlib.contextmanager
    def opened(self):
        """Holds the cache for this run; what a killed run left half done is removed."""
        self.folder.mkdir(parents=True, exist_ok=True)
        with (self.folder / "lock").open("w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise LabError(f"{self.folder}: another run of the laboratory is using this cache; wait for "
                               "its end or choose another --cache") from None
            for partial in self.folder.glob(PARTIAL + "*"):
                shutil.rmtree(partial)
            yield self

    def run(self, stages):
        """Runs the stages and all they need, on all jobs, each once; earlier ones first."""
        waiting = list(closure(stages))
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            running = {}
            try:
                while waiting or running:
                    ready = [stage for stage in waiting if all(need.result for need in stage.needs)]
                    chosen = ready[:self.jobs - len(running)]
                    for stage in chosen:
                        waiting.remove(stage)
                        threads = max(1, self.jobs // (len(running) + len(chosen)))
                        running[pool.submit(self.complete, stage, threads)] = stage
                    done, _ = concurrent.futures.wait(running, return_when=concurrent.futures.FIRST_COMPLETED)
                    for future in done:
                        running.pop(future)
                        future.result()
            except BaseException:
                self.stop()
                raise

    def complete(self, stage, threads):
        """Finds the stage's result in the cache, or makes it."""
        key = self.key(stage, self.digest)
        folder = self.folder / f"{stage.kind}-{stage.name}-{key}"
        if folder.is_dir():
            stage.cached = True
        else:
            self.make(stage, key, folder, threads)
        stage.seconds = json.loads((folder / RECORD).read_text(encoding="utf-8"))["processor_seconds"]
        stage.result = folder

    def key(self, stage, digest):
        whole = hashlib.blake2b(digest_size=8)
        for part in (stage.kind, *stage.settings, digest(stage.program), *map(digest, stage.inputs())):
            whole.update(f"{len(part)}:{part}".encode())
        return whole.hexdigest()

    def digest(self, path):
        """Of a file or folder as it was when this run first saw it."""
        if path not in self.digests:
            self.digests[path] = digest_of_files(path)
        return self.digests[path]

    def make(self, stage, key, folder, threads):
        partial = pathlib.Path(tempfile.mkdtemp(prefix=PARTIAL, dir=self.folder))
        arguments = [str(word) for word in (stage.program, *stage.arguments(partial, threads))]
        began = time.monotonic()
        processor_seconds = self.call(stage, arguments, partial / LOG)
        if self.key(stage, digest_of_files) != key:
            raise LabError(f"{stage.kind} {stage.name}: the program or what it reads changed while it ran; call again")
        self.say(f"{stage.kind} {stage.name}: {time.monotonic() - began:.0f} s")
        record = {"command": arguments, "processor_seconds": round(processor_seconds, 3)}
        (partial / RECORD).write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
        partial.rename(folder)

    def call(self, stage, arguments, log):
        """Runs the command to its end; returns the processor seconds it took."""
        if self.stopped:
            raise LabError("stopped")
        with log.open("w") as output:
            try:
                process = subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stdout=output, stderr=output)
            except OSError as error:
                raise LabError(f"{arguments[0]}: cannot be run ({error.strerror}); build it anew") from None
        self.running.add(process)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.running.discard(process)
        if process.returncode != 0:
            said = log.read_text(encoding="utf-8", errors="replace").strip().splitlines()
            reason = said[-1] if said else f"exit code {process.returncode}"
            raise LabError(f"{stage.kind} {stage.name}: {reason}")
        return usage.ru_utime + usage.ru_stime

    def stop(self):
        """Ends the commands that run; none is begun any more."""
        self.stopped = True
        for process in list(self.running):
            process.terminate()


def closure(stages):
    """The stages with all that they need, each once, needs before those that need them."""
    seen = {}

    def visit(stage):
        for need in stage.needs:
            visit(need)
        seen.setdefault(stage)

    for stage in stages:
        visit(stage)
    return seen
