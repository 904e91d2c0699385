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


def noisy(shot, seed, relative):
    """The same capture with noise of its own."""
    random = np.random.default_rng(seed)
    again = lambda values: np.asarray(values) * (1 + relative * random.standard_normal(np.shape(values)))
    return stage.WallCapture(primaries=again(shot.primaries), charts=[again(chart) for chart in shot.charts],
                             target=again(shot.target), names=shot.names, beta=shot.beta,
                             environment_white=again(shot.environment_white))


class Confidence(unittest.TestCase):
    def test_intervals_hold_the_truth(self):
        shot = capture()
        true_q = stage.solve(shot).Q
        inside = []
        for seed in range(40):
            found = stage.intervals(noisy(shot, seed, 0.01), noise=0.01, samples=100, xyz_from_camera=np.eye(3))
            low, high = found.Q
            inside.append((low <= true_q) & (true_q <= high))
        # 40 captures of 9 numbers each, which hang together within a capture.
        self.assertGreater(np.mean(inside), 0.88)
        self.assertLess(np.mean(inside), 0.99)

    def test_what_intervals_say(self):
        shot = noisy(capture(), 1, 0.01)
        found = stage.intervals(shot, noise=(0.01, 1e-4), samples=50, white_patch=shot.names[18],
                                xyz_from_camera=np.eye(3))
        solved = stage.solve(shot, largest_condition=found.largest_condition)
        for name in ("M", "N"):
            low, high = getattr(found, name)
            self.assertTrue(np.all(low <= high))
            # The draws of N are freed of what noise does to it on the mean: its own solution may lie a little outside.
            reach = 0 if name == "M" else high - low
            self.assertTrue(np.all((low - reach <= getattr(solved, name)) & (getattr(solved, name) <= high + reach)), name)
        self.assertEqual(found.bound_is_chosen, found.largest_condition < 100)
        self.assertEqual(found.samples, 50)
        for low, high in (found.mean_before, found.mean_after, found.max_after):
            self.assertLessEqual(low, high)
        self.assertLess(found.mean_after[1], found.mean_before[1])
        # The environment's white from the chart's white patch, which is not as bright.
        darker = stage.intervals(shot, noise=0.01, samples=50, white_patch=18, white_reflectance=1,
                                 xyz_from_camera=np.eye(3))
        self.assertGreater(darker.Q[0][1, 1], found.Q[1][1, 1])
        with self.assertRaisesRegex(ValueError, "white_patch"):
            stage.intervals(shot, noise=0.01, white_reflectance=1, xyz_from_camera=np.eye(3))
        again = stage.intervals(shot, noise=(0.01, 1e-4), samples=50, white_patch=18, xyz_from_camera=np.eye(3))
        np.testing.assert_array_equal(again.Q, found.Q)

    def test_noise_is_seen_in_the_chart(self):
        shot = noisy(capture(), 1, 0.02)
        stated = stage.intervals(shot, noise=0.02, samples=100, xyz_from_camera=np.eye(3))
        seen = stage.intervals(shot, samples=100, xyz_from_camera=np.eye(3))
        widths = [np.subtract(*found.Q[::-1]).mean() for found in (stated, seen)]
        self.assertLess(abs(np.log(widths[1] / widths[0])), 0.5)
        with self.assertRaisesRegex(ValueError, "noise"):
            stage.intervals(shot, reflectances=None, xyz_from_camera=np.eye(3))
        with self.assertRaisesRegex(ValueError, "samples"):
            stage.intervals(shot, samples=3, xyz_from_camera=np.eye(3))

    def test_faults(self):
        shot = capture()
        self.assertEqual(stage.faults(shot), [])
        charts = shot.charts
        for what, fields, field in (
            ("swapped captures", dict(charts=[charts[1], charts[0], charts[2]]), "charts|primaries"),
            ("mirrored chart", dict(target=shot.target.reshape(4, 6, 3)[:, ::-1].reshape(-1, 3)), "target"),
            ("one chart twice", dict(charts=[charts[0], charts[0], charts[2]]), "charts"),
        ):
            with self.subTest(what):
                wrong = stage.WallCapture(**dict(
                    dict(primaries=shot.primaries, charts=charts, target=shot.target, names=shot.names,
                         environment_white=shot.environment_white, beta=shot.beta), **fields))
                found = stage.faults(wrong)
                self.assertTrue(found)
                self.assertRegex(found[0].field, field)
                self.assertIn(found[0].remedy, str(found[0]))


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
