# SPDX-License-Identifier: Apache-2.0
"""Ramps in a stage file: the wall's EOTF, and what is to be sent."""

import json
import unittest

import numpy as np
import OpenEXR
import PyOpenColorIO

from lutgen import LutgenTest, lutgen
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

    def test_inline_ramps_and_the_signal(self):
        """Rows in the stage file are what a CSV of them is; PREFIX_signal has what is sent for every drive."""
        for name in ("2.2", "PQ"):
            with self.subTest(name):
                by_file = self.solve(EOTFS[name], 0.01)
                rows = {}
                for channel in CHANNELS:
                    lines = (self.folder / f"ramp_{channel}.csv").read_text().splitlines()[1:]
                    rows[channel] = "[" + ", ".join(f"[{line}]" for line in lines) + "]"
                self.stage.write(self.folder, extra="ramps: {" + ", ".join(f"{c}: {rows[c]}" for c in CHANNELS) + "}\n")
                self.assertWorks("stage", "solve", "stage.yaml", "-o", "in.json", "--samples", 0, "--as-captured", "--luts", "w")
                ours = json.loads((self.folder / "in.json").read_text())
                self.assertEqual(ours["eotf"], by_file["eotf"])
                self.assertEqual(ours["environment_signal"], by_file["environment_signal"])
                drives = np.array([[-0.1] * 3, [0] * 3, ours["environment_drive"], [1e-3] * 3, [0.4] * 3, [1.0] * 3, [1.7] * 3])
                for extension in ("clf", "ctf"):
                    got = self.applied(f"w_signal.{extension}", drives)
                    # Single precision; PQ's dark steps are steep.
                    np.testing.assert_allclose(got[2], ours["environment_signal"], atol=2e-5)
                    np.testing.assert_allclose(got[[0, 5]], got[[1, 6]], atol=1e-6)
                    np.testing.assert_allclose(EOTFS[name](got[3:6]), drives[3:6], rtol=0.1)
                self.assertFalse((self.folder / "w_signal.spimtx").exists())
                self.config_sends(EOTFS[name], ours)
        Stage().write(self.folder, extra="ramps: {red: [[0, 0, 0], [1, 1, 0]], green: g.csv, blue: b.csv}\n")
        self.assertFails("stage", "solve", "stage.yaml", "-o", "x.json", says=["ramps.red", "4 numbers"])
        row = "[[-1, 0, 0, 0], [1, 1, 0, 0]]"
        Stage().write(self.folder, extra=f"ramps: {{red: {row}, green: {row}, blue: {row}}}\n")
        self.assertFails("stage", "solve", "stage.yaml", "-o", "x.json", says=["ramps.red[0] '-1'", "from 0"])
        row = "[[0, 0, 0, 0], [1, 1, 0, 0]]"
        Stage().write(self.folder, extra=f"ramps: {{red: {row}, green: {row}, blue: {row}}}\n")
        self.assertFails("stage", "solve", "stage.yaml", "-o", "x.json", says=["stage.yaml: ramps.red", "drives"])

    def config_sends(self, light, ours):
        """The spaces of the signal are those of the wall behind its curve, also where the LUTs lie in another folder."""
        (self.folder / "luts").mkdir(exist_ok=True)
        for prefix, base in (("w", []), ("luts/w", []), ("luts/w", ["--base", "base.ocio"])):
            (self.folder / "base.ocio").write_text("""ocio_profile_version: 2
search_path: other
roles: {aces_interchange: ACES2065-1, default: ACES2065-1}
displays:
  d:
    - !<View> {name: v, colorspace: ACES2065-1}
colorspaces:
  - !<ColorSpace> {name: ACES2065-1}
""")
            self.assertWorks("stage", "solve", "stage.yaml", "-o", "in.json", "--samples", 0, "--as-captured", "--luts", prefix,
                             "--config", "w.ocio", *base)
            PyOpenColorIO.ClearAllCaches()  # files of these names were others
            config = PyOpenColorIO.Config.CreateFromFile(str(self.folder / "w.ocio"))
            config.validate()
            name = next(s for s in config.getColorSpaceNames() if s.endswith(" camera"))[: -len(" camera")]
            camera = np.array([[0.05, 0.08, 0.06], [0.12, 0.1, 0.09]], np.float32)
            sent, asked = ([config.getProcessor(f"{name} camera", f"{name} {kind} in frustum").getDefaultCPUProcessor().applyRGB(
                row.tolist()) for row in camera] for kind in ("signal", "wall"))
            np.testing.assert_allclose(light(np.array(sent)), np.clip(asked, 0, 1), rtol=0.1, atol=2e-3)

    def applied(self, lut, rgb):
        OpenEXR.File({}, {"RGB": rgb[None].astype(np.float32)}).write(str(self.folder / "i.exr"))
        self.assertEqual(lutgen("apply", lut, "i.exr", "o.exr", "--quiet", folder=self.folder).returncode, 0)
        return OpenEXR.File(str(self.folder / "o.exr")).channels()["RGB"].pixels[0].astype(float)

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
