# SPDX-License-Identifier: Apache-2.0
"""Users' files that once failed: lamps, cameras, LUTs and configs, by the command line."""

import json
import os
import shutil
import unittest
from pathlib import Path

from lutgen import LINKED, LutgenTest, lutgen

TESTS = Path(__file__).parent.parent
SPECTRA = TESTS / "spectral" / "cases"
LUTS = TESTS / "ocio_plugin" / "cases"
CAMERAS = Path(__file__).parent / "cases"
LAMPS = TESTS / "sip" / "lamps"


class Lamps(LutgenTest):
    def bake(self, *arguments):
        return lutgen("bake", "-o", "a.cube", "--size", "9", *arguments, folder=self.folder)

    def test_a_column_on_the_command_line_and_in_a_recipe(self):
        for file in ("two_lamps.csv",):
            shutil.copy(SPECTRA / file, self.folder)
        self.assertEqual(self.bake("--illuminant-in", "D65", "--illuminant-out", "two_lamps.csv:cool").returncode, 0)
        flags = (self.folder / "a.cube").read_bytes()
        certificate = json.loads((self.folder / "a.cube.json").read_text())
        lamp = next(entry for entry in certificate["inputs"] if entry["role"] == "output.illuminant")
        self.assertEqual(len(lamp["sha256"]), 64)
        (self.folder / "r.yaml").write_text(
            "metamer: 1\nname: transform\ninput: {illuminant: D65}\noutput: {illuminant: 'two_lamps.csv:2'}\n")
        self.assertEqual(self.bake("r.yaml").returncode, 0)
        numbers = lambda data: [line for line in data.splitlines() if line[:1].isdigit() or line[:1] == b"-"]
        self.assertEqual(numbers((self.folder / "a.cube").read_bytes()), numbers(flags))
        self.assertFails("bake", "-o", "b.cube", "--illuminant-in", "D65", "--illuminant-out", "two_lamps.csv",
                         says=["two_lamps.csv", "FILE:COLUMN", "warm, cool"])

    def test_notes_are_said_and_certified(self):
        for file, says in ((SPECTRA / "ocean_bare.txt", "7 values below zero set to 0"),
                           (LAMPS / "cfl_with_zeros.csv", "151 of its 316 values")):
            run = self.bake("--illuminant-in", "D65", "--illuminant-out", file)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertTrue(run.stderr.startswith("lutgen: note: output.illuminant " + file.name + ": "), run.stderr)
            self.assertEqual(run.stderr.count("\n"), 1)
            self.assertIn(says, run.stderr)
            notes = json.loads((self.folder / "a.cube.json").read_text())["notes"]
            self.assertEqual(len(notes), 1)
            self.assertIn(says, notes[0])
        self.bake("--illuminant-in", "D65", "--illuminant-out", "A")
        self.assertNotIn("notes", json.loads((self.folder / "a.cube.json").read_text()))

    def test_lines_of_lasers_light(self):
        for name in ("line3.csv", "laser_mixed.csv"):
            run = self.bake("--illuminant-in", "D65", "--illuminant-out", SPECTRA / name)
            self.assertEqual(run.returncode, 0, run.stderr)


class Cameras(LutgenTest):
    def test_collinear_channels(self):
        for file in CAMERAS.iterdir():
            shutil.copy(file, self.folder)
        self.assertFails("bake", "cam_coll.yaml", "-o", "a.ctf", says=["coll.csv", "collinear"])


