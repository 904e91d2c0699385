# SPDX-License-Identifier: Apache-2.0
"""lutgen stage match against scipy, and what several emitters buy."""

import json
import unittest

import numpy as np
from scipy.optimize import minimize, nnls

from lutgen import LutgenTest
from stage_physics import LIGHTS, chart, light, model, spectra, write_chart, write_spectrum

RGB = ["led:628:14", "led:525:24", "led:460:16"]
WHITE = "phosphor:450:20:560:120:0.8"
PC_AMBER = "phosphor:450:20:600:80:0.01"
CYAN = "led:500:22"
AMBER = "led:595:12"
SETS = {"RGB": RGB, "RGBW": [*RGB, WHITE], "RGBW+PC amber": [*RGB, WHITE, PC_AMBER],
        "all": [*RGB, WHITE, PC_AMBER, CYAN, AMBER]}


def systems(emitters, target):
    """Matrix and target of each method, by the chapter's definitions."""
    eye = np.stack(list(spectra("observers/cie_1931_2.csv").values())[:3], axis=1)
    columns = np.stack([model(text) for text in emitters], axis=1)
    power = light(target)
    _, reflectances = chart()
    seen = np.concatenate([(reflectance[:, None] * eye).T for reflectance in reflectances])
    return {"sim": (columns, power), "mim": (eye.T @ columns, eye.T @ power), "mrm": (seen @ columns, seen @ power)}


