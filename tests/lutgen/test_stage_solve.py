# SPDX-License-Identifier: Apache-2.0
"""lutgen stage solve, against numpy on synthetic captures, and on captures that went wrong."""

import json
import unittest

import numpy as np

from lutgen import LutgenTest
from stage_physics import LIGHTS, RGB_LEDS, Stage, led, write_chart


def relative(ours, theirs):
    return np.abs(np.asarray(ours) - theirs).max() / np.abs(theirs).max()


class StageTest(LutgenTest):
    def solve(self, stage, *arguments, **keywords):
        file = stage.write(self.folder, **keywords)
        self.printed = self.assertWorks("stage", "solve", file, "-o", self.folder / "out.json", *arguments)
        return json.loads((self.folder / "out.json").read_text())

    def failing(self, says, extra="", stage=None, **keywords):
        (stage or Stage()).write(self.folder, extra=extra, **keywords)
        self.assertFails("stage", "solve", "stage.yaml", "-o", "out.json", says=says)


class AgainstNumpy(StageTest):
    def test_matrices(self):
        worst = 0.0
        for target in LIGHTS:
            for square in ((1, 1, 1), (2, 0.5, 1.5)):
                with self.subTest(target=target, square=square):
                    stage = Stage(target, square=square, black=(0.011, 0.013, 0.009))
                    ours, theirs = self.solve(stage), stage.solution()
                    for key in ("M", "Q", "N", "beta", "offset"):
                        error = relative(ours[key], theirs[key])
                        worst = max(worst, error)
                        self.assertLessEqual(error, 1e-9, key)
                    patches = np.array([patch["predicted"] for patch in ours["patches"]])
                    self.assertLessEqual(relative(patches, theirs["predicted"]), 1e-9)
                    corrected = np.array([patch["corrected"] for patch in ours["patches"]])
                    self.assertLessEqual(relative(corrected, theirs["predicted"] @ theirs["Q"].T), 1e-9)
                    self.assertEqual([patch["name"] for patch in ours["patches"]], stage.names)
        print(f"largest relative difference from numpy {worst:.1e}")

    def test_form_factor(self):
        self.assertAlmostEqual(self.solve(Stage())["beta"], 4.18, delta=0.005)  # the printed figure has three digits

    def test_white_held(self):
        stage = Stage("FL2")
        ours = self.solve(stage, extra="q: {preserve_white: true, white_patch: white}\n")
        white = next(patch for patch in ours["patches"] if patch["name"].startswith("white"))
        self.assertLessEqual(relative(white["corrected"], white["target"]), 1e-12)
        # Least squares under the constraint, by numpy's own elimination: Q = Q0 + (t - Q0 p) g' / (g' p).
        p, t = stage.solution()["predicted"], stage.target
        q = np.linalg.lstsq(p, t, rcond=None)[0].T
        at = [patch["name"].startswith("white") for patch in ours["patches"]].index(True)
        g = np.linalg.solve(p.T @ p, p[at])
        q = q + np.outer(t[at] - q @ p[at], g) / (g @ p[at])
        self.assertLessEqual(relative(ours["Q"], q), 1e-9)

    def test_skin_weight(self):
        stage = Stage("A")
        ours = self.solve(stage, extra="q: {skin_weight: 25}\n")
        weights = np.where(["skin" in name for name in stage.names], 5.0, 1.0)[:, None]
        q = np.linalg.lstsq(stage.solution()["predicted"] * weights, stage.target * weights, rcond=None)[0].T
        self.assertLessEqual(relative(ours["Q"], q), 1e-9)
        self.assertLess(ours["skin"]["dE_after"]["mean"], self.solve(stage)["skin"]["dE_after"]["mean"])

    def test_spectral_route(self):
        """The same physics as spectra and as captures."""
        worst = 0.0
        for target in LIGHTS:
            captured = self.solve(Stage(target, square=(1.2, 0.8, 1.1), black=(0.01, 0.01, 0.02)))
            red, green, blue = RGB_LEDS
            (self.folder / "spectra.yaml").write_text(
                f"metamer_stage: 1\nspectra: {{emitters: {{red: '{red}', green: '{green}', blue: '{blue}'}}, "
                f"camera: Canon EOS 5D Mark II, target: {target}}}\n"
                "calibration_square: {width_m: 1.2, height_m: 0.8, distance_m: 1.1}\nblack_level: [0.01, 0.01, 0.02]\n")
            self.assertWorks("stage", "solve", self.folder / "spectra.yaml", "-o", self.folder / "spectra.json")
            measured = json.loads((self.folder / "spectra.json").read_text())
            for key in ("M", "Q", "N", "beta", "offset"):
                worst = max(worst, relative(measured[key], np.array(captured[key])))
            self.assertTrue(any("model" in note for note in measured["notes"]))
        print(f"spectral and captured routes differ by at most {worst:.1e}")
        self.assertLessEqual(worst, 1e-6)


