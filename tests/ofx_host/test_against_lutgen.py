# SPDX-License-Identifier: Apache-2.0
"""The plug-in, in a host on OpenFX's HostSupport, against lutgen apply: the same recipes on the same pixels."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

REPOSITORY = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(REPOSITORY / "demo"))
import pictures  # noqa: E402

BIN = Path(os.environ["METAMER_BIN"])
BUNDLES = BIN.parent / "OFX"
TRANSFER = "org.metamer.SpectralTransfer"

# Tables of the map are the same on both sides, and so is the arithmetic: the bound of a float's last bits is met with
# equality, but only this much is promised.
MAP_TOLERANCE = 1e-6


def hard_pixels():
    """Black, negatives, beyond the locus, denormals, the ends of half and float, what is no number."""
    values = [0.0, -0.0, 1.0, 0.18, -0.18, 1e-41, -1e-41, 65504.0, -65504.0, 1e-30, 1e30, -1e30, np.nan, np.inf, -np.inf]
    generator = np.random.default_rng(2026)
    picked = generator.choice(np.array(values, np.float32), size=(61, 67, 3))
    wide = generator.normal(size=(61, 67, 3)).astype(np.float32) * np.exp2(generator.integers(-20, 20, (61, 67, 1)))
    return np.where(generator.random((61, 67, 1)) < 0.5, picked, wide.astype(np.float32))


def with_alpha(rgb):
    return np.dstack([rgb, np.linspace(0, 1, rgb.shape[0] * rgb.shape[1]).reshape(rgb.shape[:2])]).astype(np.float32)


class AgainstLutgen(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def plugin(self, rgba, settings, plugin=TRANSFER, **options):
        """The effect's result and what it says."""
        height, width = rgba.shape[:2]
        source, result = self.folder / "in.f32", self.folder / "out.f32"
        np.ascontiguousarray(rgba[::-1]).tofile(source)
        words = [BIN / "metamer_ofx_render", BUNDLES, plugin, width, height, source, result]
        for name, value in options.items():
            words += [f"--{name}", value]
        for name, value in settings.items():
            words += ["--set", f"{name}={value}"]
        run = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=600)
        self.assertEqual(run.returncode, 0, run.stderr)
        return np.fromfile(result, np.float32).reshape(height, width, 4)[::-1], run.stderr

    made = {}

    def lutgen(self, rgb, recipe, engine):
        """lutgen apply's result, computed once a recipe, engine and picture: tiles and threads are the plug-in's alone."""
        key = (Path(recipe).read_text(), engine, rgb.tobytes())
        if key not in self.made:
            self.made[key] = self.applied(rgb, recipe, engine)
        return self.made[key]

    def applied(self, rgb, recipe, engine):
        source, result = self.folder / "in.exr", self.folder / "out.exr"
        pictures.write_exr(source, rgb)
        # The pixels are the recipe's, whatever the helper's header says.
        space = re.search(r"^space: (.+)$", Path(recipe).read_text(), re.M)
        subprocess.run([BIN / "lutgen", "apply", "--quiet", "--engine", engine, recipe, source, result, "--picture-space",
                        space[1] if space else "ACEScg"], check=True, timeout=600)
        return pictures.read_exr(result)

    def recipe(self, text):
        file = self.folder / "recipe.yaml"
        file.write_text("metamer: 1\n" + text)
        return file

    def assertAgree(self, rgb, settings, recipe, threads=1, tile=1 << 20):
        rgba = with_alpha(rgb)
        exact, message = self.plugin(rgba, {**settings, "quality": "Exact"}, threads=threads, tile=tile)
        self.assertEqual(message, "")
        np.testing.assert_array_equal(exact[..., :3], self.lutgen(rgb, recipe, "exact"))
        np.testing.assert_array_equal(exact[..., 3], rgba[..., 3])
        table, _ = self.plugin(rgba, settings, threads=threads, tile=tile)
        expected = self.lutgen(rgb, recipe, "map")
        np.testing.assert_allclose(table[..., :3], expected, rtol=MAP_TOLERANCE, atol=MAP_TOLERANCE)
        np.testing.assert_array_equal(table[..., 3], rgba[..., 3])
        self.assertGreater(np.nanmax(np.abs(exact[..., :3] - rgb)), 0.01, "nothing was changed")

    def test_photograph_by_menus(self):
        recipe = self.recipe(
            "space: ACEScg\ninput: {illuminant: D65}\n"
            "output: {illuminant: HP1, filters: [{name: Lee 205 Half C.T. Orange, density: 0.5}], adaptation: 0.25}\n"
            "keep_exposure: true\ncat: bradford\n"
        )
        settings = {
            "outputIlluminant": "HP1", "outputFilter": "Lee 205 Half C.T. Orange", "outputDensity": 0.5,
            "adaptation": 0.25, "keepExposure": 1, "cat": "bradford",
        }
        self.assertAgree(pictures.photograph("astronaut.png")[::2, ::2], settings, recipe, threads=2, tile=173)

    def test_hard_pixels_whatever_the_tiles_and_threads(self):
        recipe = self.recipe("input: {illuminant: 5600 K}\noutput: {illuminant: FL11, adaptation: 0.5}\n")
        settings = {"inputIlluminant": "Blackbody", "outputIlluminant": "FL11", "adaptation": 0.5}
        pixels = hard_pixels()
        # Beyond the largest float the two sides may differ in nothing but the sign of what overflows: kept out.
        for threads, tile in ((1, 1 << 20), (2, 13), (7, 1), (3, 1000)):
            with self.subTest(threads=threads, tile=tile):
                self.assertAgree(pixels, settings, recipe, threads, tile)

    def test_recipe_file_overrides_the_menus(self):
        gel = self.folder / "gel.csv"
        gel.write_text("wavelength,transmittance\n400,0.9\n550,0.2\n700,0.8\n")
        recipe = self.recipe(
            "space: ACEScct\ninput: {illuminant: daylight 6000 K}\n"
            "output: {illuminant: LED-RGB1, filters: [{file: gel.csv}], adaptation: 1}\n"
        )
        signal = np.clip(pictures.photograph("astronaut.png")[::2, ::2] + 0.05, 0, 1)
        self.assertAgree(signal, {"recipeFile": recipe, "outputIlluminant": "HP2", "space": "Rec.709"}, recipe, threads=2)

    def test_scenes_and_observers(self):
        rgb = pictures.photograph("astronaut.png")[::4, ::4]
        for scene, settings in (
            ("{kind: dataset, set: colorchecker}", {"scene": "Data set"}),
            ("{kind: skin, strength: 0.7}", {"scene": "Skin", "priorStrength": 0.7}),
            ("{kind: smooth}", {"scene": "Smooth"}),
            ("{kind: natural}", {}),
        ):
            with self.subTest(scene=scene):
                recipe = self.recipe(
                    "space: Rec.2020\ninput: {illuminant: D50, observer: CIE 1964 10}\n"
                    f"output: {{illuminant: A, observer: Nikon D5100}}\nscene: {scene}\n"
                )
                self.assertAgree(rgb, {
                    "space": "Rec.2020", "inputIlluminant": "D50", "inputObserver": "CIE 1964 10",
                    "outputIlluminant": "A", "outputObserver": "Nikon D5100", **settings}, recipe)

    def test_a_saved_project_comes_back_even_where_menus_have_grown(self):
        rgba = with_alpha(pictures.photograph("astronaut.png")[::4, ::4])
        project = self.folder / "project.txt"
        expected, _ = self.plugin(rgba, {
            "inputIlluminant": "CIE daylight", "inputTemperature": 5003.25, "outputIlluminant": "HP1", "adaptation": 0.3,
            "outputFilter": "Lee 201 Full C.T. Blue", "cat": "cat16", "mix": 0.9}, save=project)
        reloaded, message = self.plugin(rgba, {}, load=project)
        self.assertEqual(message, "")
        np.testing.assert_array_equal(reloaded, expected)
        # Another release's lists: every position is off by one, the names stand.
        lines = project.read_text().splitlines()
        menus = {line.split("Name=")[0] for line in lines if "Name=" in line}
        moved = [f"{name}={int(value) + 1}" if name in menus else f"{name}={value}"
                 for name, value in (line.split("=", 1) for line in lines)]
        self.assertNotEqual(moved, lines)
        project.write_text("\n".join(moved) + "\n")
        reloaded, message = self.plugin(rgba, {}, load=project)
        self.assertEqual(message, "")
        np.testing.assert_array_equal(reloaded, expected)

    def test_half_pictures_are_the_float_result_rounded(self):
        rgb = pictures.photograph("astronaut.png")[::4, ::4].astype(np.float16).astype(np.float32)
        settings = {"outputIlluminant": "A"}
        rgba = np.dstack([rgb, np.ones(rgb.shape[:2], np.float32)])
        expected, _ = self.plugin(rgba, settings)
        half, _ = self.plugin(rgba, settings, depth="Half")
        np.testing.assert_array_equal(half, expected.astype(np.float16).astype(np.float32))


if __name__ == "__main__":
    unittest.main()
