# SPDX-License-Identifier: Apache-2.0
"""Baking and comparing, through the opencolorio package; what lutgen writes, byte for byte."""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import metamer

try:
    from metamer import ocio
except ImportError as error:
    ocio, WHY = None, str(error)
else:
    WHY = ""

LUTGEN = Path(os.environ.get("METAMER_BIN", "/nowhere")) / "lutgen"


@unittest.skipIf(ocio is None, WHY)
class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.recipe = metamer.Recipe("D65", "HP1", adaptation=0.5, name="day_to_sodium")

    def test_bake_and_compare(self):
        for name in ("a.cube", "a.ctf"):
            with self.subTest(name):
                file = self.folder / name
                certificate = ocio.bake(self.recipe, file, size=17)
                self.assertEqual(certificate, json.loads(Path(f"{file}.json").read_text()))
                found = ocio.compare(self.recipe, file)
                self.assertAlmostEqual(found.p99, certificate["error"]["p99"], places=3)
                self.assertEqual((found.space, len(found.probes), len(found.rgb)),
                                 ("ACEScg", len(found.delta_e), len(found.delta_e)))
                self.assertEqual(found.max, found.delta_e.max())
        self.assertEqual(ocio.compare(self.recipe, self.recipe).max, 0)

    def test_text(self):
        ocio.bake(self.recipe, self.folder / "a.clf", size=17)
        text, certificate = ocio.bake_text(self.recipe, "Academy/ASC Common LUT Format", size=17)
        self.assertEqual(text, (self.folder / "a.clf").read_text())
        self.assertEqual(certificate["transform"], json.loads((self.folder / "a.clf.json").read_text())["transform"])

    def test_tolerance_and_log_space(self):
        recipe = metamer.Recipe("D65", "A", space="ACEScct")
        certificate = ocio.bake(recipe, self.folder / "a.cube", tolerance=2, stops=(-4, 4))
        self.assertLess(certificate["error"]["p99"], 2)
        self.assertLess(ocio.compare(recipe, self.folder / "a.cube").p99, 2.1)

    def test_refused(self):
        spectral = metamer.Recipe({380: 1, 780: 1}, "A")
        for what, call, error, message in (
            ("spectra", lambda: ocio.bake(spectral, self.folder / "a.cube"), ValueError, "save them as CSV"),
            ("missing file", lambda: ocio.compare(self.recipe, self.folder / "gone.cube"), FileNotFoundError, "gone.cube"),
            ("missing config", lambda: ocio.compare(self.recipe, "gone.ocio"), FileNotFoundError, "gone.ocio"),
            ("no look", lambda: ocio.compare("a.cube", "gone.ocio"), ValueError, "LOOK"),
            ("format", lambda: ocio.bake(self.recipe, self.folder / "a.xyz"), ValueError, "xyz"),
            ("size", lambda: ocio.bake(self.recipe, self.folder / "a.cube", size=1000), ValueError, "1000"),
            ("shaper", lambda: ocio.bake(self.recipe, self.folder / "a.cube", shaper="log"), ValueError, "ACEScct"),
            ("folder", lambda: ocio.bake(self.recipe, self.folder / "no" / "a.cube"), ValueError, "a.cube"),
        ):
            with self.subTest(what):
                with self.assertRaisesRegex(error, message):
                    call()
        self.assertEqual([entry.name for entry in self.folder.iterdir()], [])

    @unittest.skipUnless(LUTGEN.is_file(), "no lutgen in $METAMER_BIN")
    def test_as_lutgen(self):
        """The same bytes, certificate too, where both are linked with the same OpenColorIO."""
        (self.folder / "recipe.yaml").write_text(self.recipe.yaml())
        ours, theirs = self.folder / "ours.cube", self.folder / "theirs.cube"
        ocio.bake(self.folder / "recipe.yaml", ours)
        subprocess.run([LUTGEN, "bake", self.folder / "recipe.yaml", "-o", theirs], check=True, capture_output=True)
        self.assertEqual(ours.read_bytes(), theirs.read_bytes())
        self.assertEqual(Path(f"{ours}.json").read_bytes(), Path(f"{theirs}.json").read_bytes())


class Absent(unittest.TestCase):
    def test_the_rest_works_without(self):
        """metamer itself never imports OpenColorIO."""
        code = "import sys, metamer; sys.exit(any('OpenColorIO' in name for name in sys.modules))"
        self.assertEqual(subprocess.run([sys.executable, "-c", code]).returncode, 0)


if __name__ == "__main__":
    unittest.main()
