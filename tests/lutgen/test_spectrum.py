# SPDX-License-Identifier: Apache-2.0
"""lutgen spectrum: spectra in few numbers, what that costs, and back to tables that lutgen reads."""

import json
import re
import unittest
from pathlib import Path

import numpy as np
import OpenEXR

from lutgen import LutgenTest, lutgen

ROOT = Path(__file__).resolve().parents[2]


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


class Fluorescence(LutgenTest):
    def setUp(self):
        super().setUp()
        (self.folder / "dayglo.csv").write_bytes((ROOT / "demo/files/dayglo.csv").read_bytes())

    def test_a_matrix_is_shown_and_fitted(self):
        said = self.assertWorks("spectrum", "show", "dayglo.csv")
        self.assertRegex(said, r"under D65: .* at most 2\.\d+ times a perfect reflector, at 6\d\d nm: a reflectance cannot hold")
        said = self.assertWorks("spectrum", "fit", "dayglo.csv", "-o", "compact.csv")
        for light, difference in re.findall(r"(D65|A|FL11|HP1|LED-RGB1) ([\d.]+)", said):
            self.assertLessEqual(float(difference), 0.8, light)
        left = float(re.search(r"([\d.]+) % of the re-radiation", said).group(1))
        self.assertTrue(1 < left < 20, said)
        shown = self.assertWorks("spectrum", "show", "compact.csv", "--lights", "D65")
        self.assertIn("quantum yield 0.7", shown)
        self.assertNotIn("FL11", shown)
        self.assertFails("spectrum", "fit", "compact.csv", "-o", "x.csv", says=["compact.csv", "give a matrix"])

    def test_bispectral_pictures_are_matrices(self):
        table = np.loadtxt(self.folder / "dayglo.csv", delimiter=",", skiprows=1)
        nm, factors = table[:, 0], table[:, 1:]
        channels = {"R": np.zeros((1, 2), np.float32)}
        for i, excitation in enumerate(nm):
            channels[f"T.{excitation:.6f}nm".replace(".", ",").replace("T,", "T.")] = factors[i, i]
            for o in range(i + 1, len(nm)):
                name = f"{excitation:.6f}nm".replace(".", ",") + "." + f"{nm[o]:.6f}nm".replace(".", ",")
                channels["T." + name] = factors[o, i]
        channels = {name: np.full((1, 2), value, np.float32) for name, value in channels.items()}
        OpenEXR.File({"type": OpenEXR.scanlineimage}, channels).write(str(self.folder / "paint.exr"))
        for light in ("D65", "FL11"):
            for file in ("paint.exr", "paint.exr:1,0"):
                shown = [self.assertWorks("spectrum", "show", one, "--lights", light).splitlines()[1]
                         for one in ("dayglo.csv", file)]
                self.assertEqual(shown[0], shown[1])

    def test_a_set_brighter_than_white_is_said_to_be(self):
        nm = np.arange(380, 781, 10)
        surfaces = [0.5 + 0.3 * np.sin(nm / 60 + k) for k in range(6)]
        surfaces[2][20] = 1.15
        for name, most in (("bright", 1.15), ("white", 1.0)):
            surfaces[2][20] = most
            rows = [",".join(f"{value:.5f}" for value in row) for row in zip(nm, *surfaces)]
            (self.folder / f"{name}.csv").write_text("nm,a,b,c,d,e,f\n" + "\n".join(rows))
            (self.folder / f"{name}.yaml").write_text(
                "metamer: 1\nname: x\nspace: ACEScg\ninput: {illuminant: D65}\noutput: {illuminant: A}\n"
                f"scene: {{kind: dataset, set: {name}.csv}}\n")
            run = lutgen("bake", f"{name}.yaml", "-o", f"{name}.spi3d", "--size", "5", folder=self.folder)
            self.assertEqual(run.returncode, 0, run.stderr)
            notes = json.loads((self.folder / f"{name}.spi3d.json").read_text()).get("notes", [])
            for said in (run.stderr, "\n".join(notes)):
                expected = "1 of 6 reflect more than arrives, up to 1.15 at 580 nm: a reflectance cannot hold this"
                self.assertEqual(expected in said, name == "bright", said)

    def test_what_no_surface_does_is_refused_in_a_line(self):
        text = (self.folder / "dayglo.csv").read_text()
        lines = text.splitlines()
        columns = list(zip(*(line.split(",") for line in lines)))
        (self.folder / "turned.csv").write_text("\n".join(",".join(column) for column in columns))
        (self.folder / "gap.csv").write_text("\n".join(lines[:20] + lines[21:]))
        (self.folder / "nan.csv").write_text(text.replace(",0.275137,", ",nan,", 1))
        (self.folder / "percent.csv").write_text("\n".join([lines[0]] + [
            ",".join([cells[0]] + [str(100 * float(cell)) for cell in cells[1:]])
            for cells in (line.split(",") for line in lines[1:])]))
        for file, says in (("turned", "below its excitation"), ("gap", "gap"), ("nan", "finite"), ("percent", "percent")):
            self.assertFails("spectrum", "show", f"{file}.csv", says=[f"{file}.csv", says])


if __name__ == "__main__":
    unittest.main()
