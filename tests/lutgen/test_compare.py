# SPDX-License-Identifier: Apache-2.0
"""lutgen compare and lutgen config, as a build server calls them."""

import json
import os
import re
import shutil
import unittest
import xml.etree.ElementTree
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image

from lutgen import LutgenTest, lutgen

NATURAL = "metamer: 1\nname: night\nspace: ACEScg\ninput: {illuminant: D65}\noutput: {illuminant: HP1, adaptation: 0.5}\n"
# What compare does with a recipe does not depend on its scene; this one takes half the time.
NIGHT = NATURAL + "scene: {kind: smooth}\n"
# Of a plot: above and left of a panel, and the panel's side.
TOP, LEFT, PANEL = 72, 76, 460


def write_exr(file, pixels):
    OpenEXR.File(
        {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage},
        {channel: pixels[..., k].copy() for k, channel in enumerate("RGB")},
    ).write(str(file))


class Compare(LutgenTest):
    def setUp(self):
        super().setUp()
        (self.folder / "night.yaml").write_text(NIGHT)

    def compared(self, *arguments, code=0):
        run = lutgen("compare", *arguments, "--json", "out.json", folder=self.folder)
        self.assertEqual(run.returncode, code, run.stderr + run.stdout)
        self.assertEqual(run.stderr, "")
        return json.loads((self.folder / "out.json").read_text())

    def test_recipe_against_file_is_what_the_certificate_says(self):
        (self.folder / "night.yaml").write_text(NATURAL)
        for name in ("a.ctf", "b.clf", "c.cube"):
            self.assertWorks("bake", "night.yaml", "-o", name, "--size", "17")
            error = self.compared("night.yaml", name)["error"]
            certificate = json.loads((self.folder / f"{name}.json").read_text())["error"]
            self.assertEqual(error["count"], certificate["count"])
            # Both go through floats, the certificate's reference does not.
            for key in ("mean", "p99"):
                self.assertAlmostEqual(error[key], certificate[key], delta=2e-3 + 1e-3 * certificate[key], msg=name)
            # A certificate looks for the largest between the probes as well.
            self.assertLessEqual(error["max"], 2e-3 + 1.001 * certificate["max"], name)

    def test_a_cube_of_another_tool_is_read_by_the_flags(self):
        # A light that a small cube follows well, so that a wrong curve stands out.
        (self.folder / "dawn.yaml").write_text(NIGHT.replace("HP1", "D50"))
        self.assertWorks("bake", "dawn.yaml", "-o", "a.cube", "--shaper", "LogC3")
        certified = self.compared("dawn.yaml", "a.cube")["error"]
        (self.folder / "a.cube.json").unlink()
        told = self.compared("dawn.yaml", "a.cube", "--shaper", "LogC3")["error"]
        self.assertEqual(told, certified)
        taken_wrong = self.compared("dawn.yaml", "a.cube", "--shaper", "S-Log3")["error"]
        self.assertGreater(taken_wrong["mean"], 1.1 * certified["mean"])

    def test_tolerance_decides_the_exit_code(self):
        (self.folder / "dusk.yaml").write_text(NIGHT.replace("0.5", "0.6"))
        self.assertWorks("bake", "night.yaml", "-o", "a.ctf", "--size", "9")
        self.assertWorks("bake", "night.yaml", "-o", "b.ctf", "--size", "9")
        same = self.compared("a.ctf", "b.ctf", "--tolerance", "0")
        self.assertEqual((same["error"]["max"], same["tolerance"]["passed"]), (0, True))
        other = self.compared("night.yaml", "dusk.yaml", "--tolerance", "0.5", "--junit", "out.xml", code=3)
        self.assertFalse(other["tolerance"]["passed"])
        self.assertGreater(other["error"]["mean"], 0.5)
        suite = xml.etree.ElementTree.parse(self.folder / "out.xml").getroot().find("testsuite")
        self.assertEqual((suite.get("tests"), suite.get("failures")), ("1", "1"))
        self.assertIn("tolerance 0.5", suite.find("testcase/failure").get("message"))
        # The statistic that the tolerance is for.
        middle = (other["error"]["mean"] + other["error"]["max"]) / 2
        self.compared("night.yaml", "dusk.yaml", "--tolerance", middle, "--statistic", "mean", "--junit", "out.xml")
        suite = xml.etree.ElementTree.parse(self.folder / "out.xml").getroot().find("testsuite")
        self.assertEqual(suite.get("failures"), "0")
        self.compared("night.yaml", "dusk.yaml", "--tolerance", middle, "--statistic", "max", code=3)

    def test_a_look_against_its_recipe(self):
        self.assertWorks("config", "night.yaml", "-o", "c.ocio", "--size", "17")
        look = self.compared("night.yaml", "c.ocio", "--tolerance", "20")["error"]
        by_name = self.compared("c.ocio:night", "night.yaml")["error"]
        certificate = json.loads((self.folder / "luts" / "night.json").read_text())["error"]
        self.assertAlmostEqual(look["p99"], certificate["p99"], delta=1e-2)
        self.assertAlmostEqual(by_name["p99"], certificate["p99"], delta=1e-2)
        self.assertLess(self.compared("c.ocio:night", "luts/night.ctf", "--space", "ACEScg")["error"]["max"], 1e-2)
        # CI finds out that a look changed.
        (self.folder / "night.yaml").write_text(NIGHT.replace("HP1", "FL11"))
        self.compared("night.yaml", "c.ocio", "--tolerance", "1", code=3)

    def test_a_certificate_judges_its_file(self):
        (self.folder / "lamp.csv").write_text("nm,power\n380,1\n560,3\n780,9\n")
        recipe = NIGHT.replace("HP1", "lamp.csv")
        (self.folder / "night.yaml").write_text(recipe)
        self.assertWorks("bake", "night.yaml", "-o", "a.ctf", "--size", "9")
        for tolerance in ([], ["--tolerance", "certificate"]):
            report = self.compared("night.yaml", "a.ctf", *tolerance)
            self.assertEqual((report["tolerance"], report["certificate"]["stale"]),
                             ({"by": "certificate", "passed": True}, []))
        # A number is as before; without a certificate nobody judges.
        self.assertEqual(self.compared("a.ctf", "night.yaml", "--tolerance", "90")["tolerance"]["value"], 90)
        os.rename(self.folder / "a.ctf.json", self.folder / "kept.json")
        self.assertNotIn("tolerance", self.compared("night.yaml", "a.ctf", "--space", "ACEScg"))
        self.assertFails("compare", "night.yaml", "a.ctf", "--tolerance", "certificate", says=["a.ctf", "no certificate"])
        os.rename(self.folder / "kept.json", self.folder / "a.ctf.json")
        self.assertFails("compare", "a.ctf", "a.ctf", "--tolerance", "certificate", says=["recipe"])

        def cause(*arguments, code=3, word="cause"):
            run = lutgen("compare", "night.yaml", *(arguments or ["a.ctf"]), folder=self.folder)
            self.assertEqual(run.returncode, code, run.stdout + run.stderr)
            return re.search(rf"^{word}: (.*)$", run.stdout, re.MULTILINE)[1]

        # A recipe field, a lamp's contents, another file under the name.
        (self.folder / "night.yaml").write_text(recipe.replace("0.5", "0.9"))
        self.assertEqual(cause(), "recipe: output.adaptation was 0.5, is 0.9")
        (self.folder / "night.yaml").write_text(recipe)
        lamp = (self.folder / "lamp.csv").read_text()
        (self.folder / "lamp.csv").write_text(lamp.replace("780,9", "780,1"))
        self.assertRegex(cause(), r"^inputs: output\.illuminant: the contents of lamp\.csv changed, sha256 [0-9a-f]{8}\.\.\. "
                                  r"is [0-9a-f]{8}\.\.\. now$")
        (self.folder / "lamp.csv").write_text("# the same light\n" + lamp)
        self.assertIn("lamp.csv changed", cause(code=0, word="stale"))
        (self.folder / "lamp.csv").write_text(lamp)
        self.assertWorks("bake", "night.yaml", "-o", "b.ctf", "--size", "9", "--illuminant-out", "FL11")
        shutil.copy(self.folder / "b.ctf", self.folder / "a.ctf")
        self.assertEqual(cause(), "a.ctf is not the file that its certificate is for")

    def test_a_look_is_judged_by_its_certificate(self):
        self.assertWorks("config", "night.yaml", "-o", "c.ocio", "--size", "9")
        self.assertTrue(self.compared("night.yaml", "c.ocio")["tolerance"]["passed"])
        (self.folder / "night.yaml").write_text(NIGHT.replace("HP1", "FL11"))
        report = self.compared("night.yaml", "c.ocio:night", code=3)
        self.assertIn("recipe: output.illuminant was HP1, is FL11", report["certificate"]["stale"])
        # Renewed, it is what the recipe is.
        self.assertWorks("config", "night.yaml", "-o", "c.ocio", "--size", "9", "--replace")
        self.assertTrue(self.compared("night.yaml", "c.ocio")["tolerance"]["passed"])

    def test_what_changed_between_two_certificates(self):
        self.assertWorks("bake", "night.yaml", "-o", "a.ctf", "--size", "9")
        (self.folder / "gel.csv").write_text("nm,transmittance\n380,0.9\n580,0.2\n780,0.8\n")
        self.assertWorks("bake", "night.yaml", "-o", "b.ctf", "--size", "13", "--filter-out", "gel.csv:0.5")
        self.assertRegex(self.assertWorks("diff", "a.ctf.json", "a.ctf.json"), "^a.ctf.json and a.ctf.json say the same, ")
        said = self.assertWorks("diff", "a.ctf.json", "b.ctf.json")
        self.assertIn("recipe: output.filters[0].name is new: gel.csv\n", said)
        self.assertIn("inputs: output.filters[0].name is new: gel.csv\n", said)
        self.assertIn("transform: size was 9, is 13\n", said)
        self.assertRegex(said, r"(?m)^error: p99 was [0-9.]+, is [0-9.]+$")
        self.assertRegex(said, r"\na.ctf.json and b.ctf.json: \d+ differences, [0-9.]+ s\n$")
        changes = json.loads(self.assertWorks("diff", "a.ctf.json", "b.ctf.json", "--json"))["changes"]
        self.assertEqual(len(changes), said.count("\n") - 1)
        self.assertIn({"part": "transform", "field": "size", "before": 9, "after": 13,
                       "words": "transform: size was 9, is 13"}, changes)
        self.assertEqual(lutgen("diff", "a.ctf.json", "b.ctf.json", "--exit-code", folder=self.folder).returncode, 3)
        self.assertWorks("diff", "a.ctf.json", "a.ctf.json", "--exit-code", "--quiet")
        for name, text in (("none.json", None), ("list.json", "[]"), ("cut.json", '{"metamer_certificate": 1, "err'),
                           ("empty.json", '{"metamer_certificate": 1}')):
            if text is not None:
                (self.folder / name).write_text(text)
            self.assertFails("diff", "a.ctf.json", name, says=[name])

    def test_pictures(self):
        pixels = np.random.default_rng(4).random((20, 30, 3)).astype(np.float32) + 0.1
        write_exr(self.folder / "a.exr", pixels)
        changed = pixels.copy()
        changed[7, 11, 0] *= 1.5
        write_exr(self.folder / "b.exr", changed)
        self.assertEqual(self.compared("a.exr", "a.exr", "--tolerance", "0", "--statistic", "max")["error"]["max"], 0)
        error = self.compared("a.exr", "b.exr", "--plot", "plot.png", "--tolerance", "1", "--statistic", "max", code=3)
        self.assertEqual(error["error"]["count"], 600)
        self.assertGreater(error["error"]["max"], 3)
        self.assertLess(error["error"]["p99"], 1e-3)
        with Image.open(self.folder / "plot.png") as plot:
            sheet = np.asarray(plot.convert("RGB")).astype(int)
        # The picture's panel has one bright spot where the pixel is.
        left = LEFT + 2 * (PANEL + LEFT)
        panel = sheet[TOP:TOP + 306, left:left + PANEL]
        y, x = np.unravel_index(panel.sum(axis=2).argmax(), panel.shape[:2])
        self.assertEqual((int(y / 306 * 20), int(x / 460 * 30)), (7, 11))
        # Encoded pictures are decoded.
        for name in ("a.png", "b.png"):
            Image.fromarray((pixels[..., :3] * 200).astype(np.uint8)).save(self.folder / name)
        self.assertEqual(self.compared("a.png", "b.png")["space"], "Rec.709")
        self.assertFails("compare", "a.exr", "a.png", says=["--space"])
        write_exr(self.folder / "small.exr", pixels[:5])
        self.assertFails("compare", "a.exr", "small.exr", says=["small.exr", "30 x 5", "30 x 20"])

    def test_plot_of_transforms(self):
        self.assertWorks("bake", "night.yaml", "-o", "a.cube", "--size", "9")
        self.compared("night.yaml", "a.cube", "--plot", "plot.png")
        with Image.open(self.folder / "plot.png") as plot:
            self.assertEqual(plot.size, (LEFT + 2 * (PANEL + LEFT) + 18 + 190, TOP + PANEL + 84))
            sheet = np.asarray(plot.convert("RGB")).astype(int)
        # Something bright and the background within the plane of chromaticities; dark where nobody sees the difference.
        plane = sheet[TOP:TOP + PANEL, LEFT:LEFT + PANEL].sum(axis=2)
        self.assertGreater(plane.max(), 400)
        self.assertEqual(np.median(plane[:40]), 3 * 38)
        # Words stand above, below and beside the panels, where there is a font.
        if Path("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf").exists():
            for part in (sheet[:TOP - 4], sheet[TOP + PANEL + 8:, LEFT:LEFT + PANEL], sheet[TOP:TOP + PANEL, -180:]):
                self.assertGreater((part.min(axis=2) > 150).sum(), 200)
        # The scale is dark below, bright above, and goes by factors: a tenth of its end is at two thirds and more.
        bar = sheet[TOP:TOP + PANEL, LEFT + 2 * (PANEL + LEFT) + 9].sum(axis=1)
        self.assertGreater(bar[4], 500)
        self.assertLess(bar[-4], 40)
        self.assertLess((np.diff(bar.astype(int)) > 4).sum(), 3)
        # No two files of one kind differ but by the tolerance's mark.
        self.compared("night.yaml", "a.cube", "--plot", "marked.png", "--tolerance", "1", code=3)
        with Image.open(self.folder / "marked.png") as plot:
            marked = np.asarray(plot.convert("RGB")).astype(int)
        different = np.argwhere((marked != sheet).any(axis=2))
        self.assertGreater(len(different), 20)
        self.assertGreater(different[:, 1].min(), LEFT + 2 * (PANEL + LEFT) - 8)

    def test_bad_input_is_named(self):
        self.assertWorks("bake", "night.yaml", "-o", "a.ctf", "--size", "5")
        self.assertWorks("config", "night.yaml", "-o", "c.ocio", "--size", "5")
        (self.folder / "bad.ctf").write_text("<ProcessList>")
        (self.folder / "d.cube").write_text("LUT_3D_SIZE 2\n" + "0 0 0\n" * 8)
        (self.folder / "d.cube.json").write_text('{"metamer_certificate": 1}')
        write_exr(self.folder / "p.exr", np.ones((2, 2, 3), np.float32))
        for arguments, says in [
            (["night.yaml", "missing.ctf"], ["missing.ctf"]),
            (["missing.yaml", "a.ctf"], ["missing.yaml"]),
            (["night.yaml", "bad.ctf"], ["bad.ctf", "cannot be read"]),
            (["night.yaml", "d.cube"], ["d.cube.json", "certificate"]),
            (["night.yaml", "p.exr"], ["p.exr", "picture"]),
            (["c.ocio:nigh", "a.ctf"], ["look 'nigh'", "night"]),
            (["c.ocio", "a.ctf"], ["c.ocio:LOOK"]),
            (["missing.ocio:night", "a.ctf"], ["missing.ocio"]),
            (["a.ctf", "a.ctf", "--plot", "no/such/plot.png"], ["no/such/plot.png"]),
            (["a.ctf", "a.ctf", "--json", "no/such/out.json"], ["no/such/out.json"]),
        ]:
            with self.subTest(arguments):
                self.assertFails("compare", *arguments, says=says)
        for arguments in (["a.ctf"], ["a.ctf", "a.ctf", "--tolerance", "-1"], ["a.ctf", "a.ctf", "--statistic", "sum"]):
            self.assertFails("compare", *arguments, code=2)


