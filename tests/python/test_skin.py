# SPDX-License-Identifier: Apache-2.0
"""Skin: spectra from parameters, parameters from colours, edits."""

import importlib.util
import io
import json
import unittest
from pathlib import Path

import numpy as np

import metamer
from metamer import skin


DATA = Path(__file__).resolve().parents[2] / "data"


class Skin(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.people = skin.sample(60, seed=4)
        cls.estimator = skin.Estimator("D65", "CIE 1931 2", "Rec.709")

    def colours(self):
        """Linear Rec.709 of the people's skin in daylight, by the module's own colorimetry."""
        xyz = np.array([metamer.tristimulus(dict(zip(range(380, 781, 10), spectrum)), "D65", "CIE 1931 2")
                        for spectrum in skin.albedo(self.people)])
        to_rgb = np.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560],
                           [0.0556434, -0.2040259, 1.0572252]])
        return xyz @ to_rgb.T

    def test_the_table_of_virtual_skins_is_what_the_script_writes(self):
        path = Path(__file__).resolve().parents[2] / "script" / "virtual_skins.py"
        spec = importlib.util.spec_from_file_location("virtual_skins", path)
        script = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(script)
        written, kept = (np.genfromtxt(io.StringIO(text), delimiter=",", skip_header=1)
                         for text in (script.text(), script.TABLE.read_text(encoding="utf-8")))
        self.assertEqual(kept.shape, (41, script.COUNT + 1))
        # A digit of the table: another machine's last bit may round the other way.
        np.testing.assert_allclose(written, kept, atol=1.01 * 10.0 ** -script.DIGITS, rtol=0)
        self.assertLess(np.abs(written - kept).mean(), 1e-7)

    def test_spectra(self):
        spectra = skin.albedo(self.people)
        self.assertEqual(spectra.shape, (60, 41))
        self.assertTrue(np.all((spectra > 0) & (spectra < 1)))
        # The misfit's repair darkens deep red, where the model is too bright.
        self.assertTrue(np.all(spectra[:, -1] < skin.albedo(self.people, repair=False)[:, -1]))
        named = skin.virtual_skins(60, seed=4)
        np.testing.assert_allclose([one.values for one in named], spectra, rtol=1e-12)
        np.testing.assert_array_equal(self.people, skin.sample(60, seed=4))

    def test_round_trip_and_spectrum(self):
        rgb = self.colours().reshape(6, 10, 3)
        maps = self.estimator.estimate(rgb)
        self.assertEqual(maps.shape, (6, 10, 9))
        np.testing.assert_allclose(self.estimator.colour(maps), rgb, rtol=1e-6, atol=1e-7)
        found = self.estimator.spectrum(maps).reshape(60, 41)
        self.assertLess(np.sqrt(np.mean((found - skin.albedo(self.people)) ** 2)), 0.012)
        # Melanin by its cube root, against the prior's deviation of 0.052.
        error = np.cbrt(maps[..., 0].ravel()) - np.cbrt(self.people[:, 0])
        self.assertLess(np.sqrt(np.mean(error**2)), 0.02)

    def test_edits(self):
        maps = self.estimator.estimate(self.colours().reshape(6, 10, 3))
        red = lambda edited: (lambda rgb: rgb[..., 0] / rgb[..., 1])(self.estimator.colour(edited))
        self.assertTrue(np.all(red(skin.flush(maps, 0.5)) > red(maps)))
        self.assertTrue(np.all(self.estimator.colour(skin.tan(maps, 1)) < self.estimator.colour(maps)))
        self.assertTrue(np.all(self.estimator.colour(skin.bleach(maps, 1)).mean(-1) > self.estimator.colour(maps).mean(-1)))
        matte = np.zeros((6, 10))
        matte[2, 3] = 1
        edited = skin.multiply(maps, "blood", 2, matte)
        changed = np.any(edited != maps, axis=-1)
        self.assertEqual((changed.sum(), bool(changed[2, 3])), (1, True))
        smoothed = skin.smooth(maps, "melanin", 2.0)
        self.assertLess(smoothed[..., 0].std(), maps[..., 0].std())
        np.testing.assert_array_equal(smoothed[..., 1:], maps[..., 1:])
        self.assertTrue(np.all(skin.set_quantity(maps, "thickness", 120)[..., 2] == 120))

    def test_what_colour_tells(self):
        told = self.estimator.identification()
        self.assertTrue(told["separates_blood_from_melanin"])
        self.assertGreater(told["melanin"], told["thickness"])

    def test_any_wavelengths(self):
        fine = np.arange(380, 781, 2)
        np.testing.assert_allclose(skin.albedo_at(self.people, fine)[:, ::5], skin.albedo(self.people, repair=False), rtol=1e-9)
        absorbing = skin.absorption(fine)
        # Blood with oxygen has its maxima at 542 and 576 nm, of 1/cm as Prahl's table has them.
        blood = absorbing["oxyhaemoglobin"]
        self.assertEqual([int(fine[80 + np.argmax(blood[80:90])]), int(fine[90 + np.argmax(blood[90:110])])], [542, 576])
        self.assertAlmostEqual(blood[(542 - 380) // 2], 285.4, delta=0.5)

    def test_networks(self):
        """The compiled network is the one that was trained: NumPy's reading of its weights gives the same."""
        rgb = self.colours()
        document = json.loads((DATA / "skin_network.json").read_text(encoding="utf-8"))
        mean = rgb.mean(axis=1)
        features = np.column_stack([(rgb[:, 0] - rgb[:, 1]) / mean, (rgb[:, 2] - rgb[:, 1]) / mean, np.log(mean)])

        def run(layers, values):
            for k, layer in enumerate(layers):
                values = values @ np.array(layer["weights"]).T + layer["biases"]
                values = np.tanh(values) if k + 1 < len(layers) else values
            return values

        for loss in ("spectral", "rgb"):
            scale, own = document["coordinates"], document["networks"][loss]
            inner = (features - document["features"]["mean"]) / document["features"]["deviation"]
            found = run(own["encoder"], inner) * scale["deviation"] + scale["mean"]
            network = skin.Network("Rec.709", loss)
            maps = network.estimate(rgb)
            # By their roots; the colours are single, and this test's Rec.709 is rounded.
            np.testing.assert_allclose(np.cbrt(maps[:, 0]), found[:, 0].clip(0.0), atol=2e-3)
            np.testing.assert_allclose(maps[:, 1] ** 0.25, found[:, 1], atol=2e-3)
            np.testing.assert_allclose(network.colour(maps), rgb, rtol=1e-6, atol=1e-7)
            inside = self.people.copy()
            inside[:, 0], inside[:, 1] = np.cbrt(inside[:, 0]), inside[:, 1] ** 0.25
            np.testing.assert_allclose(network.decode(self.people), run(own["decoder"], (inside - scale["mean"]) / scale["deviation"]),
                                       rtol=1e-9, atol=1e-12)
        decoded = skin.Network().decode(self.people)
        truth = skin.albedo(self.people)
        angles = np.arccos(np.sum(decoded * truth, 1) / np.linalg.norm(decoded, axis=1) / np.linalg.norm(truth, axis=1))
        self.assertLess(np.degrees(angles).max(), 3)
        with self.assertRaisesRegex(ValueError, "loss 'mse'"):
            skin.Network(loss="mse")

    def test_refusals(self):
        with self.assertRaisesRegex(ValueError, "last axis must have 3"):
            self.estimator.estimate(np.zeros((4, 4)))
        with self.assertRaisesRegex(ValueError, "melanin '2'"):
            skin.albedo([[2, 0.02, 100, 0.5, 0.5]])
        with self.assertRaisesRegex(ValueError, "quantity 'lipstick'"):
            skin.multiply(np.ones((2, 2, 9)), "lipstick", 2)
        with self.assertRaisesRegex(ValueError, "factor '-1'"):
            skin.multiply(np.ones((2, 2, 9)), "blood", -1)


if __name__ == "__main__":
    unittest.main()
