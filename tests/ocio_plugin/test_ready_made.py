# SPDX-License-Identifier: Apache-2.0
"""configs/: every look and view runs alike in both OpenColorIO releases, their checkers find nothing, and what is checked
in is what its script makes.

METAMER_LONG=1 makes all of it again; without, a handful of looks.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import PyOpenColorIO as ocio

import run_config

ROOT = Path(__file__).resolve().parents[2]
CONFIGS = ROOT / "configs"
BIN = Path(os.environ["METAMER_BIN"])
LARGEST = 15_000_000

sys.path.insert(0, str(CONFIGS))
import generate  # noqa: E402


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


class ReadyMade(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sets = [*generate.lights(), generate.filters(), generate.nights(), generate.cameras()]
        cls.names = [name for one in cls.sets for name in one.recipes]

    def test_every_look_and_view_runs_alike(self):
        here = run_config.built_against(CONFIGS / "metamer.ocio")
        there = run_config.newest(CONFIGS / "metamer.ocio")
        self.assertEqual(here.keys(), there.keys())
        self.assertEqual({name for kind, name in here if kind == "look"}, set(self.names))
        self.assertEqual({name for kind, name in here if kind == "named transform"},
                         {f"{name} - Transform" for name in self.names})
        worst = 0.0
        for key, one in here.items():
            other = there[key]
            self.assertTrue(np.isfinite(one).all(), key)
            if key[0] == "view":
                # PQ of a negative is mirrored by later releases and clipped by earlier ones.
                one, other = np.maximum(one, 0), np.maximum(other, 0)
            size = np.abs(one).max(axis=1, keepdims=True)
            worst = max(worst, float((np.abs(one - other) / size).max()))
        print(f"{len(here)} looks, named transforms and views: releases differ by {worst:.1e} of the largest channel")
        # Single precision through the chain (1e-5) and through the views' tone curves.
        self.assertLess(worst, 2e-4)

    def test_neutrals_stay_neutral_with_the_eye_adapted(self):
        results = run_config.newest(CONFIGS / "metamer.ocio")
        worst = 0.0
        for name in self.names:
            if name.endswith("_100") or "_as_" in name:
                grey = results["look", name][0]
                worst = max(worst, float(np.ptp(grey) / grey.mean()))
        print(f"neutrals: channels differ by {worst:.1e}")
        self.assertLess(worst, 1e-4)

    def check(self, folder):
        """ociocheck and ociochecklut of a folder over all of configs/."""
        check = subprocess.run([folder / "ociocheck", "--iconfig", CONFIGS / "metamer.ocio"], capture_output=True, text=True,
                               timeout=600)
        said = check.stdout + check.stderr
        self.assertEqual(check.returncode, 0, said)
        for word in ("ERROR", "Error", "WARNING", "Warning", "failed", "NOT DEFINED"):
            self.assertNotIn(word, said)
        self.assertIn("Tests complete.", said)
        luts = sorted((CONFIGS / "luts").glob("*.ctf"))
        for lut in luts:
            run = subprocess.run([folder / "ociochecklut", lut, "0.18", "0.18", "0.18"], capture_output=True, text=True, timeout=60)
            self.assertEqual(run.returncode, 0, f"{lut.name}: {run.stdout}{run.stderr}")
            for word in ("ERROR", "WARNING", "Warning"):
                self.assertNotIn(word, run.stdout + run.stderr)
            values = [float(x.strip("[],")) for x in run.stdout.split()[-3:]]
            self.assertTrue(np.isfinite(values).all())
        print(f"{folder}: ociocheck clean, ociochecklut clean over {len(luts)} files")

    def test_checkers_find_nothing(self):
        program = shutil.which("ociocheck", path="/usr/bin:/usr/local/bin")
        if program is None:
            self.skipTest("ociocheck is not installed (Debian: opencolorio-tools)")
        self.check(Path(program).parent)

    def test_checkers_of_the_newest_release_find_nothing(self):
        # The wheel carries them as console scripts, from 2.5 on.
        self.check(Path(sys.executable).parent)
        config = ocio.Config.CreateFromFile(str(CONFIGS / "metamer.ocio"))
        for role in ("scene_linear", "compositing_log", "color_timing", "data", "aces_interchange",
                     "cie_xyz_d65_interchange", "rendering", "reference", "default", "color_picking", "texture_paint", "matte_paint"):
            self.assertTrue(config.hasRole(role), role)

    def test_certificates_say_what_they_are_of(self):
        for name in self.names:
            certificate = json.loads((CONFIGS / "luts" / f"{name}.json").read_text())
            self.assertEqual(certificate["recipe"]["name"], name)
            self.assertGreaterEqual(certificate["error"]["max"], certificate["error"]["p99"])

    def test_size_of_the_folder(self):
        files = [path for path in CONFIGS.rglob("*") if path.is_file() and "__pycache__" not in path.parts]
        self.assertLess(sum(path.stat().st_size for path in files), LARGEST)
        self.assertEqual([path for path in files if "partial" in path.name], [])

    def test_recipes_are_those_of_the_script(self):
        with tempfile.TemporaryDirectory() as folder:
            generate.write_recipes(Path(folder), self.sets)
            self.assertEqual(contents(Path(folder)), contents(CONFIGS / "recipes"))

    def test_tables_are_those_of_the_script(self):
        long = os.environ.get("METAMER_LONG") == "1"
        with tempfile.TemporaryDirectory() as folder:
            if long:
                run = subprocess.run([sys.executable, "-B", CONFIGS / "generate.py", "--lutgen", BIN / "lutgen", "--out", folder])
                self.assertEqual(run.returncode, 0)
                made = contents(Path(folder))
                self.assertEqual(made, {name: text for name, text in contents(CONFIGS).items() if name in made})
                return
            # One core of three adaptations, a matrix, a camera.
            for size, names in [
                (generate.SIZE, ["3200k_to_a_000", "3200k_to_a_050", "3200k_to_a_100", "nd_06"]),
                (generate.SMALL_SIZE, ["canon_5d2_as_ricd"]),
            ]:
                recipes = [CONFIGS / "recipes" / f"{name}.yaml" for name in names]
                run = subprocess.run([BIN / "lutgen", "config", "-o", Path(folder) / "metamer.ocio", "--tolerance",
                                      str(generate.TOLERANCE), "--size", str(size), *recipes], capture_output=True, text=True)
                self.assertEqual(run.returncode, 0, run.stderr)
                for name, text in contents(Path(folder) / "luts").items():
                    self.assertEqual(text, (CONFIGS / "luts" / name).read_bytes(), name)


if __name__ == "__main__":
    unittest.main()
