# SPDX-License-Identifier: Apache-2.0
"""test_packages.py TREE: a release's packages of an install tree, with METAMER_LONG=1. The same bytes twice; the archive runs where it is
unpacked; the Debian packages hold what they should, and install, run and go again in a clean system where
debootstrap can make one."""

import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TREE = Path(sys.argv[1])
VERSION = "1.2.3"
SECONDS = "1700000000"
PLUGIN = "/usr/OFX/Plugins/metamer.ofx.bundle/Contents/Linux-x86-64/metamer.ofx"
SYSTEM = f"{os.uname().sysname.lower()}-{os.uname().machine}"


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=1800, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}:\n{done.stdout}{done.stderr}")
    return done.stdout


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = Path(cls.temporary.name)
        # The changelog has no section for a version of tests.
        cls.repository = cls.folder / "repository"
        cls.repository.mkdir()
        for name in ("docs", "data", "README.md"):
            (cls.repository / name).symlink_to(ROOT / name)
        (cls.repository / "CHANGELOG.md").write_text(f"# Changelog\n\n## [{VERSION}]\n\n- This.\n\n## [1.2.2]\n\n- That.\n")
        shutil.copytree(ROOT / "script" / "releases", cls.repository / "script" / "releases")
        cls.out = [cls.folder / name for name in ("first", "second")]
        for out in cls.out:
            run(cls.repository / "script" / "releases" / "pack", TREE, out, VERSION, SECONDS)

    def test_twice_the_same_bytes(self):
        digests = [{file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in out.iterdir()} for out in self.out]
        self.assertGreaterEqual(len(digests[0]), 6)
        self.assertEqual(*digests)

    def file(self, pattern):
        [found] = self.out[0].glob(pattern)
        return found

    def test_the_archive_runs_from_any_folder(self):
        place = self.folder / "any where"
        place.mkdir()
        run("tar", "-xf", self.file(f"metamer-{VERSION}-{SYSTEM}.tar.gz"), "-C", place)
        lutgen = place / f"metamer-{VERSION}-{SYSTEM}" / "bin" / "lutgen"
        shell = {"PATH": os.environ["PATH"], "HOME": "/nonexistent"}
        self.assertIn("HP1", run(lutgen, "list", "illuminants", "sodium", env=shell))
        run(lutgen, "bake", "--illuminant-in", "D65", "--illuminant-out", "A", "-o", place / "a.cube", env=shell)
        self.assertTrue((place / "a.cube.json").exists())

    def test_the_zip_has_the_bundle_and_notes(self):
        with zipfile.ZipFile(self.file("*-ofx-linux.zip")) as archive:
            names = archive.namelist()
            notes = archive.read("INSTALL.txt").decode()
        self.assertIn("metamer.ofx.bundle/Contents/Linux-x86-64/metamer.ofx", names)
        self.assertIn("metamer.ofx.bundle/Contents/Info.plist", names)
        self.assertIn(VERSION, notes)
        for host in ("Resolve", "Nuke", "Baselight", "Flame", "Fusion", "/usr/OFX/Plugins"):
            self.assertIn(host, notes)

    def test_the_parts_are_told(self):
        parts = json.loads(self.file("*.cdx.json").read_text())
        names = {part["name"] for part in parts["components"]}
        self.assertLessEqual({"libeigen3-dev", "libyaml-cpp-dev", "opencolorio", "openimageio", "data/illuminants/cie_hp.csv"}, names)
        self.assertEqual(self.file("*-changes.md").read_text(), f"## [{VERSION}]\n\n- This.\n")

    def test_debian_packages_hold_what_they_should(self):
        tools = run("dpkg-deb", "--contents", self.file("metamer-tools_*.deb"))
        self.assertIn("./usr/bin/lutgen -> /opt/metamer/bin/lutgen", tools)
        self.assertNotIn("/include/", tools)
        self.assertNotIn(".a\n", tools)
        needs = run("dpkg-deb", "--field", self.file("metamer-tools_*.deb"), "Depends")
        for package in ("libc6", "libyaml-cpp0.7", "libembree3"):
            self.assertIn(package, needs)
        plugin = run("dpkg-deb", "--contents", self.file("metamer-ofx_*.deb"))
        self.assertIn("./usr/OFX/Plugins/metamer.ofx.bundle/Contents/Linux-x86-64/metamer.ofx", plugin)
        # It brings its libraries along.
        self.assertRegex(run("dpkg-deb", "--field", self.file("metamer-ofx_*.deb"), "Depends"), r"^libc6 \([^)]*\)$")
        for line in (tools + plugin).splitlines():
            self.assertRegex(line, "root/root")

    @unittest.skipIf(shutil.which("debootstrap") is None or os.geteuid() != 0, "needs debootstrap, and root")
    def test_they_install_run_and_go(self):
        system = self.folder / "system"
        codename = run("bash", "-c", ". /etc/os-release && echo $VERSION_CODENAME").strip()
        mirror = run("bash", "-c", "apt-get indextargets --format '$(SITE)' | head -1").strip()
        run("debootstrap", "--variant=minbase", codename, system, mirror)
        shutil.copy("/etc/resolv.conf", system / "etc" / "resolv.conf")
        for package in self.out[0].glob("*.deb"):
            shutil.copy(package, system / "root" / package.name)
        # /proc is not mounted: programs find their own libraries without it.
        shell = {**os.environ, "DEBIAN_FRONTEND": "noninteractive", "HOME": "/root", "LC_ALL": "C"}
        shell.pop("METAMER_DATA", None)

        def inside(command):
            return run("chroot", system, "bash", "-euc", command, env=shell)

        inside("apt-get install -y -q --no-install-recommends /root/*.deb")
        self.assertIn("HP1", inside("lutgen list illuminants sodium"))
        inside("cd /root && lutgen bake --illuminant-in D65 --illuminant-out A -o a.cube && test -s a.cube.json")
        shutil.copy(ROOT / "demo/files/scene.yaml", system / "root")
        (system / "root/look.yaml").write_text("metamer: 1\ninput: {illuminant: D65}\noutput: {illuminant: A}\n")
        inside("cd /root && spectral_ref render scene.yaml -o scene.exr --spp 4 && "
               "lutgen apply look.yaml scene.exr relit.exr && test -s relit.exr")
        # The plug-in, in a host that renders one frame.
        shutil.copy(Path(os.environ["METAMER_BIN"]) / "metamer_ofx_frames", system / "root")
        (system / "root/jobs.txt").write_text("0\tframe.f32\toutputIlluminant=HP1\n0\tother.f32\toutputIlluminant=A\n")
        inside(f"cd /root && METAMER_OFX_LIBRARY={PLUGIN} ./metamer_ofx_frames jobs.txt")
        frames = [(system / "root" / name).read_bytes() for name in ("frame.f32", "other.f32")]
        self.assertEqual({len(frame) for frame in frames}, {160 * 90 * 16})
        self.assertNotEqual(*frames)
        inside("apt-get remove -y -q metamer-tools metamer-ofx")
        inside("! test -e /opt/metamer && ! test -e /usr/OFX/Plugins/metamer.ofx.bundle && ! test -e /usr/bin/lutgen")


if __name__ == "__main__":
    if os.environ.get("METAMER_LONG") != "1":
        print("METAMER_LONG=1 is not set")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