class Skin(StageTest):
    """Virtual skins beside the chart, where the stage is given as spectra."""

    def spectra(self, target, camera, *arguments):
        red, green, blue = RGB_LEDS
        (self.folder / "spectra.yaml").write_text(
            f"metamer_stage: 1\nspectra: {{emitters: {{red: '{red}', green: '{green}', blue: '{blue}'}}, "
            f"camera: {camera}, target: {target}}}\n")
        self.printed = self.assertWorks("stage", "solve", self.folder / "spectra.yaml", "-o", self.folder / "s.json",
                                        "--report", self.folder / "s.md", *arguments)
        return json.loads((self.folder / "s.json").read_text())

    def test_priority(self):
        """Skin within 0.6 for at most 1.1 of the chart, by either camera."""
        for camera in ("Canon EOS 5D Mark II", "Nikon D5100"):
            for target in ("A", "D65", "LED-B1"):
                best = self.spectra(target, camera)
                self.assertEqual(best["virtual_skin"]["weight"], 0)
                ours = self.spectra(target, camera, "--priority", "skin")
                skin = ours["virtual_skin"]
                self.assertEqual((skin["count"], skin["weight"]), (200, 6))
                lost = ours["dE_after"]["mean"] - best["dE_after"]["mean"]
                print(f"{camera}, {target}: skin {best['virtual_skin']['dE_after']['mean']:.2f} -> "
                      f"{skin['dE_after']['mean']:.2f} +- {skin['dE_after']['deviation']:.2f}, chart + {lost:.2f}")
                self.assertLessEqual(skin["dE_after"]["mean"], 0.6)
                self.assertLessEqual(lost, 1.1)
                curve = skin["trade_off"]
                self.assertEqual([point["weight"] for point in curve], [0, 0.04, 0.2, 1, 6, 20])
                # More weight, nearer skin and a farther chart: squares fall and rise, means follow.
                self.assertEqual(sorted((point["skin_dE"]["mean"] for point in curve), reverse=True),
                                 [point["skin_dE"]["mean"] for point in curve])
                self.assertAlmostEqual(curve[0]["chart_dE"], best["dE_after"]["mean"], places=12)
                self.assertEqual(curve[4]["skin_dE"], skin["dE_after"])
        self.assertIn("200 virtual skins", self.printed)
        self.assertIn("--priority skin:WEIGHT", self.printed)
        self.assertIn("| **6** |", (self.folder / "s.md").read_text())

    def test_refusals(self):
        self.failing(["priority", "stage's spectra"], extra="q: {skin_priority: 4}\n")
        stage = Stage().write(self.folder)
        for priority, says in (("skin:x", "skin:WEIGHT"), ("faces", "skin:WEIGHT"), ("skin", "stage's spectra")):
            self.assertFails("stage", "solve", stage, "-o", self.folder / "o.json", "--priority", priority, says=[says])
        self.assertNotIn("virtual_skin", self.solve(Stage()))


