# SPDX-License-Identifier: Apache-2.0
"""Ramps in a stage file: the wall's EOTF, and what is to be sent."""

import json
import unittest

import numpy as np

from lutgen import LutgenTest
from stage_physics import Stage, write_chart

CHANNELS = ("red", "green", "blue")
RAMPS = "ramps: {red: ramp_red.csv, green: ramp_green.csv, blue: ramp_blue.csv}\n"


def pq(code):
    """SMPTE ST 2084, of its full."""
    root = code ** (32 / 2523)
    return (np.maximum(root - 3424 / 4096, 0) / (2413 / 128 - 2392 / 128 * root)) ** (16384 / 2610)


EOTFS = {"2.2": lambda d: d**2.2, "2.4": lambda d: d**2.4, "PQ": pq}


class Ramps(LutgenTest):
    def solve(self, light, noise, seed=0):
        random = np.random.default_rng(seed)
        # A dim place: its white is well within full drive.
        self.stage = Stage("D65")
        self.stage.white = 0.25 * self.stage.white
        drives = np.linspace(0, 1, 17)
        for k, channel in enumerate(CHANNELS):
            rgb = np.outer(light(drives), self.stage.primaries[:, k]) + 0.001
            write_chart(self.folder / f"ramp_{channel}.csv", map(repr, drives.tolist()),
                        rgb * (1 + noise * random.standard_normal(rgb.shape)))
        self.stage.write(self.folder, extra=RAMPS)
        self.printed = self.assertWorks("stage", "solve", "stage.yaml", "-o", "out.json", "--report", "out.md",
                                        "--samples", 0, "--as-captured")
        return json.loads((self.folder / "out.json").read_text())

    def test_known_walls(self):
        """What the wall makes of the signal is the light that M asks."""
        worst = {}
        for name, light in EOTFS.items():
            for seed in range(5):
                ours = self.solve(light, 0.01, seed)
                for k, channel in enumerate(CHANNELS):
                    eotf = ours["eotf"][channel]
                    self.assertEqual(eotf["model"], "curve" if name == "PQ" else "power")
                    if name != "PQ":
                        self.assertAlmostEqual(eotf["gamma"], float(name), delta=0.1)
                    self.assertLess(eotf["residual"], 0.025)
                    asked = ours["environment_drive"][k]
                    self.assertTrue(0.05 < asked < 1, asked)
                    shown = light(np.array(ours["environment_signal"][k]))
                    worst[name] = max(worst.get(name, 0), abs(shown / asked - 1))
            self.assertIn("EOTF of red", self.printed)
            self.assertIn("EOTF of blue", (self.folder / "out.md").read_text())
        print("light of the signal against what was asked, 1 % noise: "
              + ", ".join(f"{name} within {100 * error:.1f} %" for name, error in worst.items()))
        # Four deviations of 1 %, and 1 % between steps of PQ.
        self.assertLessEqual(max(worst.values()), 0.05)

    def test_matrices_stay(self):
        """M, Q and N are of light: a ramp moves none of them."""
        ours, theirs = self.solve(EOTFS["2.4"], 0), self.stage.solution()
        for key in ("M", "Q", "N"):
            np.testing.assert_allclose(ours[key], theirs[key], rtol=0, atol=1e-9 * np.abs(theirs[key]).max())
        np.testing.assert_allclose(ours["environment_signal"], np.array(ours["environment_drive"]) ** (1 / 2.4), rtol=1e-6)

    def test_refusals(self):
        Stage().write(self.folder, extra="ramps: {red: r.csv, green: g.csv}\n")
        solve = ("stage", "solve", "stage.yaml", "-o", "out.json")
        self.assertFails(*solve, says=["ramps.blue", "missing"])
        Stage().write(self.folder, extra=RAMPS)
        self.assertFails(*solve, says=["ramp_red.csv"])
        for channel in CHANNELS:
            (self.folder / f"ramp_{channel}.csv").write_text("patch,R,G,B\n" + "".join(f"{i},{i},0,0\n" for i in range(1, 9)))
        self.assertFails(*solve, says=["ramp_red.csv", "begin at 0"])


if __name__ == "__main__":
    unittest.main()
