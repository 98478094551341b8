"""A fresh Debian 12 in a folder, to try packages in: made by debootstrap from the mirror that this machine uses."""
import os
import pathlib
import shutil
import subprocess

RELEASE = "bookworm"
PASSED_ON = {"http_proxy", "https_proxy", "no_proxy", "HTTP_PROXY", "HTTPS_PROXY", "NO_PROXY"}
CERTIFICATES = pathlib.Path("/usr/local/share/ca-certificates")


class Failure(Exception):
    """What is wrong, in one line."""


def output_of(*words):
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


def mirrors():
    """The lines of sources.list for this machine's mirrors of the release."""
    form = "$(ORIGIN)|$(CODENAME)|deb $(REPO_URI) $(RELEASE) $(COMPONENT)"
    lines = output_of("apt-get", "indextargets", "--format", form, "Created-By: Packages").splitlines()
    known = [line.split("|") for line in lines if line.count("|") == 2]
    found = sorted({source for origin, codename, source in known if origin == "Debian" and codename.startswith(RELEASE)})
    if not any(f" {RELEASE} main" in source for source in found):
        raise Failure(f"apt knows no mirror of {RELEASE}; run this on Debian 12, after apt-get update")
    return found


class DebianRoot:
    """For a `with` block, at whose end nothing is mounted in the folder any more. Output of commands goes to `log`."""

    def __init__(self, folder, log):
        self.folder = folder
        self.log = log
        passed = [f"{name}={value}" for name, value in os.environ.items() if name in PASSED_ON]
        self.enter = ["chroot", str(folder), "env", "-i", "HOME=/root", "LANG=C.UTF-8", "DEBIAN_FRONTEND=noninteractive",
                      "PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", *passed]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.unmount()

    def unmount(self):
        proc = self.folder / "proc"
        if proc.is_mount():
            subprocess.run(["umount", proc], check=True)

    def remove(self):
        self.unmount()
        if self.folder.exists():
            subprocess.run(["rm", "-rf", "--one-file-system", self.folder], check=True)

    def make(self):
        self.remove()
        sources = mirrors()
        main_mirror = next(source for source in sources if f" {RELEASE} main" in source).split()[1]
        secure = any(source.startswith("deb https:") for source in sources)
        self.folder.parent.mkdir(parents=True, exist_ok=True)
        self.logged(["debootstrap", "--variant=minbase", *(["--include=ca-certificates"] if secure else []), RELEASE,
                     str(self.folder), main_mirror])
        (self.folder / "etc/apt/sources.list").write_text("\n".join(sources) + "\n")
        settings = [line for line in output_of("apt-config", "dump").splitlines() if line.startswith("Acquire::")]
        (self.folder / "etc/apt/apt.conf.d/90machine").write_text("\n".join(settings) + "\n")
        for file in ("resolv.conf", "hosts"):
            shutil.copyfile(f"/etc/{file}", self.folder / "etc" / file)
        subprocess.run(["mount", "-t", "proc", "proc", self.folder / "proc"], check=True)
        if secure and CERTIFICATES.is_dir():
            shutil.copytree(CERTIFICATES, self.folder / CERTIFICATES.relative_to("/"), dirs_exist_ok=True)
            self.run("update-ca-certificates")
        self.run("apt-get", "update")

    def logged(self, words, name=None):
        """The standard output of a command, which errors call by `name`."""
        with self.log.open("a") as log:
            print("$", *words, file=log, flush=True)
            done = subprocess.run(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=log, text=True, check=False)
            log.write(done.stdout)
        if done.returncode != 0:
            raise Failure(f"{name or words[0]} exits with {done.returncode}")
        return done.stdout

    def run(self, *words):
        """The standard output of a command in the root."""
        return self.logged([*self.enter, *map(str, words)], words[0])

    def path(self, inside):
        return self.folder / inside.lstrip("/")