class Config(LutgenTest):
    def setUp(self):
        super().setUp()
        (self.folder / "night.yaml").write_text(NIGHT)

    def test_bad_input_is_named(self):
        (self.folder / "bad.ocio").write_text("ocio_profile_version: [\n")
        (self.folder / "hp9.yaml").write_text(NIGHT.replace("HP1", "HP9"))
        for arguments, says in [
            (["night.yaml", "-o", "out.ocio", "--base", "bad.ocio"], ["bad.ocio", "YAML"]),
            (["night.yaml", "-o", "out.ocio", "--base", "missing.ocio"], ["missing.ocio"]),
            (["hp9.yaml", "-o", "out.ocio"], ["illuminant 'HP9'", "HP1"]),
            (["missing.yaml", "-o", "out.ocio"], ["missing.yaml"]),
            (["night.yaml", "night.yaml", "-o", "out.ocio"], ["name 'night'"]),
            (["night.yaml", "-o", "no/such/out.ocio"], ["no/such/out.ocio"]),
            (["night.yaml", "-o", "out.ocio", "--lut-folder", "a/b"], ["LUT folder 'a/b'"]),
        ]:
            with self.subTest(arguments):
                self.assertFails("config", *arguments, says=says)
        for arguments in ([], ["night.yaml"], ["-o", "a.ocio"], ["night.yaml", "-o", "a.ocio", "--size", "130"]):
            self.assertFails("config", *arguments, code=2)

    def test_a_file_in_the_place_of_the_folder(self):
        (self.folder / "luts").write_text("mine")
        self.assertFails("config", "night.yaml", "-o", "out.ocio", says=["luts", "folder: cannot be made"])

    def test_name_description_and_family(self):
        self.assertWorks(
            "config", "night.yaml", "-o", "out.ocio", "--size", "5", "--name", "show", "--description", "For the show",
            "--family", "Show", "--lut-folder", "show_luts",
        )
        text = (self.folder / "out.ocio").read_text()
        for part in ("name: show\n", "For the show", "family: Show/Light/D65", "search_path: show_luts\n"):
            self.assertIn(part, text)
        self.assertTrue((self.folder / "show_luts" / "night.ctf").exists())


if __name__ == "__main__":
    unittest.main()
