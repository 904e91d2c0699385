# SPDX-License-Identifier: Apache-2.0
"""Spectra, observers and the library, from names, files, dicts and colour-science."""

import os
import tempfile
import unittest
from pathlib import Path

import numpy as np

import metamer

try:
    import colour
except ImportError:
    colour = None


class Spectra(unittest.TestCase):
    def test_samples(self):
        spectrum = metamer.Spectrum([400, 500, 600], [0.1, 0.5, 0.3], quantity="reflectance", name="leaf")
        self.assertEqual((spectrum.name, spectrum.quantity, len(spectrum)), ("leaf", "reflectance", 3))
        np.testing.assert_array_equal(spectrum.wavelengths, [400, 500, 600])
        np.testing.assert_array_equal(spectrum.values, [0.1, 0.5, 0.3])
        self.assertAlmostEqual(spectrum(450), 0.3)
        np.testing.assert_allclose(spectrum([300, 550, 700]), [0.1, 0.4, 0.3])
        self.assertIn("leaf", repr(spectrum))

    def test_dict(self):
        spectrum = metamer.Spectrum.of({600: 0.3, 400: 0.1, 500: 0.5}, quantity="reflectance")
        np.testing.assert_array_equal(spectrum.wavelengths, [400, 500, 600])
        np.testing.assert_array_equal(spectrum.values, [0.1, 0.5, 0.3])

    def test_refused(self):
        for what, call, error, message in (
            ("falling", lambda: metamer.Spectrum([500, 400], [1, 1], quantity="power"), ValueError, "400"),
            ("negative", lambda: metamer.Spectrum([400, 500], [1, -1], quantity="power"), ValueError, "-1"),
            ("not finite", lambda: metamer.Spectrum([400, 500], [1, np.nan], quantity="power"), ValueError, "nan"),
            ("one sample", lambda: metamer.Spectrum([400], [1], quantity="power"), ValueError, ""),
            ("another length", lambda: metamer.Spectrum([400, 500], [1], quantity="power"), ValueError, ""),
            ("two axes", lambda: metamer.Spectrum([[400, 500]], [[1, 1]], quantity="power"), ValueError, "one number"),
            ("quantity", lambda: metamer.Spectrum([400, 500], [1, 1], quantity="colour"), ValueError, "reflectance"),
            ("no spectrum", lambda: metamer.Spectrum.of(3, quantity="power"), TypeError, "int"),
            ("wrong quantity", lambda: metamer.Recipe(metamer.Library().filter("Lee 204 Full C.T. Orange"), "D65"), ValueError,
             "transmittance"),
            ("unknown name", lambda: metamer.Library().illuminant("D56"), ValueError, "D55|D65"),
            ("missing file", lambda: metamer.Library().filter("no/such/gel.csv"), FileNotFoundError, "no/such/gel.csv"),
            ("missing file", lambda: metamer.Spectrum.read("gone.csv", quantity="power"), FileNotFoundError, "gone.csv"),
            ("missing folder", lambda: metamer.Library("no/such/folder"), FileNotFoundError, "no/such/folder"),
        ):
            with self.subTest(what):
                with self.assertRaisesRegex(error, message):
                    call()

    def test_file(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "gel.csv"
            file.write_text("wavelength,a,b\n400,0.1,0.9\n700,0.2,0.8\n")
            spectra = metamer.Spectrum.read(file, quantity="transmittance")
            self.assertEqual([spectrum.name for spectrum in spectra], ["a", "b"])
            file.write_text("wavelength,gel\n400,0.1\n700,0.2\n")
            self.assertEqual(metamer.Library().filter("gel.csv", folder=folder)(400), 0.1)

    def test_library(self):
        library = metamer.Library()
        for names, one in ((library.illuminants, "HP1"), (library.observers, "CIE 1931 2"), (library.filters, "Lee 204 Full C.T. Orange"),
                           (library.reflectance_sets, "colorchecker"), (library.spaces, "ACEScg")):
            self.assertTrue(any(one.lower() in name.lower() for name in names), one)
        self.assertEqual(len(library.reflectances("colorchecker")), 24)
        self.assertEqual(library.illuminant("3200 K")(560), 1)
        self.assertEqual(library.observer("CIE 1931 2").response, "xyz")
        provenance = library.provenance("illuminants", "D65")
        self.assertTrue(provenance["source"] and provenance["licence"] and provenance["file"])

    def test_colorimetry(self):
        library = metamer.Library()
        white = metamer.Spectrum([300, 800], [1, 1], quantity="reflectance")
        xyz = metamer.tristimulus(white, "D65")
        # ASTM E308's white of D65 is summed over a wider range, in steps of 5 nm.
        np.testing.assert_allclose(xyz, [0.95047, 1, 1.08883], atol=3e-4)
        np.testing.assert_allclose(metamer.lab(np.stack([xyz, xyz]), xyz), [[100, 0, 0]] * 2, atol=1e-9)
        self.assertAlmostEqual(metamer.delta_e_2000([50, 2.6772, -79.7751], [50, 0, -82.7485]), 2.0425, places=4)
        self.assertEqual(metamer.delta_e_2000(np.zeros((4, 5, 3)), [1, 0, 0]).shape, (4, 5))
        temperature, duv = metamer.correlated_colour_temperature(library.illuminant("A"))
        self.assertAlmostEqual(temperature, 2856, delta=2)
        self.assertAlmostEqual(duv, 0, places=4)
        self.assertEqual(metamer.spectral_similarity_index("D65", "D65"), 100)


@unittest.skipIf(colour is None, "colour-science is not installed")
class ColourScience(unittest.TestCase):
    def test_spectral_distribution(self):
        theirs = colour.SDS_ILLUMINANTS["FL2"]
        ours = metamer.Spectrum.of(theirs, quantity="power")
        self.assertEqual(ours.name, theirs.name)
        np.testing.assert_array_equal(ours.wavelengths, theirs.wavelengths)
        np.testing.assert_array_equal(ours.values, theirs.values)

    def test_light_of_a_recipe(self):
        """The same table from colour-science and from the library makes the same transform."""
        pixels = np.random.default_rng(1).uniform(0, 1, (50, 3))
        named = metamer.Transform(metamer.Recipe("D65", "FL2"))
        given = metamer.Transform(metamer.Recipe("D65", colour.SDS_ILLUMINANTS["FL2"]))
        np.testing.assert_allclose(given(pixels), named(pixels), rtol=1e-9)

    def test_observer(self):
        theirs = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
        ours = metamer.Observer.of(theirs)
        self.assertEqual(ours.response, "xyz")
        np.testing.assert_array_equal(ours.curves[1].values, theirs.values[:, 1])
        np.testing.assert_array_equal(ours.xyz_from_response, np.eye(3))
        self.assertEqual(metamer.Observer.of(colour.MSDS_CAMERA_SENSITIVITIES["Nikon 5100 (NPL)"]).response, "camera")


class Environment(unittest.TestCase):
    def test_named_folder_is_not_passed_over(self):
        """$METAMER_DATA that holds no tables is an error, not a reason to take others."""
        before = os.environ.get("METAMER_DATA")
        os.environ["METAMER_DATA"] = "/no/such/folder"
        try:
            with self.assertRaisesRegex(ValueError, "/no/such/folder"):
                metamer.Library()
        finally:
            os.environ.pop("METAMER_DATA")
            if before is not None:
                os.environ["METAMER_DATA"] = before


if __name__ == "__main__":
    unittest.main()
