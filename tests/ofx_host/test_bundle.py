# SPDX-License-Identifier: Apache-2.0
"""The bundle as it is installed: its shape, what it exports, what it asks of a system; moved, and without its tables."""

import os
import plistlib
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

BIN = Path(os.environ["METAMER_BIN"])
BUILD = BIN.parent
# The C library and its kin, in every system that the plug-in can be loaded in.
ALLOWED = {"linux-vdso.so.1", "libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0", "ld-linux-x86-64.so.2"}
ENTRY_POINTS = {"OfxGetNumberOfPlugins", "OfxGetPlugin", "OfxSetHost"}


def output(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=True).stdout


class Bundle(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        output("cmake", "--install", BUILD, "--component", "ofx", "--prefix", cls.folder / "prefix")
        cls.bundle = cls.folder / "prefix/OFX/metamer.ofx.bundle"
        cls.library = cls.bundle / "Contents/Linux-x86-64/metamer.ofx"

    def render(self, plugins, *settings):
        """Runs the plug-in in the HostSupport host: exit code and what the effect said."""
        picture = self.folder / "in.f32"
        picture.write_bytes(bytes(16))
        words = [BIN / "metamer_ofx_render", plugins, "org.metamer.SpectralTransfer", 1, 1, picture, self.folder / "out.f32"]
        for setting in settings:
            words += ["--set", setting]
        environment = {key: value for key, value in os.environ.items() if key != "METAMER_DATA"}
        run = subprocess.run([str(w) for w in words], capture_output=True, text=True, env=environment)
        return run.returncode, run.stderr

    def test_has_the_shape_that_hosts_look_for(self):
        self.assertTrue(self.library.is_file())
        self.assertTrue((self.bundle / "Contents/Resources/data/manifest.json").is_file())
        facts = plistlib.loads((self.bundle / "Contents/Info.plist").read_bytes())
        version = re.search(r"^project\(metamer VERSION ([0-9.]+)", Path("CMakeLists.txt").read_text(), re.MULTILINE)[1]
        self.assertEqual((facts["CFBundleExecutable"], facts["CFBundlePackageType"]), (self.library.name, "BNDL"))
        self.assertEqual(facts["CFBundleVersion"], version)
        self.assertFalse(any(path.is_symlink() for path in self.bundle.rglob("*")))

    def test_exports_the_entry_points_alone(self):
        symbols = {line.split()[-1] for line in output("nm", "-D", "--defined-only", self.library).splitlines()}
        self.assertEqual(symbols, ENTRY_POINTS)

    def test_asks_for_nothing_but_the_c_library(self):
        needed = {Path(line.split()[0]).name for line in output("ldd", self.library).splitlines()}
        self.assertLessEqual(needed, ALLOWED)

    def test_a_host_finds_both_effects(self):
        found = output(BIN / "metamer_ofx_render", self.bundle.parent, "list").split()
        self.assertEqual(found, ["org.metamer.SpectralTransfer", "org.metamer.LEDStage", "org.metamer.Skin"])

    def test_works_from_any_folder_with_its_own_tables(self):
        elsewhere = self.folder / "some other place" / "OFX Plugins"
        shutil.copytree(self.bundle, elsewhere / self.bundle.name)
        self.assertEqual(self.render(elsewhere, "outputIlluminant=HP1"), (0, ""))

    def test_without_its_tables_it_says_so_and_passes_the_picture_through(self):
        broken = self.folder / "broken"
        shutil.copytree(self.bundle, broken / self.bundle.name)
        shutil.rmtree(broken / self.bundle.name / "Contents/Resources/data")
        code, message = self.render(broken)
        self.assertEqual(code, 0)
        self.assertIn("install the whole bundle again", message)


if __name__ == "__main__":
    unittest.main()
