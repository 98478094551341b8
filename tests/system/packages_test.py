"""The Debian packages that CPack makes of this build: what is in them, and what they tell dpkg."""
import gzip
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import commands
from commands import CommandTest, MAPPER, run

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("MILEPOST_BUILD", ""))
PROGRAMS = {"milepost-mapper", "milepost-server", "milepost-client", "milepost-simulator"}
NAMES = PROGRAMS | {"libmilepost0", "libmilepost-dev", "milepost-doc"}
PACKAGES = {}  # by name, once they are made
MULTI_ARCH = {"libmilepost0": "same", "libmilepost-dev": "same", "milepost-doc": "foreign"}


class Package:
    """A package, extracted: `tree` is what it installs, `control` the folder of its control files."""

    def __init__(self, file, folder):
        self.file = file
        self.fields = dict(re.findall(r"^([\w-]+): (.*)$", run("dpkg-deb", "--field", file).stdout, re.MULTILINE))
        self.name = self.fields["Package"]
        self.tree, self.control = folder / self.name, folder / f"{self.name}.control"
        for way, place in (("--extract", self.tree), ("--control", self.control)):
            place.mkdir(parents=True)
            subprocess.run(["dpkg-deb", way, file, place], check=True)
        self.files = {str(path.relative_to(self.tree)) for path in self.tree.rglob("*") if path.is_symlink() or path.is_file()}

    def control_file(self, name):
        return (self.control / name).read_text()


def setUpModule():
    for tool in ("dpkg-deb", "dpkg-shlibdeps", "file"):
        if not shutil.which(tool):
            raise unittest.SkipTest(f"there is no {tool}, without which CPack makes no packages")
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    out = pathlib.Path(folder.name)
    made = run("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", out / "made", "-D", "CPACK_MILEPOST_COMPRESSION=none")
    if made.returncode != 0:
        raise AssertionError(made.stdout + made.stderr)
    for file in (out / "made").glob("*.deb"):
        package = Package(file, out / "extracted")
        PACKAGES[package.name] = package


