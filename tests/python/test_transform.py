# SPDX-License-Identifier: Apache-2.0
"""Recipes and transforms: what they say, and that they are lutgen's own to the bit."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

import metamer

LUTGEN = Path(os.environ.get("METAMER_BIN", "/nowhere")) / "lutgen"

TEXT = """\
metamer: 1
name: day_to_sodium
space: ACEScg
input: {illuminant: D65}
output: {illuminant: HP1, filters: [{name: Lee 204 Full C.T. Orange, density: 0.5}], adaptation: 0.25}
cat: bradford
"""


class Recipes(unittest.TestCase):
    def test_fields(self):
        recipe = metamer.Recipe("D65", "HP1", filters_out=[("Lee 204 Full C.T. Orange", 0.5)], adaptation=0.25, cat="bradford",
                                name="day_to_sodium")
        self.assertEqual(recipe.yaml(), metamer.Recipe.parse(TEXT).yaml())
        self.assertEqual((recipe.name, recipe.space, recipe.illuminant_in, recipe.illuminant_out, recipe.adaptation,
                          recipe.cat, recipe.keep_exposure),
                         ("day_to_sodium", "ACEScg", "D65", "HP1", 0.25, "bradford", False))
        self.assertEqual(recipe.filters_out, [("Lee 204 Full C.T. Orange", 0.5)])

    def test_file(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "recipe.yaml"
            (Path(folder) / "gel.csv").write_text("wavelength,gel\n380,0.1\n780,0.9\n")
            file.write_text(TEXT.replace("name: Lee 204 Full C.T. Orange", "file: gel.csv"))
            for given in (metamer.Recipe.read(file), file, str(file)):
                self.assertFalse(metamer.Transform(given).is_identity)

    def test_refused(self):
        for what, call, error, message in (
            ("missing file", lambda: metamer.Recipe.read("gone.yaml"), FileNotFoundError, "gone.yaml"),
            ("missing file", lambda: metamer.Transform("gone.yaml"), FileNotFoundError, "gone.yaml"),
            ("unknown field", lambda: metamer.Recipe("D65", "A", spaec="ACEScg"), ValueError, "spaec"),
            ("out of range", lambda: metamer.Recipe("D65", "A", adaptation=2), ValueError, "adaptation"),
            ("unknown light", lambda: metamer.Transform(metamer.Recipe("D65", "HP12")), ValueError, "HP12.*HP1"),
            ("no recipe", lambda: metamer.Transform(3), TypeError, "Recipe"),
            ("filter", lambda: metamer.Recipe("D65", "A", filters_in=[("Lee 204 Full C.T. Orange", 1, 2)]), ValueError, "density"),
            ("no light", lambda: metamer.Transform(metamer.Recipe({400: 0, 700: 0}, "A")), ValueError, "light"),
        ):
            with self.subTest(what):
                with self.assertRaisesRegex(error, message):
                    call()


class Transforms(unittest.TestCase):
    def test_spectra_stand_for_names(self):
        library = metamer.Library()
        pixels = np.random.default_rng(1).uniform(0, 1, (50, 3))
        named = metamer.Recipe("D65", "A", filters_in=["Lee 201 Full C.T. Blue", ("Lee 204 Full C.T. Orange", 0.5)], observer_out="CIE 1964 10")
        given = metamer.Recipe(library.illuminant("D65"), library.illuminant("A"),
                               filters_in=[library.filter("Lee 201 Full C.T. Blue"), ("Lee 204 Full C.T. Orange", 0.5)],
                               observer_out=library.observer("CIE 1964 10"))
        np.testing.assert_array_equal(metamer.Transform(given)(pixels), metamer.Transform(named)(pixels))

    def test_properties(self):
        transform = metamer.Transform(metamer.Recipe("D65", "A"), bands=41)
        self.assertEqual((transform.bands, transform.is_identity), (41, False))
        np.testing.assert_array_equal(transform.wavelengths, np.linspace(380, 780, 41))
        self.assertEqual(transform.matrix.shape, (3, 3))
        value, matrix = transform.linearise([0.2, 0.3, 0.4])
        np.testing.assert_allclose(matrix @ [0.2, 0.3, 0.4], value, rtol=1e-9)  # homogeneity
        np.testing.assert_allclose(value, transform([0.2, 0.3, 0.4]), rtol=1e-12)
        reflectance = transform.reflectance([0.2, 0.3, 0.4])
        self.assertEqual(reflectance.shape, (41,))
        self.assertGreaterEqual(transform.diagnostics["condition_number"], 1)
        np.testing.assert_allclose(transform.response_from_rgb @ [1, 1, 1], [1, 1, 1], rtol=1e-9)
        self.assertTrue(metamer.Transform(metamer.Recipe("D65", "D65")).is_identity)

    def test_map(self):
        transform = metamer.Transform(metamer.Recipe("D65", "HP1"))
        fine, coarse = transform.map(0.05), transform.map(tolerance=2)
        self.assertGreater(fine.patches, coarse.patches)
        self.assertGreater(fine.bytes, 0)
        self.assertGreater(fine.solves, 0)
        self.assertGreater(coarse.largest_error, 0)

    def test_protocol(self):
        recipe = metamer.Recipe("D65", "HP1")
        protocol = metamer.ErrorProtocol(recipe, chromaticities=64, ring=8)
        transform = metamer.Transform(recipe)
        report = protocol.measure(transform.map())
        self.assertEqual(report.count, len(protocol.probes) * 21)
        self.assertLess(report.p99, 0.2)
        self.assertTrue(report.worst_probe)
        # A Python function is judged as the map that it calls is, in place or not.
        by_function = protocol.measure(transform.map())
        self.assertEqual((by_function.mean, by_function.max), (report.mean, report.max))
        called = transform.map()
        self.assertEqual(protocol.measure(lambda pixels: called(pixels)).max, report.max)
        self.assertEqual(protocol.measure(lambda pixels: called(pixels, out=pixels) is None or None).max, report.max)
        self.assertGreater(protocol.measure(lambda pixels: pixels).mean, 1)
        self.assertLess(protocol.measure(protocol.converged).max, 1e-3)
        comparison = protocol.compare(transform, lambda pixels: 1.01 * pixels)
        self.assertEqual(comparison.max, comparison.delta_e.max())
        np.testing.assert_array_equal(comparison.worst_rgb, comparison.rgb[comparison.delta_e.argmax()])
        self.assertLess(protocol.measure(transform.map(), against=transform).p99, 0.2)

        def broken(pixels):
            raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            protocol.measure(broken)
        with self.assertRaisesRegex(ValueError, "shape"):
            protocol.measure(lambda pixels: pixels[:-1])


@unittest.skipUnless(LUTGEN.is_file(), "no lutgen in $METAMER_BIN")
class AsLutgen(unittest.TestCase):
    """Every pixel has the bits that `lutgen apply` writes."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def lutgen(self, pixels, recipe, *options):
        import OpenEXR

        (self.folder / "recipe.yaml").write_text(recipe.yaml())
        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        with OpenEXR.File(header, {"RGBA": pixels}) as picture:
            picture.write(str(self.folder / "in.exr"))
        subprocess.run([LUTGEN, "apply", "recipe.yaml", "in.exr", "out.exr", *options], cwd=self.folder, check=True)
        with OpenEXR.File(str(self.folder / "out.exr")) as picture:
            return picture.channels()["RGBA"].pixels

    def test_bits(self):
        random = np.random.default_rng(3)
        pixels = (random.normal(0.3, 0.4, (64, 97, 4)) * random.choice([1e-3, 1, 50], (64, 97, 1))).astype(np.float32)
        pixels[..., 3] = random.uniform(0, 1, (64, 97))
        for space in ("ACEScg", "ACEScct"):
            recipe = metamer.Recipe("D65", "FL11", space=space, adaptation=0.5)
            transform = metamer.Transform(recipe)
            with self.subTest(space=space):
                np.testing.assert_array_equal(transform(pixels), self.lutgen(pixels, recipe))
                np.testing.assert_array_equal(transform.map()(pixels), self.lutgen(pixels, recipe, "--engine", "map"))
        same = metamer.Recipe("D65", "D65", space="ACEScct")
        np.testing.assert_array_equal(metamer.Transform(same)(pixels), pixels)


if __name__ == "__main__":
    unittest.main()