class Claims(StageTest):
    def test_corrections(self):
        """Q improves every target, is nearly nothing for the RGB LED, and the background keeps its colours."""
        for target in LIGHTS:
            stage = Stage(target)
            ours = self.solve(stage)
            before, after = ours["dE_before"]["mean"], ours["dE_after"]["mean"]
            loop = np.array(ours["Q"]) @ stage.primaries @ np.array(ours["N"])
            away = np.abs(np.array(ours["Q"]) - np.eye(3)).max()
            print(f"{target:9s} M only {before:5.2f}  M+Q+N {after:5.2f}  Q from the identity {away:.2f}  "
                  f"in frustum {np.abs(loop - np.eye(3)).max():.1e}")
            self.assertLess(after, before)
            self.assertFalse(ours["N_bounded"])
            self.assertLessEqual(np.abs(loop - np.eye(3)).max(), 1e-6)

    def test_wall_as_target(self):
        """A target lit by the wall's own LEDs needs no correction at all."""
        power = 2.1 * led(628, 14) + 1.0 * led(525, 24) + 0.7 * led(460, 16)
        ours = self.solve(Stage(power))
        np.testing.assert_allclose(ours["Q"], np.eye(3), atol=1e-9)

    def test_low_pressure_sodium(self):
        """One wavelength: Q is of rank one, N is bounded, and the trade-off is printed."""
        ours = self.solve(Stage(led(589, 1.5)))
        self.assertTrue(ours["N_bounded"])
        self.assertGreater(ours["condition"]["Q"], 100)
        gains = [row["gain"] for row in ours["N_trade_off"]]
        errors = [row["in_frustum_error"] for row in ours["N_trade_off"]]
        self.assertEqual(gains, sorted(gains))
        self.assertEqual(errors, sorted(errors, reverse=True))
        singular = np.linalg.svd(np.array(ours["Q"]))[1]
        n = np.linalg.svd(np.linalg.inv(ours["M"]) @ np.array(ours["N"]))[1]
        self.assertLessEqual(n[0], 100 / singular[0] * (1 + 1e-9))
        self.assertIn("bounded", self.printed)
        self.assertLess(ours["dE_after"]["mean"], 0.3 * ours["dE_before"]["mean"])


