# SPDX-License-Identifier: Apache-2.0
"""LED stages: a wall's matrices, drives of fixtures, least squares."""

import unittest

import numpy as np

import metamer
from metamer import stage

EMITTERS = [stage.led_model(628, 14), stage.led_model(525, 24), stage.led_model(460, 14)]


def capture():
    return stage.WallCapture.from_spectra(EMITTERS, camera="Canon EOS 5D Mark II", target="FL2",
                                          beta=stage.calibration_square_beta(1, 1, 1))


class Wall(unittest.TestCase):
    def test_matrices(self):
        """Section 2.7's equations, worked out again in NumPy."""
        shot = capture()
        found = stage.solve(shot)
        wall = shot.primaries.T
        drive = np.maximum(np.linalg.inv(wall) @ shot.environment_white, 0)
        predicted = shot.beta * sum(weight * chart for weight, chart in zip(drive, shot.charts))
        q = np.linalg.lstsq(predicted, shot.target, rcond=None)[0].T
        np.testing.assert_allclose(found.M, np.linalg.inv(wall), rtol=1e-9)
        np.testing.assert_allclose(found.predicted, predicted, rtol=1e-9)
        np.testing.assert_allclose(found.Q, q, rtol=1e-6, atol=1e-9)
        np.testing.assert_allclose(found.N, found.M @ np.linalg.inv(q), rtol=1e-6, atol=1e-9)
        np.testing.assert_allclose(found.corrected, found.predicted @ found.Q.T, rtol=1e-9)
        self.assertEqual((found.chart_rank, found.N_bounded), (3, False))

    def test_captures_as_arrays(self):
        shot = capture()
        again = stage.WallCapture(primaries=shot.primaries, charts=shot.charts, target=shot.target, names=shot.names,
                                  environment_white=shot.environment_white, beta=shot.beta, black_level=[0.01, 0.02, 0.01])
        found = stage.solve(again, held_patch=shot.names[18])
        np.testing.assert_allclose(found.offset, -found.M @ again.black_level, rtol=1e-9)
        np.testing.assert_allclose(found.corrected[18], shot.target[18], rtol=1e-9)
        np.testing.assert_array_equal(stage.solve(again, held_patch=18).Q, found.Q)
        # A patch that alone counts is met, as far as three channels of it go.
        weights = np.full(len(shot.names), 1e-9)
        weights[:3] = 1
        np.testing.assert_allclose(stage.solve(shot, patch_weights=weights).corrected[:3], shot.target[:3], rtol=1e-4)

    def test_skins_count_beside_the_chart(self):
        shot = capture()
        skins = stage.WallCapture.from_spectra(EMITTERS, camera="Canon EOS 5D Mark II", target="FL2", beta=shot.beta,
                                               reflectances="virtual skins")
        plain, nothing = stage.solve(shot), stage.solve(shot, skins=skins, skin_weight=0)
        np.testing.assert_array_equal(nothing.Q, plain.Q)
        self.assertEqual(len(plain.corrected_skins), 0)
        found = stage.solve(shot, skins=skins)
        away = [np.linalg.norm(one.corrected_skins - skins.target) for one in (nothing, found)]
        self.assertLess(away[1], 0.7 * away[0])

    def test_refused(self):
        shot = capture()
        fields = dict(primaries=shot.primaries, charts=shot.charts, target=shot.target, environment_white=[1, 1, 1])
        for what, call in (
            ("two charts", lambda: stage.WallCapture(**dict(fields, charts=shot.charts[:2]))),
            ("another number of patches", lambda: stage.WallCapture(**dict(fields, target=shot.target[1:]))),
            ("names", lambda: stage.WallCapture(**fields, names=["one"])),
            ("primaries", lambda: stage.WallCapture(**dict(fields, primaries=[1, 2, 3]))),
            ("dead primary", lambda: stage.solve(stage.WallCapture(**dict(fields, primaries=np.ones((3, 3)))))),
            ("no such patch", lambda: stage.solve(shot, held_patch="mauve")),
            ("no such patch", lambda: stage.solve(shot, held_patch=24)),
            ("weights", lambda: stage.solve(shot, patch_weights=[1])),
            ("two emitters", lambda: stage.WallCapture.from_spectra(EMITTERS[:2], camera="Nikon D5100", target="A")),
        ):
            with self.subTest(what):
                with self.assertRaises(ValueError):
                    call()

    def test_beta(self):
        self.assertAlmostEqual(stage.calibration_square_beta(1, 1, 1), 1 / 0.2394, places=2)

    def test_linearity(self):
        drives = np.linspace(0, 1, 9)
        found = stage.linearity(drives, 0.02 + np.outer(drives**2.4, [0.8, 0.1, 0.05]))
        self.assertAlmostEqual(found["exponent"], 2.4, places=2)
        with self.assertRaises(ValueError):
            stage.linearity(drives, np.ones((3, 3)))