class MatchTest(LutgenTest):
    def match(self, *arguments):
        self.assertWorks("stage", "match", "--json", self.folder / "match.json", *arguments)
        return json.loads((self.folder / "match.json").read_text())

    def test_against_scipy(self):
        worst = 0.0
        for target in LIGHTS:
            emitters = SETS["RGBW+PC amber"]
            for method, (matrix, power) in systems(emitters, target).items():
                ours = self.match("--target", target, "--emitters", *emitters, "--method", method)
                drives = np.array(ours["drives"])
                reference, norm = nnls(matrix, power)
                self.assertTrue((drives >= 0).all())
                residual = np.linalg.norm(matrix @ drives - power)
                self.assertLessEqual(residual, norm * (1 + 1e-9) + 1e-12 * np.linalg.norm(power))
                self.assertAlmostEqual(ours["residual"], residual / np.linalg.norm(power), delta=1e-12)
                if method == "mim":
                    self.assertLessEqual(drives @ drives, reference @ reference * (1 + 1e-12), "not the shortest")
                else:
                    worst = max(worst, np.abs(drives - reference).max() / reference.max())
        print(f"drives within {worst:.1e} of scipy's")
        self.assertLessEqual(worst, 1e-9)

    def test_skin(self):
        """Virtual skins are said of in every report, and count where they are asked for."""
        arguments = ["--target", "A", "--emitters", *SETS["RGBW"]]
        for method in ("sim", "mim"):
            skin = self.match(*arguments, "--method", method)["virtual_skin"]
            self.assertEqual((skin["count"], skin["weight"], skin["trade_off"]), (200, 0, []))
        plain, faces = self.match(*arguments), self.match(*arguments, "--priority", "skin:20")
        self.assertLess(faces["virtual_skin"]["dE"]["mean"], plain["virtual_skin"]["dE"]["mean"])
        self.assertEqual([point["weight"] for point in plain["virtual_skin"]["trade_off"]], [0, 0.04, 0.2, 1, 6, 20])
        self.assertAlmostEqual(plain["virtual_skin"]["trade_off"][5]["skin_dE"]["mean"],
                               faces["virtual_skin"]["dE"]["mean"], places=9)
        self.assertFails("stage", "match", "--json", "m.json", *arguments, "--method", "mim", "--priority", "skin",
                         says=["--priority", "mrm alone"])

    def test_files(self):
        """Emitters from CSV files, one of two columns; drives in the files' own units."""
        names = [self.folder / f"{i}.csv" for i in range(3)]
        for file, text, scale in zip(names, RGB, (1.0, 2.0, 0.5)):
            write_spectrum(file, scale * model(text))
        modelled = self.match("--target", "D65", "--emitters", *RGB, "--method", "mrm")
        ours = self.match("--target", "D65", "--emitters", *names, "--method", "mrm")
        # A file is straight lines between its nanometres, a model is summed at them.
        np.testing.assert_allclose(ours["drives"], np.array(modelled["drives"]) / [1.0, 2.0, 0.5], rtol=5e-4)
        self.assertEqual(modelled["models"], [True] * 3)
        self.assertEqual(ours["models"], [False] * 3)

    def test_charts_alone(self):
        """The chart under each emitter and under the target, as an eye sees them: the same drives as from spectra."""
        eye = np.stack(list(spectra("observers/cie_1931_2.csv").values())[:3], axis=1)
        names, reflectances = chart()
        files = []
        for index, text in enumerate(SETS["RGBW"]):
            files.append(self.folder / f"e{index}.csv")
            write_chart(files[-1], names, reflectances * model(text) @ eye)
        write_chart(self.folder / "target.csv", names, reflectances * light("A") @ eye)
        measured = self.match("--target", "A", "--emitters", *SETS["RGBW"], "--method", "mrm")
        ours = self.match("--target", self.folder / "target.csv", "--charts", *files, "--method", "mrm")
        np.testing.assert_allclose(ours["drives"], measured["drives"], rtol=1e-9, atol=1e-9)
        self.assertEqual(ours["emitters"], ["e0", "e1", "e2", "e3"])
        seen = ["--target", self.folder / "target.csv", "--charts", *files]
        perceptual = self.match(*seen, "--method", "mrm", "--weights", "perceptual")
        for method in ("mim", "mrm"):
            self.assertLess(perceptual["dE"]["mean"], self.match(*seen, "--method", method)["dE"]["mean"])
        white = self.match("--target", self.folder / "target.csv", "--charts", *files, "--method", "mim", "--report",
                           self.folder / "r.md", "--figure", self.folder / "r.png")
        made = sum(drive * (reflectances[18] * model(text)) @ eye for drive, text in zip(white["drives"], SETS["RGBW"]))
        np.testing.assert_allclose(made, reflectances[18] * light("A") @ eye, rtol=1e-9)
        self.assertIn("(r.png)", (self.folder / "r.md").read_text())
        self.match(*seen, "--method", "mrm", "--weights", "relative", "--report", self.folder / "r.md")
        self.assertIn("Method mrm, relative weights,", (self.folder / "r.md").read_text())
        self.assertFails("stage", "match", "--target", "target.csv", "--charts", *files, "--method", "sim", "--json",
                         "s.json", says=["sim", "needs spectra"])

    def test_more_emitters(self):
        """MRM's error never rises with an emitter added, and MRM is never worse than MIM on the chart: in its own
        squares, and with perceptual weights in mean CIEDE2000 as well."""
        for target in ("A", "D65", "FL2", "FL11"):
            residuals, means = [], []
            for name, emitters in SETS.items():
                found = {method: self.match("--target", target, "--emitters", *emitters, "--method", method)
                         for method in ("sim", "mim", "mrm")}
                found["perceptual"] = self.match("--target", target, "--emitters", *emitters, "--method", "mrm",
                                                 "--weights", "perceptual")
                matrix, power = systems(emitters, target)["mrm"]
                errors = {method: np.linalg.norm(matrix @ np.array(one["drives"]) - power) / np.linalg.norm(power)
                          for method, one in found.items()}
                print(f"{target:4s} {name:14s} " + "  ".join(
                    f"{method} {one['dE']['mean']:5.2f} ({errors[method]:.4f})" for method, one in found.items()))
                for method, one in found.items():
                    self.assertLessEqual(errors["mrm"], errors[method] * (1 + 1e-12), method)
                    self.assertLessEqual(found["perceptual"]["dE"]["mean"], one["dE"]["mean"] * (1 + 1e-12), method)
                self.assertEqual([one["weights"] for one in found.values()], [None, None, "absolute", "perceptual"])
                self.assertAlmostEqual(found["perceptual"]["residual"], errors["perceptual"], delta=1e-12)
                residuals.append(found["mrm"]["residual"])
                means.append(found["perceptual"]["dE"]["mean"])
            for fewer, more in zip(residuals, residuals[1:]):
                self.assertLessEqual(more, fewer * (1 + 1e-9))
            # Not by construction, since its objective is not convex; to the accuracy of its last step.
            for fewer, more in zip(means, means[1:]):
                self.assertLessEqual(more, fewer * (1 + 1e-5))
            self.assertLess(residuals[1], 0.5 * residuals[0], "white")
            if target != "FL11":  # its lines are narrower than any emitter
                self.assertLess(residuals[3], 0.9 * residuals[1], "all")
            if target in ("A", "FL2"):  # white alone does for daylight, as in fig. 2.14
                self.assertLess(residuals[2], 0.9 * residuals[1], "PC amber")

    def test_perceptual_weights(self):
        """The mean CIEDE2000 itself, minimised by scipy from the same starts, with colour-science's formulas."""
        import colour
        eye = np.stack(list(spectra("observers/cie_1931_2.csv").values())[:3], axis=1)
        for target, emitters in (("A", SETS["RGB"]), ("FL2", SETS["RGBW"]), ("D65", SETS["RGBW+PC amber"])):
            matrix, power = systems(emitters, target)["mrm"]
            white = eye.T @ light(target)
            white_xy = colour.XYZ_to_xy(white)
            level = white[1]
            wanted = colour.XYZ_to_Lab(power.reshape(-1, 3) / level, white_xy)

            def mean(drives):
                made = colour.XYZ_to_Lab((matrix @ drives).reshape(-1, 3) / level, white_xy)
                return colour.delta_E(wanted, made, method="CIE 2000").mean()

            starts = [np.array(self.match("--target", target, "--emitters", *emitters, "--method", method)["drives"])
                      for method in ("mim", "mrm")]
            size = starts[1].max()
            theirs = min(minimize(lambda scaled: mean(scaled * size), start / size, method="L-BFGS-B",
                                  bounds=[(0, None)] * len(start), options={"maxiter": 3000}).fun for start in starts)
            ours = self.match("--target", target, "--emitters", *emitters, "--method", "mrm", "--weights", "perceptual")
            self.assertAlmostEqual(mean(np.array(ours["drives"])), ours["dE"]["mean"], delta=1e-6)
            print(f"{target}: mean CIEDE2000 {ours['dE']['mean']:.6f}, scipy's {theirs:.6f}")
            # scipy's method is made for smooth functions and may stop above; ours rounds the kink by 0.001.
            self.assertLessEqual(ours["dE"]["mean"], theirs + 1e-3)

    def test_perceptual_weights_of_an_exact_match(self):
        """A light that the emitters can make is made, from spectra and from charts, and within limits."""
        mixed = model(RGB[0]) + 0.5 * model(RGB[1]) + 0.25 * model(RGB[2])
        write_spectrum(self.folder / "mixed.csv", mixed)
        arguments = ["--emitters", *SETS["RGBW"], "--method", "mrm", "--weights", "perceptual"]
        ours = self.match("--target", self.folder / "mixed.csv", *arguments)
        # A file is straight lines between its nanometres, a model is summed at them.
        np.testing.assert_allclose(ours["drives"], [1, 0.5, 0.25, 0], atol=5e-4)
        bound = 0.4
        limited = self.match("--target", self.folder / "mixed.csv", *arguments, "--limits", bound)
        absolute = self.match("--target", self.folder / "mixed.csv", *arguments[:-2], "--limits", bound)
        self.assertLessEqual(max(limited["drives"]), bound)
        self.assertLess(limited["dE"]["mean"], absolute["dE"]["mean"])

    def test_limits(self):
        free = self.match("--target", "A", "--emitters", *SETS["RGBW"], "--method", "mrm")
        bound = 0.5 * max(free["drives"])
        limited = self.match("--target", "A", "--emitters", *SETS["RGBW"], "--method", "mrm", "--limits", bound)
        self.assertLessEqual(max(limited["drives"]), bound)
        self.assertGreater(limited["residual"], free["residual"])
        budget = 0.5 * sum(free["drives"])
        frugal = self.match("--target", "A", "--emitters", *SETS["RGBW"], "--method", "mrm", "--power", 1,
                            "--power-budget", budget)
        self.assertAlmostEqual(sum(frugal["drives"]), budget, delta=1e-9 * budget)

    def test_dead_and_equal_emitters(self):
        write_spectrum(self.folder / "dead.csv", np.zeros(401))
        ours = self.match("--target", "A", "--emitters", *RGB, self.folder / "dead.csv", RGB[0], "--method", "mrm")
        self.assertEqual(ours["drives"][3], 0)
        self.assertTrue(any("gives no light" in note for note in ours["notes"]))
        self.assertAlmostEqual(ours["drives"][0], ours["drives"][4], delta=1e-9 * ours["drives"][0])
        self.assertIsNone(ours["condition"])

    def test_out_of_reach(self):
        ours = self.match("--target", "HP1", "--emitters", "led:525:20", "led:460:20", "--method", "mim")
        self.assertGreater(ours["residual"], 0.01)
        self.assertTrue(any("out of the emitters' reach" in note for note in ours["notes"]))

    def test_bad_input(self):
        base = ["stage", "match", "--json", "m.json", "--method", "mrm"]
        self.assertFails(*base, "--target", "D66", "--emitters", *RGB, says=["D66", "D65"])
        self.assertFails(*base, "--target", "D65", "--emitters", "led:620", says=["led:620", "led:PEAK:WIDTH"])
        self.assertFails(*base, "--target", "D65", "--emitters", "absent.csv", says=["absent.csv"])
        self.assertFails(*base, "--target", "D65", "--emitters", *RGB, "--limits", 1, 2, says=["--limits", "one an emitter"])
        write_spectrum(self.folder / "dead.csv", np.zeros(401))
        self.assertFails(*base, "--target", "D65", "--emitters", "dead.csv", says=["no light"])
        self.assertFails("stage", "match", "--target", "D65", "--emitters", *RGB, "--method", "best", "--json", "m.json",
                         code=2, says=["--method"])


if __name__ == "__main__":
    unittest.main()
