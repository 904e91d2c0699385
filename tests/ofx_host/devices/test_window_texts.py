# SPDX-License-Identifier: Apache-2.0
"""The plug-in's kernels as the build makes them: PTX that old drivers take, arithmetic that is rounded as the processor's."""

import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

FOLDER = Path(os.environ["METAMER_BIN"]).parent / "ofx/window_texts"
KERNELS = {"metamerCopyWindow", "metamerMapWindow", "metamerSkinWindow", "metamerAffineWindow", "metamerMapCurveWindow",
           "metamerSkinCurveWindow"}


class Ptx(unittest.TestCase):
    def setUp(self):
        self.text = (FOLDER / "window.ptx").read_text()
        if not self.text:
            self.skipTest("no clang with the target nvptx64: the plug-in is built without CUDA; install clang")

    def test_old_drivers_and_cards_take_it(self):
        self.assertLessEqual(float(re.search(r"^\.version ([0-9.]+)$", self.text, re.MULTILINE)[1]), 6.3)
        self.assertEqual(re.search(r"^\.target (\S+)$", self.text, re.MULTILINE)[1], "sm_50")
        self.assertEqual(set(re.findall(r"\.visible \.entry (\w+)\(", self.text)), KERNELS)

    def test_needs_nothing_else(self):
        self.assertNotRegex(self.text, r"\.extern|\bcall(\.uni)?\b|vprintf|__nv_")

    def test_every_step_is_rounded_once(self):
        steps = set(re.findall(r"\b((?:add|sub|mul|fma|mad|div|rcp|sqrt|ex2|lg2)[a-z.]*\.f(?:32|64))\b", self.text))
        self.assertTrue(steps)
        self.assertEqual({step for step in steps if not re.fullmatch(r"(add|sub|mul|fma|div|rcp)\.rn\.f(32|64)", step)}, set())

    def test_nvidias_assembler_takes_it(self):
        assembler = shutil.which("ptxas")
        if assembler is None:
            self.skipTest("no ptxas: the PTX is not assembled")
        for card in ("sm_50", "sm_75", "sm_90"):
            with tempfile.TemporaryDirectory() as folder:
                subprocess.run([assembler, "-arch", card, FOLDER / "window.ptx", "-o", f"{folder}/kernels"], check=True)


class Metal(unittest.TestCase):
    def test_asks_for_nothing_that_metal_lacks(self):
        text = (FOLDER / "window.metal").read_text()
        # Doubles stand behind a condition that its prelude never meets.
        self.assertNotIn("#define METAMER_HAS_DOUBLES", text)
        self.assertNotRegex(text.split("#ifdef METAMER_HAS_DOUBLES")[0], r"\bdouble\b")


if __name__ == "__main__":
    unittest.main()
