# SPDX-License-Identifier: Apache-2.0
"""lutgen's contract with the shell: exit codes, one line of stderr, nothing half-written."""

import json
import os
import unittest

import numpy as np
import OpenEXR

from lutgen import LutgenTest, lutgen

DAY_TO_TUNGSTEN = ["--illuminant-in", "D65", "--illuminant-out", "A"]

RECIPE = """metamer: 1
name: night
space: ACEScg
input: {illuminant: D65}
output: {illuminant: HP1, adaptation: 0.5}
"""


CONFIG = """ocio_profile_version: 2.1
environment: {}
search_path: ""
roles: {aces_interchange: aces, default: aces, scene_linear: aces}
displays:
  d:
    - !<View> {name: v, colorspace: display}
colorspaces:
  - !<ColorSpace> {name: aces, encoding: scene-linear}
  - !<ColorSpace>
    name: plate
    encoding: log
    from_scene_reference: !<BuiltinTransform> {style: ACEScct_to_ACES2065-1, direction: inverse}
  - !<ColorSpace>
    name: display
    encoding: sdr-video
    from_scene_reference: !<ExponentTransform> {value: [2.2, 2.2, 2.2, 1], direction: inverse}
"""


def is_node(line):
    """Whether a line of a table is one of its nodes: numbers, with or without a sign."""
    return line.lstrip("-")[:1].isdigit()


