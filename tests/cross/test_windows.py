# SPDX-License-Identifier: Apache-2.0
"""The bundle for Windows: what it exports and asks of the system; and, under wine, OpenFX hosts' whole test suite and
pictures that are Linux's bit for bit, from folders and of files named in any script.

script/cross runs it: METAMER_BUNDLE is the bundle, METAMER_BIN the folder of the test programs for Windows, METAMER_LINUX_BIN
that of the build for Linux.
"""

import functools
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import frames

BUNDLE = Path(os.environ["METAMER_BUNDLE"])
WINDOWS = Path(os.environ["METAMER_BIN"])
LINUX = Path(os.environ["METAMER_LINUX_BIN"])
LIBRARY = "Contents/Win64/metamer.ofx"
ENTRY_POINTS = {"OfxGetNumberOfPlugins", "OfxGetPlugin", "OfxSetHost"}
# Of every Windows 10: the kernel and the C runtime that comes with it.
SYSTEM_LIBRARIES = r"(?i)(kernel32|ntdll|advapi32|api-ms-win-crt-[\w-]+)\.dll"
FOLDER = "调色 プラグイン ☀ й é"


def program(*names):
    """Debian keeps wine's programs out of the path."""
    found = [path for name in names if (path := shutil.which(name, path=f"/usr/lib/wine:{os.environ['PATH']}"))]
    if not found:
        raise AssertionError("needs wine: install Debian's package wine64")
    return found[0]


def wine_environment(library, scratch):
    # Names reach wine in the locale's encoding; it makes its folder of settings where it is told.
    return frames.environment(library, WINEDEBUG="-all", WINEPREFIX=str(scratch), WINEDLLOVERRIDES="mscoree,mshtml=", DISPLAY="",
                              WINESERVER=program("wineserver64", "wineserver"))


class Windows(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        cls.bundle = cls.folder / FOLDER / BUNDLE.name
        shutil.copytree(BUNDLE, cls.bundle)
        own = wine_environment(cls.bundle / LIBRARY, cls.folder / "wine")
        # Its server outlives its programs for a while, and writes into the folder.
        cls.addClassCleanup(subprocess.run, [own["WINESERVER"], "--kill"], env=own)
        cls.wine = functools.partial(subprocess.run, capture_output=True, text=True, cwd=cls.folder,
                                     env=own)

    def test_has_the_shape_that_hosts_look_for(self):
        names = {path.relative_to(BUNDLE).as_posix() for path in BUNDLE.rglob("*") if path.is_file()}
        self.assertLessEqual({LIBRARY, "Contents/Info.plist", "Contents/Resources/LICENSE", "Contents/Resources/data/manifest.json"},
                             names)
        self.assertEqual([name for name in names if re.search(r"\.(dll|lib|pdb|a|exe)$", name)], [])
        self.assertFalse(any(path.is_symlink() for path in BUNDLE.rglob("*")))

    def test_exports_the_entry_points_alone(self):
        told = frames.output("llvm-readobj", "--coff-exports", BUNDLE / LIBRARY)
        self.assertEqual(set(re.findall(r"Name: (\S+)", told)), ENTRY_POINTS)

    def test_asks_for_nothing_but_the_system(self):
        told = frames.output("llvm-readobj", "--coff-imports", BUNDLE / LIBRARY)
        libraries = set(re.findall(r"Name: (\S+\.\w+)$", told, re.MULTILINE))
        self.assertIn("KERNEL32.dll", libraries)
        self.assertEqual({name for name in libraries if not re.fullmatch(SYSTEM_LIBRARIES, name)}, set())

    def test_passes_the_suite_of_hosts(self):
        frames.assert_passes(self, self.wine([program("wine64", "wine"), WINDOWS / "ofx_host_tests.exe"]))

    def test_renders_what_linux_renders_bit_for_bit(self):
        linux, windows = frames.jobs(self.folder, "linux"), frames.jobs(self.folder, "windows")
        own = LINUX.parent / "OFX/metamer.ofx.bundle/Contents/Linux-x86-64/metamer.ofx"
        run = subprocess.run([LINUX / "metamer_ofx_frames", "linux.txt"], cwd=self.folder, capture_output=True, text=True,
                             env=frames.environment(own))
        self.assertEqual(run.returncode, 0, run.stderr)
        run = self.wine([program("wine64", "wine"), WINDOWS / "metamer_ofx_frames.exe", "windows.txt"])
        self.assertEqual(run.returncode, 0, run.stderr)
        frames.assert_same(self, self.folder, "linux", linux, windows)


if __name__ == "__main__":
    unittest.main()