class Fixture(unittest.TestCase):
    def test_exact_mixture(self):
        """A light that is a mixture of the emitters gets that mixture's drives by every method."""
        drives = np.array([0.3, 0.7, 0.2])
        wavelengths = np.arange(380, 781.0)
        mixed = metamer.Spectrum(wavelengths, sum(d * e(wavelengths) for d, e in zip(drives, EMITTERS)), quantity="power")
        for method, weights in (("sim", "absolute"), ("mim", "absolute"), ("mrm", "absolute"), ("mrm", "relative"),
                                ("mrm", "perceptual")):
            with self.subTest(method=method, weights=weights):
                found = stage.match(mixed, EMITTERS, method=method, weights=weights)
                # A spectrum is straight lines between its nanometres, a model is summed at them.
                np.testing.assert_allclose(found.drives, drives, rtol=5e-3)
                self.assertLess(found.relative_residual, 5e-3)

    def test_names_and_models(self):
        found = stage.match("D65", ["led:628:14", "led:525:24", "led:460:14", "A"], observer="Nikon D5100",
                            weights="perceptual", upper=[1e3, 1e3, 1e3, 0.1])
        self.assertEqual(len(found.drives), 4)
        self.assertLessEqual(found.drives[3], 0.1)

    def test_charts(self):
        charts = np.random.default_rng(1).uniform(0, 1, (4, 24, 3))
        drives = np.array([0.1, 0.5, 0, 0.9])
        found = stage.match_charts(charts, np.tensordot(drives, charts, 1))
        np.testing.assert_allclose(found.drives, drives, atol=1e-9)

    def test_limits(self):
        matrix, target = np.eye(3), np.array([1.0, 2.0, 3.0])
        x, residual, rank = stage.non_negative_least_squares(matrix, target, upper=2)
        np.testing.assert_allclose(x, [1, 2, 2])
        self.assertAlmostEqual(residual, 1)
        self.assertEqual(rank, 3)
        x, _, _ = stage.non_negative_least_squares(matrix, target, power=1, power_budget=3)
        self.assertAlmostEqual(x.sum(), 3)

    def test_refused(self):
        for what, call in (
            ("method", lambda: stage.match("D65", EMITTERS, method="best")),
            ("weights", lambda: stage.match("D65", EMITTERS, weights="best")),
            ("no emitters", lambda: stage.match("D65", [])),
            ("limits", lambda: stage.match("D65", EMITTERS, upper=[1, 1])),
            ("budget alone", lambda: stage.match("D65", EMITTERS, power_budget=1)),
            ("charts", lambda: stage.match_charts(np.ones((2, 24, 3)), np.ones((23, 3)))),
            ("empty", lambda: stage.non_negative_least_squares(np.empty((0, 3)), [])),
        ):
            with self.subTest(what):
                with self.assertRaises(ValueError):
                    call()


if __name__ == "__main__":
    unittest.main()
