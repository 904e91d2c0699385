# SPDX-License-Identifier: Apache-2.0
"""lutgen spectrum: spectra in few numbers, what that costs, and back to tables that lutgen reads."""

import json
import re
import unittest

import numpy as np

from lutgen import LutgenTest


class Spectrum(LutgenTest):
    def pack(self, *arguments, output="s.json"):
        said = self.assertWorks("spectrum", "pack", *arguments, "-o", output)
        mean, worst = re.search(r"mean ([\d.]+), worst spectrum ([\d.]+)", said).groups()
        return float(mean), float(worst), json.loads((self.folder / output).read_text())

    def table(self, step=5):
        self.assertWorks("spectrum", "convert", "s.json", "-o", "s.csv", "--step", step)
        return np.loadtxt(self.folder / "s.csv", delimiter=",", skiprows=1)

    def test_what_was_asked_of_reflectances(self):
        sets = ["colorchecker", "tm30", "model skins"]
        for arguments, most, numbers in (((), 0.05, 20), (("--form", "bytes"), 0.15, 20), (("--numbers", "12"), 0.20, 12)):
            mean, _, stored = self.pack(*sets, *arguments)
            self.assertLessEqual(mean, most, arguments)
            self.assertEqual(len(stored["spectra"]), 223)
            self.assertEqual({len(entry["numbers"]) for entry in stored["spectra"]}, {numbers})
        points = self.pack(*sets, "--form", "points", "--numbers", "12")
        self.assertGreater(points[0], 1.0)

    def test_lights_keep_their_lines(self):
        mean, worst, stored = self.pack("HP1", "LPS", "LED-RGB1", "A", "--use", "light")
        self.assertLessEqual(worst, 0.1)
        self.assertEqual(stored["form"], "lines")
        said = self.assertWorks("spectrum", "show", "s.json")
        self.assertRegex(said, r"LPS\t20 numbers, 80 bytes; lines at .*\b58[89]\b")
        self.assertNotRegex(said, r"\bA\t.*lines at 5")
        # A light of one line, as a file.
        rows = "\n".join(f"{nm},{1.0 if nm == 546 else 0.0}" for nm in range(380, 781))
        (self.folder / "line.csv").write_text("nm,power\n" + rows + "\n")
        for form in ("lines", "hats", "cosines", "moments"):
            self.pack("line.csv", "--use", "light", "--form", form)
            table = self.table(step=1)
            power = table[:, 1].sum()
            self.assertTrue(np.isfinite(table).all())
            self.assertAlmostEqual(power, 1, delta=0.25, msg=form)
            coarse = self.table(step=10)[:, 1]
            self.assertAlmostEqual(10 * (coarse.sum() - (coarse[0] + coarse[-1]) / 2), power, delta=0.03, msg=form)

    def test_tolerance_finds_the_fewest_bytes(self):
        mean, _, stored = self.pack("colorchecker", "--tolerance", "0.2")
        self.assertLessEqual(mean, 0.2)
        self.assertEqual(stored["form"], "bytes")
        loose = self.pack("colorchecker", "--tolerance", "2")[2]
        self.assertLess(len(loose["spectra"][0]["numbers"]), len(stored["spectra"][0]["numbers"]))
        self.assertFails("spectrum", "pack", "colorchecker", "-o", "t.json", "--form", "points", "--tolerance", "0.001",
                         says=["--tolerance", "0.001", "held by no form", "points"])

    def test_tables_come_back(self):
        self.pack("colorchecker", "--form", "moments")
        table = self.table()
        self.assertEqual(table.shape, (81, 25))
        self.assertTrue((table[:, 1:] >= 0).all() and (table[:, 1:] <= 1).all())
        # The table is a set of reflectances that is stored as this one was.
        again = self.pack("s.csv", "--form", "moments", output="t.json")
        self.assertLess(again[0], 0.05)

    def test_what_fails(self):
        self.pack("colorchecker")
        good = (self.folder / "s.json").read_text()
        for bad, says in ((good.replace('"cosines"', '"cosine"'), "cosine"), (good.replace('storage": 1', 'storage": 2'), "metamer_storage"),
                          (good.replace('"numbers": [', '"numbers": ["a", ', 1), "must be a number"), (good[:200], "s.json"),
                          (good.replace('"reflectance"', '"filter"'), "filter"),
                          (re.sub(r'"numbers": \[[^]]*\]', '"numbers": [1, 2]', good, count=1), "numbers")):
            (self.folder / "s.json").write_text(bad)
            self.assertFails("spectrum", "convert", "s.json", "-o", "s.csv", says=["s.json", says])
        self.assertFails("spectrum", "pack", "colorchecker", "-o", "t.json", "--form", "lines", says=["lines", "hold lights"])
        self.assertFails("spectrum", "pack", "A", "--use", "light", "-o", "t.json", "--form", "bytes", says=["A", "bytes"])
        self.assertFails("spectrum", "pack", "colorcheker", "-o", "t.json", says=["colorcheker"])
        self.assertFails("spectrum", "pack", "colorchecker", "-o", "t.json", "--form", "hat", says=["hat", "points, hats"])
        self.assertFails("spectrum", "pack", "colorchecker", "-o", "t.json", "--numbers", "3", code=2, says=["--numbers"])


if __name__ == "__main__":
    unittest.main()