class PackagesTest(CommandTest):
    def test_each_file_that_is_installed_is_in_exactly_one_package(self):
        self.assertEqual(set(PACKAGES), NAMES)
        packed = [file for package in PACKAGES.values() for file in package.files]
        self.assertEqual(len(packed), len(set(packed)), "files are in two packages")
        self.expect_done(run("cmake", "--install", BUILD, "--prefix", self.folder / "usr"))
        installed = {str(path.relative_to(self.folder)) for path in self.folder.rglob("*") if not path.is_dir()}
        self.assertGreater(len(installed), 30)
        self.assertEqual(installed - set(packed), set(), "are installed, but in no package")

    def test_files_are_where_debian_has_them(self):
        for program in PROGRAMS:
            self.assertIn(f"usr/bin/{program}", PACKAGES[program].files)
            self.assertIn(f"usr/share/man/man1/{program}.1.gz", PACKAGES[program].files)
        libraries = "usr/lib/" + run("dpkg-architecture", "-qDEB_HOST_MULTIARCH").stdout.strip()
        self.assertIn(f"{libraries}/libmilepost.so.0", PACKAGES["libmilepost0"].files)
        development = PACKAGES["libmilepost-dev"].files
        for file in ("libmilepost.so", "libmilepost.a", "pkgconfig/milepost.pc", "cmake/milepost/milepost-config.cmake"):
            self.assertIn(f"{libraries}/{file}", development)
        headers = {f"usr/include/milepost/{path.name}" for path in (ROOT / "client/include/milepost").glob("*.h")}
        self.assertEqual({file for file in development if file.endswith(".h")}, headers)
        documents = {path.name for path in (ROOT / "schema").iterdir() if path.suffix in (".md", ".fbs", ".sql", ".yaml")}
        folder = "usr/share/doc/milepost/"
        self.assertEqual({file for file in PACKAGES["milepost-doc"].files if file.startswith(folder)},
                         {folder + name for name in documents})
        for example in ("nginx-front.conf", "nginx-static.conf", "grafana/milepost-server.json"):
            self.assertIn(f"usr/share/doc/milepost-server/examples/{example}", PACKAGES["milepost-server"].files)

    def test_the_version_is_that_of_the_changelog_and_of_the_programs(self):
        changelog = run("dpkg-parsechangelog", "-l", ROOT / "deploy/debian/changelog", "-S", "Version").stdout.strip()
        self.assertEqual(run(MAPPER, "--version").stdout, f"milepost-mapper {changelog.split('-')[0]}\n")
        for package in PACKAGES.values():
            self.assertEqual(package.fields["Version"], changelog)
            self.assertEqual(package.file.name, f"{package.name}_{changelog}_{package.fields['Architecture']}.deb")

    def test_the_fields_are_those_of_debian(self):
        architecture = run("dpkg", "--print-architecture").stdout.strip()
        for name, package in PACKAGES.items():
            fields = package.fields
            self.assertEqual(fields["Architecture"], "all" if name == "milepost-doc" else architecture)
            self.assertEqual(fields.get("Multi-Arch"), MULTI_ARCH.get(name), name)
            self.assertEqual((fields["Source"], fields["Priority"]), ("milepost", "optional"))
            self.assertRegex(fields["Maintainer"], r"^[\w ]+ <\S+@\S+>$")
            self.assertIn(fields["Section"], ("science", "net", "libs", "libdevel", "doc"))
            self.assertRegex(fields["Description"], r"^[a-zH].{20,60}[^.]$")
            self.assertIn("\n milepost localizes", run("dpkg-deb", "--field", package.file, "Description").stdout)

    def test_what_a_package_needs_is_what_its_files_link(self):
        for name in PROGRAMS | {"libmilepost0"}:
            self.assertIn("libc6 ", PACKAGES[name].fields["Depends"])
            self.assertIn("libopencv-core" if name != "milepost-server" else "libsqlite3-0", PACKAGES[name].fields["Depends"])
        self.assertNotIn("opencv", PACKAGES["milepost-server"].fields["Depends"])
        version = PACKAGES["libmilepost0"].fields["Version"]
        self.assertEqual(PACKAGES["libmilepost-dev"].fields["Depends"], f"libmilepost0 (= {version})")
        self.assertNotIn("Depends", PACKAGES["milepost-doc"].fields)
        self.assertEqual(PACKAGES["libmilepost0"].control_file("shlibs"), f"libmilepost 0 libmilepost0 (>= {version})\n")
        self.assertIn("activate-noawait ldconfig", PACKAGES["libmilepost0"].control_file("triggers"))

    def test_settings_are_conffiles_and_digests_are_right(self):
        for package in PACKAGES.values():
            settings = {"/" + file for file in package.files if file.startswith("etc/")}
            has_conffiles = (package.control / "conffiles").exists()
            self.assertEqual(set(package.control_file("conffiles").split()) if has_conffiles else set(), settings)
            digests = package.control_file("md5sums")
            regular = {file for file in package.files if not (package.tree / file).is_symlink()}
            self.assertEqual({line.split(maxsplit=1)[1] for line in digests.splitlines()}, regular)
            checked = subprocess.run(["md5sum", "--check", "--quiet", package.control / "md5sums"], cwd=package.tree,
                                     capture_output=True, text=True, check=False)
            self.assertEqual((checked.returncode, checked.stdout), (0, ""))
        self.assertEqual(PACKAGES["milepost-server"].control_file("conffiles"), "/etc/milepost/server.toml\n")

    def test_owners_and_permissions(self):
        for package in PACKAGES.values():
            for line in run("dpkg-deb", "--contents", package.file).stdout.splitlines():
                mode, owner, *_, path = line.split(" -> ")[0].split()
                self.assertEqual(owner, "root/root", line)
                runs = mode.startswith("d") or path.startswith("./usr/bin/")
                self.assertEqual(mode[1:], "rwxrwxrwx" if mode[0] == "l" else "rwxr-xr-x" if runs else "rw-r--r--", line)
            for script in package.control.glob("p*[mt]"):
                self.assertEqual(script.stat().st_mode & 0o777, 0o755, script)
        scripts = {path.name for path in PACKAGES["milepost-server"].control.iterdir()}
        self.assertEqual(scripts, {"control", "md5sums", "conffiles", "postinst", "prerm", "postrm"})
        self.assertEqual({path.name for path in PACKAGES["libmilepost0"].control.iterdir()},
                         {"control", "md5sums", "shlibs", "triggers"})

    def test_the_programs_are_stripped_and_look_for_no_library_of_the_build(self):
        binaries = [PACKAGES[name].tree / "usr/bin" / name for name in PROGRAMS]
        binaries += PACKAGES["libmilepost0"].tree.rglob("libmilepost.so.0")
        self.assertEqual(len(binaries), len(PROGRAMS) + 1)
        for binary in binaries:
            self.assertRegex(run("file", "--dereference", binary).stdout, r", stripped$")
            self.assertNotRegex(run("readelf", "-d", binary).stdout, r"R(UN)?PATH")

    def test_licences_and_changelogs(self):
        licences = [ROOT / "server/viewer/leaflet-licence.txt", ROOT / "schema/page/chart.js-licence.txt"]
        for name, package in PACKAGES.items():
            documents = package.tree / "usr/share/doc" / name
            text = (documents / "copyright").read_text()
            self.assertTrue(text.startswith("Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n"))
            for part in ("Leaflet", "Chart.js Contributors", "/usr/share/common-licenses/Apache-2.0"):
                self.assertIn(part, text)
            self.assertEqual([line for line in text.splitlines() if not line.strip()], [""] * text.count("\n\n"))
            words = " ".join(text.replace("\n .\n", "\n").split())
            for licence in licences:
                self.assertIn(" ".join(licence.read_text().split()), words)
            self.assertEqual(gzip.decompress((documents / "changelog.gz").read_bytes()), (ROOT / "CHANGELOG.md").read_bytes())
            self.assertEqual(gzip.decompress((documents / "changelog.Debian.gz").read_bytes()),
                             (ROOT / "deploy/debian/changelog").read_bytes())

    def test_the_manual_page_tells_the_help_of_every_command(self):
        page = gzip.decompress((PACKAGES["milepost-server"].tree / "usr/share/man/man1/milepost-server.1.gz").read_bytes()).decode()
        self.assertIn("\nmilepost-server \\- serves the maps of a directory over HTTP\n", page)
        for command in ("INSTALL", "ROLLBACK", "PUBLISH", "KEYGEN", "SIGN"):
            self.assertIn(f"\n.SH MILEPOST-SERVER {command}\n", page)
        self.assertIn("default one a core", page)

    def test_the_units_are_sound_with_the_files_of_the_package(self):
        server = PACKAGES["milepost-server"]
        units = self.folder / "units"
        shutil.copytree(server.tree / "usr/lib/systemd/system", units)
        self.assertEqual({unit.name for unit in units.iterdir()}, {"milepost-server.service", "milepost-server.socket"})
        service = units / "milepost-server.service"
        text = service.read_text()
        for file in re.findall(r"(/usr/bin/milepost\S+|/etc/milepost\S+)", text):
            self.assertIn(file[1:], server.files)
        for file in re.findall(r"file:///(\S+)", text):
            self.assertIn(file, PACKAGES["milepost-doc"].files)
        service.write_text(text.replace("/usr/bin/", f"{server.tree}/usr/bin/"))
        verified = run("systemd-analyze", "verify", "--man=no", service)
        self.assertEqual((verified.returncode, verified.stderr), (0, ""))