class HardCases(StageTest):
    def test_collinear_primaries(self):
        stage = Stage()
        stage.primaries[:, 2] = 0.5 * (stage.primaries[:, 0] + stage.primaries[:, 1])
        self.failing(["stage.yaml", "primaries", "collinear"], stage=stage)

    def test_dead_channel(self):
        stage = Stage()
        stage.primaries[:, 1] = 0
        self.failing(["stage.yaml", "primaries.green", "dead channel"], stage=stage)
        stage = Stage()
        stage.charts[2][:] = 0
        self.failing(["stage.yaml", "charts.blue", "dead channel"], stage=stage)

    def test_missing_patch(self):
        stage = Stage()
        file = stage.write(self.folder)
        write_chart(self.folder / "g.csv", stage.names[1:], stage.charts[1][1:])
        text = (self.folder / "t.csv").read_text().splitlines()
        text[3] = text[3].split(",")[0] + ",,0.2,0.3"
        (self.folder / "t.csv").write_text("\n".join(text))
        self.printed = self.assertWorks("stage", "solve", file, "-o", self.folder / "out.json")
        ours = json.loads((self.folder / "out.json").read_text())
        self.assertEqual([patch["name"] for patch in ours["excluded"]], ["dark skin", "blue sky"])
        self.assertIn("g.csv", ours["excluded"][0]["reason"])
        self.assertIn("excluded: dark skin", self.printed)
        stage.names, stage.target = stage.names[3:], stage.target[3:]  # what is left, but for light skin
        self.assertEqual(len(ours["patches"]), 22)

    def test_saturated_patches(self):
        """By a stated level, and by a plateau of the chart's own values; the rest solves as if they were not there."""
        stage = Stage()
        kept = [i for i in range(24) if i not in (15, 18)]
        reference = Stage()
        reference.names = [reference.names[i] for i in kept]
        reference.target = reference.target[kept]
        reference.charts = [one[kept] for one in reference.charts]
        expected = reference.solution()["Q"]
        stage.target[[15, 18], 0] = stage.target.max() * 1.05
        for extra in ("", f"saturation: {stage.target.max() * 0.999}\n"):
            ours = self.solve(stage, extra=extra)
            self.assertEqual([patch["name"] for patch in ours["excluded"]], [stage.names[15], stage.names[18]])
            self.assertIn("saturated in", ours["excluded"][0]["reason"])
            self.assertLessEqual(relative(ours["Q"], expected), 1e-9)

    def test_negative_values(self):
        stage = Stage()
        stage.charts[2][3, 0] = -0.001
        ours = self.solve(stage)
        self.assertLessEqual(relative(ours["Q"], stage.solution()["Q"]), 1e-9)
        self.assertTrue(any("1 negative value" in note for note in ours["notes"]))

    def test_no_environment(self):
        self.failing(["environment.white", "holds no light"], white=False, extra="environment: {white: [0, 0, 0]}\n")

    def test_out_of_reach(self):
        """A light more saturated than the wall's red: nothing negative is shown, and it says so."""
        ours = self.solve(Stage(led(690, 8)))
        self.assertGreaterEqual(min(ours["environment_drive"]), 0)
        self.assertTrue(any("out of reach" in note for note in ours["notes"]))

    def test_black_level_above_the_signal(self):
        self.failing(["black_level", "above the signal"], stage=Stage(black=(2, 2, 2)))

    def test_one_patch(self):
        stage = Stage()
        stage.names, stage.target = stage.names[:1], stage.target[:1]
        stage.charts = [one[:1] for one in stage.charts]
        ours = self.solve(stage)
        self.assertLessEqual(relative(ours["patches"][0]["corrected"], stage.target[0]), 1e-12)
        self.assertTrue(np.isfinite(ours["N"]).all())
        self.assertTrue(any("independent colours" in note for note in ours["notes"]))

    def test_many_patches(self):
        random = np.random.default_rng(1)
        stage = Stage()
        mix = random.uniform(0, 1, (10000, 24)) / 24
        stage.names = [f"p{i}" for i in range(10000)]
        stage.target = mix @ stage.target
        stage.charts = [mix @ one for one in stage.charts]
        ours = self.solve(stage)
        self.assertEqual(len(ours["patches"]), 10000)
        self.assertLessEqual(relative(ours["Q"], stage.solution()["Q"]), 1e-9)

    def test_bad_files(self):
        self.failing(["stage.yaml:7", "unknown", "saturation"], extra="saturatoin: 1\n")
        self.failing(["stage.yaml:7", "q.skin_weight", "must be a number"], extra="q: {skin_weight: much}\n")
        self.failing(["q.white_patch", "wite", "is not among", "white 9.5"], extra="q: {preserve_white: true, white_patch: wite}\n")
        stage = Stage()
        stage.write(self.folder)
        (self.folder / "b.csv").write_text("patch,R,G\na,1,2\n")
        self.assertFails("stage", "solve", "stage.yaml", "-o", "out.json", says=["b.csv:1", "patch,R,G,B"])
        (self.folder / "b.csv").write_text("patch,R,G,B\na,1,x,2\n")
        self.assertFails("stage", "solve", "stage.yaml", "-o", "out.json", says=["b.csv:2", "G 'x'"])
        (self.folder / "b.csv").unlink()
        self.assertFails("stage", "solve", "stage.yaml", "-o", "out.json", says=["b.csv", "no such file"])
        self.assertFails("stage", "solve", "absent.yaml", "-o", "out.json", says=["absent.yaml"])

    def test_environment_from_the_chart(self):
        """Without an environment, w_avg is the target's white patch."""
        stage = Stage()
        ours = self.solve(stage, white=False)
        np.testing.assert_allclose(ours["environment_white"], stage.target[18], rtol=1e-12)


