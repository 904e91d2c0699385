# SPDX-License-Identifier: Apache-2.0
"""What lutgen stage match says beside drives: level, a desk's steps, what limits cost, gels and lamps, intervals."""

import json
import unittest

import numpy as np

from lutgen import LutgenTest
from stage_physics import DATA, Stage, light, model, spectra, write_chart, write_spectrum

RGB = ["led:628:14", "led:525:24", "led:460:16"]
RGBW = [*RGB, "phosphor:450:20:560:120:0.8"]


class Answers(LutgenTest):
    def match(self, *arguments):
        self.printed = self.assertWorks("stage", "match", "--json", self.folder / "match.json", *arguments)
        return json.loads((self.folder / "match.json").read_text())

    def test_free_level(self):
        plain = self.match("--target", "A", "--emitters", *RGBW)
        free = self.match("--target", "A", "--emitters", *RGBW, "--level", "free", "--limits", 1, 1, 0.5, 1)
        np.testing.assert_allclose(free["drives"], free["level"] * np.array(plain["drives"]), rtol=1e-9)
        self.assertAlmostEqual((np.array(free["drives"]) / [1, 1, 0.5, 1]).max(), 1, delta=1e-12)
        self.assertAlmostEqual(free["dE"]["mean"], plain["dE"]["mean"], delta=1e-12)
        budget = self.match("--target", "A", "--emitters", *RGBW, "--level", "free", "--power", 2,
                            "--power-budget", 0.5)
        self.assertAlmostEqual(2 * sum(budget["drives"]), 0.5, delta=1e-12)

    def test_steps(self):
        for unit, full in (("percent", 100), ("dmx8", 255), ("dmx16", 65535)):
            ours = self.match("--target", "D65", "--emitters", *RGB, "--level", "free", "--drives", unit)
            exact = np.array(ours["drives"]) * full
            np.testing.assert_allclose(ours["steps"]["values"], np.round(exact, 2 if unit == "percent" else 0), atol=1e-9)
            # By numpy: the rounded drives at the target's level, seen by the eye.
            self.assertAlmostEqual(ours["steps"]["dE"]["mean"], ours["dE"]["mean"], delta=0.3 if unit == "dmx8" else 0.02)
            self.assertIn(unit + ":", self.printed)
        self.assertFails("stage", "match", "--json", "m.json", "--target", "D65", "--emitters", *RGB, "--drives", "dmx8",
                         says=["led:628:14", "% of full", "--level free"])

    def test_drives_through_ramps(self):
        """What is sent gives the light that was asked: by the emitters' true curves."""
        curves = [lambda d: d**2.2, lambda d: d**2.2, lambda d: 0.4 * d + 0.6 * d**3]
        names = [self.folder / f"ramp{k}.csv" for k in range(3)]
        sent = np.linspace(0, 1, 33)
        for name, curve in zip(names, curves):
            write_chart(name, map(repr, sent.tolist()), np.outer(curve(sent), [0.8, 0.3, 0.1]))
        arguments = ("--target", "D65", "--emitters", *RGB, "--level", "free")
        ours = self.match(*arguments, "--drives", "dmx16", "--ramps", *names)
        for value, curve, drive in zip(ours["steps"]["values"], curves, ours["drives"]):
            self.assertAlmostEqual(curve(value / 65535), drive, delta=2e-3)
        self.assertEqual([one["model"] for one in ours["steps"]["eotf"]], ["power", "power", "curve"])
        self.assertAlmostEqual(ours["steps"]["dE"]["mean"], ours["dE"]["mean"], delta=0.02)
        self.assertIn("EOTF of led:628:14: power 2.2", self.printed)
        one = self.match(*arguments, "--drives", "percent", "--ramps", names[0])
        np.testing.assert_allclose(100 * np.array(one["drives"]) ** (1 / 2.2), one["steps"]["values"], atol=0.02)
        fails = ("stage", "match", "--json", "m.json", *arguments)
        self.assertFails(*fails, "--drives", "dmx8", "--ramps", *names[:2], says=["--ramps", "one an emitter (3)"])
        self.assertFails(*fails, "--ramps", names[0], code=2, says=["--drives"])
        (self.folder / "bad.csv").write_text("patch,R,G,B\n0,0,0,0\n1,1,1,1\n")
        self.assertFails(*fails, "--drives", "dmx8", "--ramps", "bad.csv", says=["bad.csv", "drives"])

    def test_rounded_drives_are_what_is_judged(self):
        """A mixture of 100, 50 and 25 steps is made of them exactly; of a hundredth more it is not."""
        for extra, low, high in ((0, 0, 0.02), (0.45, 0.02, 1)):
            steps = np.array([100, 50, 25]) + extra
            mixed = sum(step / 255 * model(text) for step, text in zip(steps, RGB))
            write_spectrum(self.folder / "mixed.csv", mixed)
            ours = self.match("--target", self.folder / "mixed.csv", "--emitters", *RGB, "--drives", "dmx8")
            self.assertEqual(ours["steps"]["values"], [100, 50, 25])
            self.assertGreaterEqual(ours["steps"]["dE"]["mean"], low)
            self.assertLessEqual(ours["steps"]["dE"]["mean"], high)

    def test_what_limits_cost(self):
        free = self.match("--target", "A", "--emitters", *RGBW)
        bounds = 0.5 * np.array(free["drives"])
        bounds[1:] = 4 * bounds[1:] + 1
        limited = self.match("--target", "A", "--emitters", *RGBW, "--limits", *bounds)
        cost = limited["limits_cost"]
        self.assertEqual(cost["held"], [RGB[0]])
        self.assertFalse(cost["budget_is_spent"])
        self.assertEqual(cost["drives_without"], free["drives"])
        self.assertEqual((cost["dE_mean_without"], cost["dE_mean_within"]), (free["dE"]["mean"], limited["dE"]["mean"]))
        self.assertAlmostEqual(cost["level_without_cost"], 0.5, delta=1e-9)
        self.assertIn(f"limits hold {RGB[0]} (asks", self.printed)
        self.assertNotIn("limits_cost", self.match("--target", "A", "--emitters", *RGBW, "--limits", 1e6))

    def test_gels_and_lamps(self):
        gel = "Lee 004 Medium Bastard Amber"
        transmittance = next(values for file in sorted((DATA / "filters").glob("*.csv"))
                             for name, values in spectra(f"filters/{file.name}", hold=True).items() if name == gel)
        ours = self.match("--target", "A", "D65", "--filters", "none", gel, gel + ":0.5", "--emitters", *RGB,
                          "--level", "free", "--report", self.folder / "gels.md")["matches"]
        self.assertEqual([(one["target"], one.get("filter")) for one in ours],
                         [(lamp, filter) for lamp in ("A", "D65") for filter in (None, gel, gel + ":0.5")])
        self.assertEqual(len(self.printed.splitlines()), 6 + 1)  # and the closing line
        for one, density in zip(ours, (0, 1, 0.5, 0, 1, 0.5)):
            write_spectrum(self.folder / "light.csv", light(one["target"]) * transmittance**density)
            alone = self.match("--target", self.folder / "light.csv", "--emitters", *RGB, "--level", "free")
            # A table of nanometres against the product of two tables.
            np.testing.assert_allclose(one["drives"], alone["drives"], rtol=2e-3)
        report = (self.folder / "gels.md").read_text()
        self.assertIn(f"| D65 + {gel}:0.5 |", report)
        self.assertFails("stage", "match", "--json", "m.json", "--target", "A", "--filters", gel + ":-1", "--emitters", *RGB,
                         says=["--filters", "density"])
        self.assertFails("stage", "match", "--json", "m.json", "--target", "A", "--filters", "no gel", "--emitters", *RGB,
                         says=["no gel"])
        self.assertFails("stage", "match", "--json", "m.json", "--target", "A", "D65", "--figure", "f.png", "--emitters",
                         *RGB, says=["--figure"])

    def test_intervals_of_charts(self):
        stage = Stage("FL2")
        random = np.random.default_rng(2)
        noisy = lambda values: values * (1 + 0.01 * random.standard_normal(np.shape(values)))
        charts, target = [noisy(one) for one in stage.charts], noisy(stage.target)
        for name, rgb in zip("rgbt", [*charts, target]):
            write_chart(self.folder / f"{name}.csv", stage.names, rgb)
        files = ["--charts", *(self.folder / f"{name}.csv" for name in "rgb"), "--target", self.folder / "t.csv"]
        ours = self.match(*files, "--noise", 0.01, "--samples", 500)["intervals"]
        draws = [np.linalg.lstsq(np.stack([noisy(one).ravel() for one in charts], 1), noisy(target).ravel(), rcond=None)[0]
                 for _ in range(500)]
        low, high = np.quantile(draws, [0.025, 0.975], axis=0)
        np.testing.assert_allclose(ours["drives"]["low"], low, atol=0.15 * (high - low).max())
        np.testing.assert_allclose(ours["drives"]["high"], high, atol=0.15 * (high - low).max())
        estimated = self.match(*files)["intervals"]
        self.assertEqual((estimated["noise_is"], estimated["samples"]), ("estimated from the charts", 200))
        self.assertEqual(self.match(*files)["intervals"], estimated)
        self.assertNotIn("intervals", self.match(*files, "--samples", 0))
        write_chart(self.folder / "t.csv", stage.names, stage.target[::-1])
        arguments = ["stage", "match", "--json", "m.json", "--charts", "r.csv", "g.csv", "b.csv", "--target", "t.csv"]
        self.assertFails(*arguments, says=["t.csv", "turned by 180 degrees"])
        self.assertWorks(*arguments, "--as-captured")
        self.assertFails(*arguments, "--filters", "none", says=["--charts", "need --emitters"])
        self.assertFails("stage", "match", "--json", "m.json", "--target", "A", "--emitters", *RGB, "--noise", 0.01,
                         says=["--noise", "--charts"])


if __name__ == "__main__":
    unittest.main()
