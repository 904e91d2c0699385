# SPDX-License-Identifier: Apache-2.0
"""The bundle for Linux's older systems: what it exports and asks of them; OpenFX hosts' whole test suite, and pictures that are the
native build's bit for bit.

script/cross runs it: METAMER_BUNDLE is the bundle, METAMER_LINUX_BIN the folder of the native build's programs.
"""

import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import frames

BUNDLE = Path(os.environ["METAMER_BUNDLE"])
NATIVE = Path(os.environ["METAMER_LINUX_BIN"])
LIBRARY = "Contents/Linux-x86-64/metamer.ofx"
ENTRY_POINTS = {"OfxGetNumberOfPlugins", "OfxGetPlugin", "OfxSetHost"}
# The C library and its kin, in every system that the plug-in can be loaded in.
ALLOWED = {"libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0", "ld-linux-x86-64.so.2"}
GLIBC = (2, 28)


class Linux(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)

    def test_has_the_shape_that_hosts_look_for(self):
        native = NATIVE.parent / "OFX" / BUNDLE.name
        names = {path.relative_to(BUNDLE).as_posix() for path in BUNDLE.rglob("*") if path.is_file()}
        self.assertLessEqual({LIBRARY, "Contents/Info.plist", "Contents/Resources/LICENSE", "Contents/Resources/data/manifest.json"},
                             names)
        self.assertEqual((BUNDLE / "Contents/Info.plist").read_bytes(), (native / "Contents/Info.plist").read_bytes())
        self.assertFalse(any(path.is_symlink() for path in BUNDLE.rglob("*")))

    def test_exports_the_entry_points_alone(self):
        symbols = {line.split()[-1] for line in frames.output("nm", "-D", "--defined-only", BUNDLE / LIBRARY).splitlines()}
        self.assertEqual(symbols, ENTRY_POINTS)

    def test_asks_for_nothing_but_an_old_c_library(self):
        told = frames.output("readelf", "--dynamic", "--version-info", "--wide", BUNDLE / LIBRARY)
        self.assertLessEqual(set(re.findall(r"\(NEEDED\).*\[(.*)\]", told)), ALLOWED)
        versions = {tuple(map(int, number.split("."))) for number in re.findall(r"Name: GLIBC_([0-9.]+)", told)}
        self.assertLess((2, 2), max(versions))
        self.assertLessEqual(max(versions), GLIBC)
        self.assertEqual(re.findall(r"Name: (?!GLIBC_[0-9.]+ )(\S+)", told), [])

    def test_passes_the_suite_of_hosts(self):
        frames.assert_passes(self, subprocess.run([NATIVE / "ofx_host_tests"], capture_output=True, text=True, cwd=self.folder,
                                                  env=frames.environment(BUNDLE / LIBRARY)))

    def test_renders_what_the_native_build_renders_bit_for_bit(self):
        pictures = []
        for system, bundle in (("native", NATIVE.parent / "OFX" / BUNDLE.name), ("older", BUNDLE)):
            pictures.append(frames.jobs(self.folder, system))
            run = subprocess.run([NATIVE / "metamer_ofx_frames", f"{system}.txt"], cwd=self.folder, capture_output=True, text=True,
                                 env=frames.environment(bundle / LIBRARY))
            self.assertEqual(run.returncode, 0, run.stderr)
        frames.assert_same(self, self.folder, "native", *pictures)


if __name__ == "__main__":
    unittest.main()