class Captures(StageTest):
    """Mistakes of a shoot, named before the solve; and what its noise leaves open."""

    def test_mistakes_are_named(self):
        stage = Stage()
        stage.charts[0], stage.charts[1] = stage.charts[1], stage.charts[0]
        self.failing(["stage.yaml", "charts 'red and green'", "are exchanged, against the primaries"], stage=stage)
        stage = Stage()
        stage.target = stage.target.reshape(4, 6, 3)[:, ::-1].reshape(24, 3)
        self.failing(["charts.target 'mirrored left to right'"], stage=stage)
        stage = Stage()
        stage.primaries = 2 * stage.primaries
        self.failing(["primaries '+1.00 stops'", "one exposure"], stage=stage)
        stage = Stage()
        stage.target[[3, 7]] += 0.1
        self.failing(["charts.target", "is veiled", "so: charts.target"], stage=stage)

    def test_as_captured(self):
        stage = Stage()
        stage.primaries = 2 * stage.primaries
        ours = self.solve(stage, "--as-captured")
        self.assertTrue(any(note.startswith("as captured: primaries '+1.00 stops'") for note in ours["notes"]))
        self.assertLessEqual(relative(ours["Q"], stage.solution()["Q"]), 1e-9)

    def test_intervals(self):
        stage = Stage("FL2")
        random = np.random.default_rng(1)
        noisy = lambda values: values * (1 + 0.01 * random.standard_normal(np.shape(values)))
        stage.primaries, stage.target = noisy(stage.primaries), noisy(stage.target)
        stage.charts = [noisy(one) for one in stage.charts]
        stated = self.solve(stage, "--report", self.folder / "r.md", extra="noise: 0.01\n")["intervals"]
        self.assertEqual((stated["noise_is"], stated["samples"], stated["noise"]["relative"]), ("stated", 500, 0.01))
        # The same by numpy: as many draws of another generator.
        draws = []
        for _ in range(500):
            m = np.linalg.inv(noisy(stage.primaries))
            drives = np.maximum(m @ noisy(stage.white), 0)
            predicted = sum(noisy(one) * drive for one, drive in zip(stage.charts, drives)) / stage.factor
            draws.append(np.linalg.lstsq(predicted, noisy(stage.target), rcond=None)[0].T)
        low, high = np.quantile(draws, [0.025, 0.975], axis=0)
        width = (high - low).max()
        # The ends of 500 draws are known to a sixth of a standard deviation, a 25th of the width.
        np.testing.assert_allclose(stated["Q"]["low"], low, atol=0.15 * width)
        np.testing.assert_allclose(stated["Q"]["high"], high, atol=0.15 * width)
        self.assertIn("95 % intervals of 500 draws", (self.folder / "r.md").read_text())
        self.assertIn("95 % intervals of 500 draws of noise (1 %, stated)", self.printed)
        estimated = self.solve(stage)["intervals"]
        self.assertEqual(estimated["noise_is"], "estimated from the charts")
        self.assertAlmostEqual(estimated["noise"]["relative"], 0.01, delta=0.004)
        self.assertEqual(self.solve(stage)["intervals"], estimated)
        self.assertNotEqual(self.solve(stage, "--seed", 2)["intervals"], estimated)
        self.assertNotIn("intervals", self.solve(stage, "--samples", 0))

    def test_bad_noise(self):
        self.failing(["stage.yaml:7", "noise", "much"], extra="noise: much\n")
        self.failing(["stage.yaml:7", "noise.relative", "2"], extra="noise: {relative: 2}\n")
        Stage().write(self.folder)
        self.assertFails("stage", "solve", "stage.yaml", "-o", "o.json", "--samples", 3, code=2, says=["--samples"])


if __name__ == "__main__":
    unittest.main()
