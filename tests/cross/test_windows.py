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

ROOT = Path(__file__).resolve().parents[2]
BUNDLE = Path(os.environ["METAMER_BUNDLE"])
WINDOWS = Path(os.environ["METAMER_BIN"])
LINUX = Path(os.environ["METAMER_LINUX_BIN"])
LIBRARY = "Contents/Win64/metamer.ofx"
ENTRY_POINTS = {"OfxGetNumberOfPlugins", "OfxGetPlugin", "OfxSetHost"}
# Of every Windows 10: the kernel and the C runtime that comes with it.
SYSTEM_LIBRARIES = r"(?i)(kernel32|ntdll|advapi32|api-ms-win-crt-[\w-]+)\.dll"
FOLDER = "プラグイン ☀ й é"
RECIPES = 12
SETTINGS = [
    (0, ["outputIlluminant=HP1", "adaptation=0.3"]),
    (0, ["outputIlluminant=HP1", "quality=Exact", "mix=0.5"]),
    (0, ["outputIlluminant=Blackbody", "outputTemperature=2000", "scene=Skin", "quality=Exact"]),
    (0, ["outputIlluminant=FL11", "scene=Smooth", "cat=bradford", "keepExposure=1"]),
    (0, ["outputIlluminant=A", "scene=Data set", "space=ARRI LogC4", "quality=Exact"]),
    (2, ["melanin=2", "blood=1.5", "quality=Exact"]),
    (2, ["tan=1", "flush=0.5", "illuminant=A"]),
]


def output(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=True).stdout


def program(*names):
    """Debian keeps wine's programs out of the path."""
    found = [path for name in names if (path := shutil.which(name, path=f"/usr/lib/wine:{os.environ['PATH']}"))]
    if not found:
        raise AssertionError("needs wine: install Debian's package wine64")
    return found[0]


def environment(library, scratch=None):
    # Names reach wine in the locale's encoding; it makes its folder of settings where it is told.
    own = dict(os.environ, METAMER_OFX_LIBRARY=str(library), LC_ALL="C.UTF-8", WINEDEBUG="-all")
    own.pop("METAMER_DATA", None)
    if scratch is not None:
        own |= {"WINEPREFIX": str(scratch), "WINEDLLOVERRIDES": "mscoree,mshtml=", "DISPLAY": "",
                "WINESERVER": program("wineserver64", "wineserver")}
    return own


class Windows(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        cls.bundle = cls.folder / FOLDER / BUNDLE.name
        shutil.copytree(BUNDLE, cls.bundle)
        own = environment(cls.bundle / LIBRARY, cls.folder / "wine")
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
        told = output("llvm-readobj", "--coff-exports", BUNDLE / LIBRARY)
        self.assertEqual(set(re.findall(r"Name: (\S+)", told)), ENTRY_POINTS)

    def test_asks_for_nothing_but_the_system(self):
        told = output("llvm-readobj", "--coff-imports", BUNDLE / LIBRARY)
        libraries = set(re.findall(r"Name: (\S+\.\w+)$", told, re.MULTILINE))
        self.assertIn("KERNEL32.dll", libraries)
        self.assertEqual({name for name in libraries if not re.fullmatch(SYSTEM_LIBRARIES, name)}, set())

    def test_passes_the_suite_of_hosts(self):
        run = self.wine([program("wine64", "wine"), WINDOWS / "ofx_host_tests.exe"])
        self.assertEqual(run.returncode, 0, run.stdout[-6000:] + run.stderr[-2000:])
        passed = re.search(r"\[  PASSED  \] (\d+) tests", run.stdout)
        self.assertGreater(int(passed[1]), 50, run.stdout[-2000:])
        self.assertNotIn("SKIPPED", run.stdout)

    def jobs(self, system):
        """A file of jobs, and the pictures that they make. Windows' see the same files by the same relative names."""
        jobs = [(effect, settings) for effect, settings in SETTINGS]
        recipes = self.folder / "レシピ é"
        shutil.copytree(ROOT / "configs/recipes", recipes, dirs_exist_ok=True)
        names = sorted((ROOT / "configs/recipes").glob("*.yaml"))
        for k, recipe in enumerate(names[:: len(names) // RECIPES][:RECIPES]):
            copy = recipes / f"{recipe.stem} 夜.yaml"
            shutil.copy(recipe, copy)
            jobs.append((0, [f"recipeFile={copy.relative_to(self.folder)}", f"quality={('Map', 'Exact')[k % 2]}"]))
        lamp = recipes / "лампа.csv"
        lamp.write_text("nm,power\n380,1\n580,1\n780,3\n", encoding="utf-8")
        lit = lamp.with_name("灯.yaml")
        lit.write_text("metamer: 1\ninput: {illuminant: D65}\noutput: {illuminant: лампа.csv}\n", encoding="utf-8")
        jobs.append((0, [f"recipeFile={lit.relative_to(self.folder)}"]))
        pictures = [f"{system} 絵 {k}.f32" for k in range(len(jobs))]
        text = "".join("\t".join([str(effect), picture, *settings]) + "\n" for (effect, settings), picture in zip(jobs, pictures))
        (self.folder / f"{system}.txt").write_text(text, encoding="utf-8", newline="\n")
        return [self.folder / picture for picture in pictures]

    def test_renders_what_linux_renders_bit_for_bit(self):
        linux, windows = self.jobs("linux"), self.jobs("windows")
        own = LINUX.parent / "OFX/metamer.ofx.bundle/Contents/Linux-x86-64/metamer.ofx"
        run = subprocess.run([LINUX / "metamer_ofx_frames", "linux.txt"], cwd=self.folder, capture_output=True, text=True,
                             env=environment(own))
        self.assertEqual(run.returncode, 0, run.stderr)
        run = self.wine([program("wine64", "wine"), WINDOWS / "metamer_ofx_frames.exe", "windows.txt"])
        self.assertEqual(run.returncode, 0, run.stderr)
        texts = (self.folder / "linux.txt").read_text(encoding="utf-8").splitlines()
        seen = {}
        for text, one, other in zip(texts, linux, windows, strict=True):
            a, b = one.read_bytes(), other.read_bytes()
            self.assertEqual(len(a), 160 * 90 * 16)
            self.assertNotIn(a, seen, f"{text} is {seen.get(a)}: not told apart")
            seen[a] = text
            differing = sum(a[i : i + 4] != b[i : i + 4] for i in range(0, len(a), 4)) if a != b else 0
            self.assertEqual(differing, 0, f"numbers of {len(a) // 4} that differ: {text}")


if __name__ == "__main__":
    unittest.main()