class Help(LutgenTest):
    def test_help_goes_to_stdout(self):
        for arguments in (["--help"], ["bake", "--help"], ["apply", "--help"], ["list", "--help"], ["--version"]):
            self.assertNotEqual(self.assertWorks(*arguments), "")

    def test_usage_errors(self):
        for arguments in (
            [],
            ["bakery"],
            ["bake"],
            ["bake", "-o"],
            ["bake", "--no-such-flag", "-o", "a.cube"],
            ["bake", "-o", "a.cube"],
            ["bake", "-o", "a.cube", "--illuminant-in", "D65"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--size", "33x"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--size", "1"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--size", "2"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--cubesize", "2"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--stdout"],
            ["bake", *DAY_TO_TUNGSTEN, "--stdout"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--tolerance", "0"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--stops", "3"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--stops", "-30", "3"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--space", "ACEScg", "--inputspace", "ACEScct"],
            ["bake", "-o", "a.cube", "--lut", "b.cube", "--iconfig", "c.ocio"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--size", "130"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--size", "1000000"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--adaptation", "2"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--adaptation", "nan"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--tolerance", "inf"],
            ["config", "-o", "a.ocio", "a.yaml", "--tolerance", "nan"],
            ["compare", "a.cube", "b.cube", "--tolerance", "nan"],
            ["validate", "a.yaml", "--tolerance", "nan"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--cat", "cat99"],
            ["bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--balanced", "auto"],
            ["apply", "a.cube", "in.exr"],
            ["list", "lamps"],
        ):
            with self.subTest(arguments):
                self.assertFails(*arguments, code=2)


class List(LutgenTest):
    def test_lists_are_names_by_line_and_json(self):
        for kind, name in [
            ("illuminants", "D65"),
            ("observers", "CIE 1931 2"),
            ("filters", None),
            ("reflectances", "colorchecker"),
            ("spaces", "ACEScct"),
            ("formats", "resolve_cube"),
        ]:
            lines = self.assertWorks("list", kind).splitlines()
            entries = json.loads(self.assertWorks("list", kind, "--json"))
            self.assertEqual([line.split("\t")[0] for line in lines], [entry["name"] for entry in entries])
            self.assertGreater(len(lines), 2)
            if name:
                self.assertIn(name, [entry["name"] for entry in entries])


class Bake(LutgenTest):
    def test_every_format_has_a_certificate_beside_it(self):
        (self.folder / "night.yaml").write_text(RECIPE)
        for name, representation in [
            ("a.ctf", "exposure-invariant chain"),
            ("a.clf", "log cube"),
            ("a.cube", "log cube"),
        ]:
            self.assertWorks("bake", "night.yaml", "-o", name, "--size", "17")
            certificate = json.loads((self.folder / (name + ".json")).read_text())
            self.assertEqual(certificate["transform"]["representation"], representation)
            self.assertEqual(certificate["transform"]["size"], 17)
            self.assertEqual(certificate["recipe"]["name"], "night")
            self.assertEqual(certificate["recipe"]["output"]["adaptation"], 0.5)
            self.assertLessEqual(certificate["error"]["mean"], certificate["error"]["max"])
        self.assertEqual(len(list(self.folder.iterdir())), 7)

    def test_overrides_say_the_same_as_a_recipe(self):
        (self.folder / "night.yaml").write_text(RECIPE)
        self.assertWorks("bake", "night.yaml", "-o", "a.cube")
        self.assertWorks(
            "bake", "-o", "b.cube", "--name", "night", "--illuminant-in", "D65", "--illuminant-out", "HP1",
            "--adaptation", "0.5",
        )
        self.assertEqual((self.folder / "a.cube").read_bytes(), (self.folder / "b.cube").read_bytes())
        self.assertEqual((self.folder / "a.cube.json").read_bytes(), (self.folder / "b.cube.json").read_bytes())

    def test_ociobakeluts_flags_mean_the_same(self):
        self.assertWorks("bake", *DAY_TO_TUNGSTEN, "--space", "ACEScg", "--size", "9", "--shaper", "LogC3", "-o", "a.cube")
        self.assertWorks(
            "bake", *DAY_TO_TUNGSTEN, "--inputspace", "ACEScg", "--outputspace", "ACEScg", "--cubesize", "9",
            "--shaperspace", "LogC3", "--shapersize", "1024", "--format", "iridas_cube", "-o", "b.cube",
        )
        self.assertEqual((self.folder / "a.cube").read_bytes(), (self.folder / "b.cube").read_bytes())
        text = self.assertWorks("bake", *DAY_TO_TUNGSTEN, "--cubesize", "9", "--shaperspace", "LogC3", "--format",
                                "iridas_cube", "--stdout", "--quiet")
        numbers = [line for line in text.splitlines() if is_node(line)]
        written = [line for line in (self.folder / "a.cube").read_text().splitlines() if is_node(line)]
        self.assertEqual(numbers, written)
        self.assertEqual(len(numbers), 9**3)
        self.assertFails(
            "bake", *DAY_TO_TUNGSTEN, "--inputspace", "ACEScg", "--outputspace", "ACEScct", "-o", "c.cube",
            says=["ACEScct", "stays in its space, ACEScg"],
        )

    def test_a_lut_file_in_another_format(self):
        self.assertWorks("bake", *DAY_TO_TUNGSTEN, "--size", "9", "-o", "a.cube")
        self.assertWorks("bake", "--lut", "a.cube", "--cubesize", "9", "-o", "b.spi3d")
        nodes = [line.split() for line in (self.folder / "a.cube").read_text().splitlines() if is_node(line)]
        self.assertEqual(len(nodes), 9**3)
        # Red runs fastest in one, blue in the other.
        found = {tuple(map(int, line.split()[:3])): line.split()[3:]
                 for line in (self.folder / "b.spi3d").read_text().splitlines()[3:]}
        for index, node in enumerate(nodes):
            self.assertEqual(found[index % 9, index // 9 % 9, index // 81], node)
        self.assertFails("bake", "--lut", "missing.cube", "-o", "c.cube", says=["missing.cube"])
        (self.folder / "noise.cube").write_text("LUT_3D_SIZE banana\n")
        self.assertFails("bake", "--lut", "noise.cube", "-o", "c.cube", says=["noise.cube", "cannot be read"])

    def test_config_in_place_of_the_environment(self):
        self.assertFails("bake", *DAY_TO_TUNGSTEN, "--iconfig", "missing.ocio", "-o", "a.cube", says=["missing.ocio"])
        (self.folder / "studio.ocio").write_text(CONFIG)
        self.assertWorks(
            "bake", *DAY_TO_TUNGSTEN, "--iconfig", "studio.ocio", "--space", "plate", "--size", "9", "-o", "a.cube"
        )
        certificate = json.loads((self.folder / "a.cube.json").read_text())
        self.assertEqual(certificate["recipe"]["space"], "plate")
        # A picture space is no signal to tabulate over.
        self.assertFails(
            "bake", *DAY_TO_TUNGSTEN, "--iconfig", "studio.ocio", "--space", "display", "-o", "b.cube",
            says=["space 'display'", "neither linear nor log", "name a log space, or write .ctf"],
        )

    def test_tolerance_says_what_was_tried(self):
        lines = self.assertWorks("bake", *DAY_TO_TUNGSTEN, "--tolerance", "3", "-o", "a.ctf").splitlines()
        self.assertRegex(lines.pop(), r"^a\.ctf: exposure-invariant chain of [0-9]+ nodes, p99 [0-9.]+, [0-9.]+ s$")
        self.assertRegex(lines[0], "^identity: p99 ")
        self.assertRegex(lines[1], "^matrix: p99 ")
        self.assertRegex(lines[-1], "^exposure-invariant chain of [0-9]+ nodes: .*, chosen$")
        certificate = json.loads((self.folder / "a.ctf.json").read_text())
        self.assertEqual(len(certificate["transform"]["choice"]["tried"]), len(lines))
        self.assertLessEqual(certificate["error"]["p99"], 3)
        self.assertIn("the next cheaper, ", (self.folder / "a.ctf").read_text())
        self.assertFails(
            "bake", *DAY_TO_TUNGSTEN, "--tolerance", "0.001", "--size", "9", "-o", "b.cube",
            says=["tolerance '0.001'", "log cube of 9 nodes", "write .ctf"],
        )

    def test_sampled_nodes_are_another_file(self):
        self.assertWorks("bake", *DAY_TO_TUNGSTEN, "--size", "17", "-o", "a.cube")
        run = lutgen("bake", *DAY_TO_TUNGSTEN, "--size", "17", "--sampled", "-o", "b.cube", folder=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        # Nodes whose exact value is far below zero pull what lies beside them along: the certificate says so.
        self.assertRegex(run.stderr, r"^lutgen: note: a pixel of the kind '[a-z ]+' ends [0-9.]+ times its own size")
        fitted, sampled = (json.loads((self.folder / f"{n}.cube.json").read_text()) for n in "ab")
        self.assertEqual([c["transform"]["nodes"] for c in (fitted, sampled)], ["fitted", "sampled"])
        self.assertLess(fitted["error"]["p99"], sampled["error"]["p99"])

    def test_a_full_certificate_knows_the_truth(self):
        run = lutgen("bake", *DAY_TO_TUNGSTEN, "--size", "9", "--certify", "full", "-o", "a.cube", folder=self.folder)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        certificate = json.loads((self.folder / "a.cube.json").read_text())
        for surfaces in certificate["surfaces"]["sets"]:
            self.assertLess(surfaces["engine"], surfaces["plain_adaptation"], surfaces["set"])
        self.assertIn("measured surfaces that it does not know", (self.folder / "a.cube").read_text())
        self.assertGreater(certificate["error"]["count"], 40000)
        run = lutgen("bake", *DAY_TO_TUNGSTEN, "--scene", "mallett", "--size", "9", "--certify", "full", "-o", "b.cube",
                     folder=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        uplift = json.loads((self.folder / "b.cube.json").read_text())
        self.assertEqual(uplift["recipe"]["scene"], {"kind": "mallett"})
        self.assertEqual(len(uplift["surfaces"]["sets"]), len(certificate["surfaces"]["sets"]))
        self.assertEqual(lutgen("bake", *DAY_TO_TUNGSTEN, "--certify", "most", "-o", "b.cube", folder=self.folder).returncode, 2)

    def test_what_is_large_is_said_at_once(self):
        run = lutgen("bake", "--illuminant-in", "FL11", "--illuminant-out", "D65", "--adaptation", "1", "--size", "9", "-o",
                     self.folder / "a.ctf")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stderr, r"note: saturated lights grow up to 3\.\d times as bright against white\n")
        run = lutgen("bake", "--illuminant-in", "D65", "--illuminant-out", "D50", "-o", self.folder / "b.ctf")
        self.assertEqual(run.stderr, "")

    def test_an_inverse_is_refused_with_what_to_do(self):
        file = self.folder / "back.ctf"
        run = lutgen("bake", "--illuminant-in", "D65", "--illuminant-out", "A", "--inverse", "-o", file)
        self.assertEqual(run.returncode, 1)
        self.assertIn("exchange input and output", run.stderr)
        self.assertEqual(run.stderr.count("\n"), 1)
        self.assertFalse(file.exists())

    def test_filters_shaper_scene(self):
        (self.folder / "gel.csv").write_text("nm,transmittance\n380,0.9\n580,0.2\n780,0.8\n")
        self.assertWorks(
            "bake", "-o", "a.cube", *DAY_TO_TUNGSTEN, "--filter-out", "gel.csv:0.5", "--filter-out", "gel.csv",
            "--shaper", "LogC3", "--scene", "skin:0.5", "--keep-exposure", "--size", "9",
        )
        certificate = json.loads((self.folder / "a.cube.json").read_text())
        self.assertEqual([f["density"] for f in certificate["recipe"]["output"]["filters"]], [0.5, 1.0])
        self.assertEqual(certificate["transform"]["shaper"], "LogC3")
        self.assertEqual(certificate["recipe"]["scene"], {"kind": "skin", "strength": 0.5, "fade": 2.5})
        self.assertNotIn(str(self.folder), (self.folder / "a.cube.json").read_text())

    def test_display_shaper(self):
        """A sampled table's nodes are display signals of what the engine makes of the light of theirs."""
        curves = {
            "sRGB": (lambda s: np.where(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055) ** 2.4),
                     lambda x: np.where(abs(x) <= 0.0031308, 12.92 * x, np.sign(x) * (1.055 * abs(x) ** (1 / 2.4) - 0.055))),
            "Rec.1886": (lambda s: s**2.4, lambda x: np.sign(x) * abs(x) ** (1 / 2.4)),
        }
        side = np.linspace(0, 1, 5)
        nodes = np.stack(np.meshgrid(side, side, side, indexing="ij"), -1)[..., ::-1].reshape(-1, 3)
        for name, (decode, encode) in curves.items():
            with self.subTest(name):
                self.assertWorks("bake", *DAY_TO_TUNGSTEN, "--space", "Rec.709", "--shaper", name, "--sampled", "--size", 5,
                                 "-o", "a.cube")
                certificate = json.loads((self.folder / "a.cube.json").read_text())
                self.assertEqual(certificate["transform"]["shaper"], name)
                self.assertEqual(certificate["range"]["largest_component"], 1)
                self.assertNotIn("notes", certificate)
                lines = (self.folder / "a.cube").read_text().splitlines()
                table = np.array([line.split() for line in lines if line[:1] in "-0123456789" and line], float)
                OpenEXR.File({}, {"RGB": decode(nodes)[None].astype(np.float32)}).write(str(self.folder / "a.exr"))
                (self.folder / "a.yaml").write_text(
                    "metamer: 1\nname: a\nspace: Rec.709\ninput: {illuminant: D65}\noutput: {illuminant: A}\n")
                self.assertWorks("apply", "a.yaml", "a.exr", "b.exr", "--picture-space", "Rec.709")
                light = OpenEXR.File(str(self.folder / "b.exr")).channels()["RGB"].pixels[0].astype(float)
                # Bands: 161 in a table, 401 in apply.
                np.testing.assert_allclose(table, encode(light), atol=2e-3)
        # A fitted table keeps within what its sampled figures allow, and says so.
        self.assertWorks("bake", *DAY_TO_TUNGSTEN, "--space", "Rec.709", "--shaper", "sRGB", "-o", "a.cube")
        self.assertLess(json.loads((self.folder / "a.cube.json").read_text())["error"]["p99"], 1)
        self.assertIn("passed", self.assertWorks("compare", "a.yaml", "a.cube"))
        run = lutgen("bake", *DAY_TO_TUNGSTEN, "--shaper", "gamma 2.2", "--size", 5, "-o", "a.cube", folder=self.folder)
        self.assertIn("note: the signals are ACEScg by the curve Gamma 2.2", run.stderr)
        self.assertFails("bake", *DAY_TO_TUNGSTEN, "--shaper", "sRGB", "-o", "b.clf", says=["shaper 'sRGB'", "linear", ".cube"])

    def test_bad_input_is_named(self):
        (self.folder / "zero.csv").write_text("nm,transmittance\n380,0\n780,0\n")
        (self.folder / "bad.yaml").write_text(RECIPE.replace("illuminant: HP1", "illuminant: HP9"))
        (self.folder / "typo.yaml").write_text(RECIPE.replace("space", "spcae"))
        (self.folder / "nan.yaml").write_text(RECIPE.replace("0.5", ".nan"))
        for arguments, says in [
            (["--illuminant-in", "D66", "--illuminant-out", "A"], ["illuminant 'D66'", "D65"]),
            (["bad.yaml"], ["illuminant 'HP9'", "HP1"]),
            (["typo.yaml"], ["typo.yaml:3", "spcae", "space"]),
            (["nan.yaml"], ["nan.yaml:5", "adaptation", "0 to 1"]),
            (["missing.yaml"], ["missing.yaml"]),
            ([*DAY_TO_TUNGSTEN, "--filter-out", "zero.csv"], ["filters", "stop all the light"]),
            ([*DAY_TO_TUNGSTEN, "--filter-out", "missing.csv"], ["missing.csv"]),
            ([*DAY_TO_TUNGSTEN, "--observer-in", "CIE 1931 3"], ["observer 'CIE 1931 3'", "CIE 1931 2"]),
            ([*DAY_TO_TUNGSTEN, "--space", "ACEScgg"], ["space 'ACEScgg'", "ACEScg"]),
            ([*DAY_TO_TUNGSTEN, "--shaper", "log"], ["shaper 'log'", "ACEScct"]),
            ([*DAY_TO_TUNGSTEN, "--shaper", "linear"], ["shaper 'linear'", "is no curve", "ACEScct"]),
            (["--illuminant-in", "FL99", "--illuminant-out", "A"], ["illuminant 'FL99'", "FL9"]),
            ([*DAY_TO_TUNGSTEN, "--scene", "dataset:nothing"], ["nothing", "list reflectances"]),
            ([*DAY_TO_TUNGSTEN, "--scene", "otsu"], ["otsu", "jumps", "jakob"]),
            ([*DAY_TO_TUNGSTEN, "--scene", "jakob:1"], ["jakob:1", "smits, mallett, jakob or meng"]),
        ]:
            with self.subTest(arguments):
                self.assertFails("bake", *arguments, "-o", "out.cube", says=says)

    def test_shader_files(self):
        self.assertWorks("bake", *DAY_TO_TUNGSTEN, "-o", "a.metal")
        self.assertIn("metamerMapPixels", (self.folder / "a.metal").read_text(encoding="utf-8"))
        certificate = json.loads((self.folder / "a.metal.json").read_text(encoding="utf-8"))
        self.assertEqual(certificate["transform"]["representation"], "homogeneous map")
        text = self.assertWorks("bake", *DAY_TO_TUNGSTEN, "--stdout", "--format", "glsl", "--quiet")
        self.assertIn("#version 430", text)
        self.assertWorks("bake", *DAY_TO_TUNGSTEN, "-o", "a.dctl")
        self.assertIn("DEFINE_CUBE_LUT(metamerTable)", (self.folder / "a.dctl").read_text(encoding="utf-8"))
        for options, word in ((["--size", "33"], "size"), (["--shaper", "LogC3"], "shaper"), (["--sampled"], "sampled")):
            self.assertFails("bake", *DAY_TO_TUNGSTEN, *options, "-o", "b.cl", says=[word, ".cl", "leave it out"])
        self.assertFails("bake", *DAY_TO_TUNGSTEN, "-o", "b.cl", "--format", "glsl", says=["*.glsl"])
        self.assertFalse((self.folder / "b.cl").exists())

    def test_unknown_extension_and_format(self):
        self.assertFails("bake", *DAY_TO_TUNGSTEN, "-o", "a.png", says=["'.png'", "resolve_cube", ".glsl"])
        self.assertFails("bake", *DAY_TO_TUNGSTEN, "-o", "a.clf", "--format", "resolve_cube", says=["*.cube"])

    def test_places_that_cannot_be_written(self):
        self.assertFails("bake", *DAY_TO_TUNGSTEN, "-o", "no/such/a.cube", says=["no/such/a.cube", "cannot be written"])
        self.assertFails("bake", *DAY_TO_TUNGSTEN, "-o", ".", "--format", "iridas_cube", says=["."])
        locked = self.folder / "locked"
        locked.mkdir()
        locked.chmod(0o500)
        if os.geteuid() != 0:
            self.assertFails("bake", *DAY_TO_TUNGSTEN, "-o", "locked/a.cube", says=["locked/a.cube"])
        locked.chmod(0o700)

    def test_an_earlier_file_survives_a_failure(self):
        (self.folder / "a.cube").write_text("mine")
        self.assertFails("bake", "--illuminant-in", "D65", "--illuminant-out", "nothing", "-o", "a.cube")
        self.assertEqual((self.folder / "a.cube").read_text(), "mine")

    def test_config_that_does_not_parse(self):
        (self.folder / "bad.ocio").write_text("ocio_profile_version: [\n")
        for config in ("bad.ocio", "missing.ocio"):
            self.assertFails(
                "bake", *DAY_TO_TUNGSTEN, "--space", "studio", "-o", "a.cube",
                environment={"OCIO": str(self.folder / config)}, says=["$OCIO", config],
            )


class DataFolder(LutgenTest):
    def test_missing_data_is_named(self):
        self.assertFails("list", "illuminants", environment={"METAMER_DATA": "/nonexistent"}, says=["/nonexistent"])


if __name__ == "__main__":
    unittest.main()
