# SPDX-License-Identifier: Apache-2.0
"""lutgen pairs: files of colours whose spectra are known, and what is said of them."""

import json
import unittest

import metamer
import numpy as np

from lutgen import LutgenTest, lutgen

SAND = "nm,sand,wet sand\n380,0.1,0.05\n580,0.3,0.2\n780,0.4,0.3\n"
COAT = {"D65": (0.232, 0.169, 0.063), "A": (0.334, 0.214, 0.021)}


class Pairs(LutgenTest):
    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")

    def add_coat(self):
        colours = [part for light, xyz in COAT.items() for part in ("--colour", f"{light}:{','.join(map(str, xyz))}")]
        return self.assertWorks("pairs", "add", "costume.csv", "--name", "coat", *colours)

    def check(self, *arguments):
        return json.loads(self.assertWorks("pairs", "check", *arguments, "--json", "--quiet"))

    def test_spectra_and_colours_in_one_file(self):
        self.write("sand.csv", SAND)
        self.assertIn("costume.csv: 1 pair added, 1 in all", self.assertWorks("pairs", "add", "costume.csv", "sand.csv:wet sand"))
        self.assertIn("costume.csv: 1 pair added, 2 in all", self.add_coat())
        self.assertIn("costume.csv: 24 pairs added, 26 in all", self.assertWorks("pairs", "add", "costume.csv", "colorchecker"))
        spectra = metamer.Spectrum.read(self.folder / "costume.csv", quantity="reflectance")
        self.assertEqual([s.name for s in spectra[:3]], ["wet sand", "coat", "dark skin"])
        self.assertAlmostEqual(spectra[0](480), 0.125, places=12)
        for light, xyz in COAT.items():
            np.testing.assert_allclose(metamer.tristimulus(spectra[1], light), xyz, atol=1e-9)
        values = np.asarray(spectra[1].values)
        self.assertTrue(0 <= values.min() and values.max() <= 1)

    def test_fluorescent_materials(self):
        """A dye that gives back at 520 nm what it takes at 430: brighter than white in daylight, dull without violet."""
        nm = np.arange(380, 781, 10)
        factors = np.diag(np.where(nm > 500, 0.5, 0.1))
        factors[nm == 520, (nm >= 400) & (nm <= 460)] = 0.6
        rows = [",".join(map(str, (wavelength, *row))) for wavelength, row in zip(nm, factors)]
        self.write("vest.csv", "\n".join([",".join(["out/in", *map(str, nm)]), *rows, ""]))
        said = self.assertWorks("pairs", "add", "costume.csv", "--fluorescent", "vest.csv", "--under", "D65", "--under", "LPS")
        self.assertIn("costume.csv: 1 pair added", said)
        vest = metamer.Spectrum.read(self.folder / "costume.csv", quantity="reflectance")[0]
        self.assertEqual(vest.name, "vest")
        self.assertAlmostEqual(metamer.tristimulus(vest, "LPS")[1], 0.5, places=3)
        self.assertGreater(metamer.tristimulus(vest, "D65")[1], 0.53)
        self.assertLess(self.check("costume.csv", "--illuminant-out", "HP1")["pairs"][0]["error"], 1e-3)
        usage = {("--fluorescent", "vest.csv"): "--fluorescent: and --under go together",
                 ("colorchecker", "--under", "A"): "--fluorescent: and --under go together",
                 ("colorchecker", "--fluorescent", "vest.csv", "--under", "A"): "and one"}
        for arguments, says in usage.items():
            self.assertFails("pairs", "add", "other.csv", *arguments, code=2, says=[says])

    def test_check_tells_what_a_transform_does(self):
        self.add_coat()
        self.assertWorks("pairs", "add", "costume.csv", "colorchecker")
        checked = self.check("costume.csv", "--illuminant-out", "HP1")
        self.assertEqual((checked["illuminant_in"], checked["illuminant_out"]), ("D65", "HP1"))
        self.assertEqual(len(checked["pairs"]), 25)
        self.assertLess(max(pair["error"] for pair in checked["pairs"]), 1e-3)
        self.assertGreater(max(pair["error_before"] for pair in checked["pairs"]), 1)
        without = metamer.Transform(metamer.Recipe("D65", "HP1"), bands=401)
        with_pairs = metamer.Transform(
            metamer.Recipe("D65", "HP1", scene={"kind": "pairs", "set": "costume.csv"}, folder=self.folder), bands=401
        )
        coat = checked["pairs"][0]
        lab = [metamer.lab(rgb, np.ones(3)) for rgb in (without(coat["rgb"]), with_pairs(coat["rgb"]))]
        self.assertGreater(metamer.delta_e_2000(*lab), 0.5 * coat["error_before"])
        self.assertIn("coat", self.assertWorks("pairs", "check", "costume.csv", "--over", "smooth", "--radius", "3"))

    def test_a_recipe_bakes_and_is_checked(self):
        self.add_coat()
        self.write("a.yaml", "metamer: 1\ninput: {illuminant: D65}\noutput: {illuminant: A}\n"
                             "scene: {kind: pairs, set: costume.csv, radius: 2}\n")
        self.assertEqual(self.check("a.yaml")["radius"], 2)
        self.assertWorks("bake", "a.yaml", "-o", "a.cube", "--size", "9")
        certificate = json.loads((self.folder / "a.cube.json").read_text())
        self.assertEqual(certificate["recipe"]["scene"],
                         {"kind": "pairs", "set": "costume.csv", "over": "natural", "radius": 2.0})
        self.assertIn("scene.over", json.dumps(certificate))
        recipe = (self.folder / "a.yaml").read_text()
        override = self.assertWorks("pairs", "check", "a.yaml", "--scene", "pairs:costume.csv:1.5", "--json", "--quiet")
        self.assertEqual(json.loads(override)["radius"], 1.5)
        self.write("a.yaml", recipe.replace("pairs, set: costume.csv, radius: 2", "natural"))
        self.assertFails("pairs", "check", "a.yaml", says=["a.yaml: scene.kind 'natural': has no pairs to check"])

    def test_conflicts_are_named(self):
        # Two reflectances of one colour, from colours under a second light that differ.
        for name, red in (("left", 0.55), ("right", 0.56)):
            self.assertWorks("pairs", "add", "two.csv", "--name", name, "--colour", "D65:0.475,0.5,0.545",
                             "--colour", f"A:{red},0.505,0.17")
        run = lutgen("pairs", "check", "two.csv", "--exit-code", folder=self.folder)
        self.assertEqual(run.returncode, 3, run.stdout + run.stderr)
        self.assertIn("in conflict with right", run.stdout)
        self.assertIn("keep", run.stderr)
        run = lutgen("bake", "--illuminant-in", "D65", "--illuminant-out", "A", "--scene", "pairs:two.csv", "-o", "a.cube",
                     "--size", "9", folder=self.folder)
        self.assertEqual(run.returncode, 0)
        self.assertIn("white", run.stderr)

    def test_what_fails(self):
        self.write("sand.csv", SAND)
        self.write("colours.csv", "pair,light,X,Y,Z\nhat,D65,0.4,0.4,0.4\n")
        self.write("nan.csv", "nm,a\n380,0.1\n580,nan\n780,0.1\n")
        self.write("negative.csv", "nm,a\n380,0.1\n580,-0.9\n780,0.1\n")
        for arguments, code, says in [
            (("add", "c.csv"), 2, ["needs spectra"]),
            (("add", "c.csv", "sand.csv", "--colour", "D65:1,1,1"), 2, ["needs spectra"]),
            (("add", "c.csv", "--colour", "D65:.2,.2,.2"), 2, ["needs --name"]),
            (("add", "c.csv", "--name", "a", "--colour", "D65:.2,.2"), 1, ["--colour: colour 'D65:.2,.2': write LIGHT:X,Y,Z"]),
            (("add", "c.csv", "--name", "a", "--colour", "D66:.2,.2,.2"), 1, ["D66", "near names"]),
            (("add", "c.csv", "--name", "a", "--colour", "D65:.1,.9,.1"), 1, ["no reflectance has this colour; the nearest has"]),
            (("add", "c.csv", "sand.csv", "--name", "a"), 1, ["--name: name 'a': names one pair, and there are 2"]),
            (("add", "c.txt", "sand.csv"), 1, ["c.txt: extension: must be .csv"]),
            (("add", "colours.csv", "sand.csv"), 1, ["colours.csv: pairs: holds colours and not spectra"]),
            (("add", "sand.csv", "sand.csv"), 1, ["sand.csv: pair 'sand': is there already"]),
            (("add", "c.csv", "nan.csv"), 1, ["nan.csv:3", "'nan'"]),
            (("add", "c.csv", "negative.csv"), 1, ["negative.csv:3", "must not be negative"]),
            (("check", "no.csv"), 1, ["no.csv"]),
            (("check", "sand.csv", "--over", "dataset"), 2, ["--over"]),
        ]:
            with self.subTest(arguments=arguments):
                run = lutgen("pairs", *arguments, folder=self.folder)
                self.assertEqual(run.returncode, code, run.stderr)
                for text in says:
                    self.assertIn(text, run.stderr)
                self.assertFalse((self.folder / "c.csv").exists())


if __name__ == "__main__":
    unittest.main()