class ServiceScriptsTest(CommandTest):
    """The scripts of milepost-server, as dpkg runs them for another root, with a program that notes what is asked."""

    def setUp(self):
        super().setUp()
        self.root, tools, self.asked = self.folder / "root", self.folder / "tools", self.folder / "asked"
        self.root.mkdir()
        tools.mkdir()
        helper = tools / "deb-systemd-helper"
        helper.write_text(f'#!/bin/sh\necho "$*" >>{self.asked}\n[ "$2" != was-enabled ] || exit "$WAS_ENABLED"\n')
        helper.chmod(0o755)
        self.path = f"{tools}:{os.environ['PATH']}"

    def run_script(self, name, *words, was_enabled=True):
        """What the script asks deb-systemd-helper to do."""
        self.asked.write_text("")
        environment = {"PATH": self.path, "DPKG_ROOT": str(self.root), "WAS_ENABLED": "0" if was_enabled else "1"}
        done = subprocess.run([PACKAGES["milepost-server"].control / name, *words], env=environment, capture_output=True,
                              text=True, timeout=60, check=False)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
        return [line for line in self.asked.read_text().splitlines() if "was-enabled" not in line]

    def test_installing_makes_the_directory_and_enables_the_units(self):
        asked = self.run_script("postinst", "configure", "")
        self.assertEqual(asked, ["enable milepost-server.socket", "enable milepost-server.service"])
        self.assertEqual((self.root / "srv/milepost").stat().st_mode & 0o777, 0o755)

    def test_units_that_were_disabled_stay_so(self):
        asked = self.run_script("postinst", "configure", "0.0.9", was_enabled=False)
        self.assertEqual(asked, ["update-state milepost-server.socket", "update-state milepost-server.service"])

    def test_a_directory_of_the_operator_is_left_as_it_is(self):
        maps = self.root / "srv/milepost"
        maps.mkdir(parents=True, mode=0o750)
        self.run_script("postinst", "configure", "")
        self.assertEqual(maps.stat().st_mode & 0o777, 0o750)

    def test_maps_outlive_a_purge_and_an_empty_directory_does_not(self):
        maps = self.root / "srv/milepost"
        self.run_script("postinst", "configure", "")
        (maps / "town.map").write_text("a map")
        self.assertEqual(self.run_script("prerm", "remove"), [])
        self.assertEqual(self.run_script("postrm", "remove"), [])
        asked = self.run_script("postrm", "purge")
        self.assertEqual(asked, ["purge milepost-server.socket", "purge milepost-server.service"])
        self.assertEqual((maps / "town.map").read_text(), "a map")
        (maps / "town.map").unlink()
        self.run_script("postrm", "remove")
        self.assertTrue(maps.is_dir())
        self.run_script("postrm", "purge")
        self.assertFalse(maps.exists())


if __name__ == "__main__":
    commands.main()