class Luts(LutgenTest):
    def test_a_reference_to_a_device(self):
        shutil.copy(LUTS / "zero.ctf", self.folder)
        self.assertFails("bake", "--lut", "zero.ctf", "-o", "a.cube", says=["zero.ctf", "/dev/zero", "device"])

    def test_references_that_lead_back(self):
        text = (LUTS / "zero.ctf").read_text()
        (self.folder / "a.ctf").write_text(text.replace("/dev/zero", "b.ctf"))
        (self.folder / "b.ctf").write_text(text.replace("/dev/zero", "a.ctf"))
        (self.folder / "c.ctf").write_text(text.replace("/dev/zero", "c.ctf"))
        os.mkfifo(self.folder / "pipe")
        (self.folder / "d.ctf").write_text(text.replace("/dev/zero", "pipe"))
        for name, says in (("a.ctf", "leads back"), ("c.ctf", "leads back"), ("d.ctf", "pipe"), ("pipe", "pipe")):
            self.assertFails("bake", "--lut", name, "-o", "x.cube", says=[says])

    def test_a_keyword_of_another_program(self):
        shutil.copy(LUTS / "video_range.cube", self.folder)
        self.assertFails("bake", "--lut", "video_range.cube", "-o", "a.clf",
                         says=["video_range.cube", "line 2", "LUT_IN_VIDEO_RANGE", "full range"])

    @unittest.skipIf(LINKED < (2, 6), "files of later releases")
    def test_what_the_newest_ocio_reads(self):
        for name in ("smpte.clf", "two.ccc"):
            shutil.copy(LUTS / name, self.folder)
            self.assertWorks("bake", "--lut", name, "-o", name + ".cube", "--size", "3")
            first = [line for line in (self.folder / (name + ".cube")).read_text().splitlines() if line[:1].isdigit()][2]
            self.assertEqual([float(word) for word in first.split()], [2, 0, 0], name)

    def test_named_transforms_last(self):
        shutil.copy(LUTS / "base_named_last.ocio", self.folder)
        (self.folder / "r.yaml").write_text(
            "metamer: 1\nname: evening\ninput: {illuminant: D65}\noutput: {illuminant: A}\n")
        run = lutgen("config", "r.yaml", "--base", "base_named_last.ocio", "-o", "new.ocio", "--size", "17",
                     folder=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        text = (self.folder / "new.ocio").read_text()
        self.assertTrue(text.index("name: n,") < text.index("evening - Transform") < text.index("looks:"), text)


class Words(LutgenTest):
    def names(self, *arguments):
        return [entry["name"] for entry in json.loads(self.assertWorks("list", *arguments, "--json"))]

    def test_words_find_names(self):
        sodium = self.names("illuminants", "sodium")
        self.assertIn("HP1", sodium)
        self.assertIn("LPS", sodium)
        self.assertNotIn("D65", sodium)
        self.assertIn("A", self.names("illuminants", "tungsten"))
        self.assertIn("FL11", self.names("illuminants", "fluorescent"))
        self.assertIn("HP4", self.names("illuminants", "HMI"))
        self.assertIn("Lee 204 Full C.T. Orange", self.names("filters", "CTO"))
        self.assertEqual(self.names("filters", "full", "ctb"), ["Lee 201 Full C.T. Blue"])
        self.assertFails("list", "illuminants", "bananas", says=["bananas", "lutgen list illuminants"])

    def test_an_unknown_name_answers_with_what_its_words_find(self):
        self.assertFails("bake", "-o", "a.cube", "--illuminant-in", "D65", "--illuminant-out", "sodium",
                         says=["sodium", "HP1", "lutgen list illuminants sodium"])
        self.assertFails("bake", "-o", "a.cube", "--illuminant-in", "D65", "--illuminant-out", "A", "--filter-out", "CTO",
                         says=["Lee 204 Full C.T. Orange"])

    def test_figures_are_computed(self):
        lights = {entry["name"]: entry for entry in json.loads(self.assertWorks("list", "illuminants", "--json"))}
        # CIE 015:2018, tables 5 and 10: 2856 K by definition, 6504 K, 4000 K.
        for name, kelvin, within in (("A", 2856, 1), ("D65", 6504, 2), ("FL11", 4000, 15)):
            self.assertLessEqual(abs(lights[name]["cct"] - kelvin), within, name)
        self.assertLess(abs(lights["A"]["duv"]), 1e-4)
        self.assertGreater(lights["D65"]["duv"], 0.002)
        self.assertEqual((lights["A"]["ssi"], lights["D65"]["ssi"]), (100, 100))
        self.assertEqual(lights["D65"]["ssi_reference"].split()[0], "daylight")
        self.assertLess(lights["HP1"]["ssi"], 60)
        gels = {entry["name"]: entry for entry in json.loads(self.assertWorks("list", "filters", "--json"))}
        # The maker: 6500 K to 3200 K, 3200 K to 5700 K.
        self.assertLess(abs(gels["Lee 204 Full C.T. Orange"]["cct_of_D65"] - 3200), 250)
        self.assertGreater(gels["Lee 201 Full C.T. Blue"]["cct_of_A"], 4000)


if __name__ == "__main__":
    unittest.main()
