# SPDX-License-Identifier: Apache-2.0
"""A chart under a lamp, and an LED wall over a box, in two renderers: means within their joint intervals."""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

try:
    import mitsuba  # noqa: F401
except ImportError:
    print("mitsuba is not installed: skipped")
    sys.exit(77)

import mitsuba_chart
import mitsuba_wall
import OpenEXR

PROGRAM = Path(os.environ["METAMER_BIN"]) / "spectral_ref"
SIZE = (48, 32)
SCENE = """metamer_scene: 1
film: {width: 48, height: 32}
camera: {origin: [0, 0, 10], target: [0, 0, 0], up: [0, 1, 0], fov_x: 34}
integrator: {max_depth: 2, wavelengths: 4}
spectra: {lamp: {illuminant: LAMP, scale: 0.5}}
shapes:
  - chart: {set: colorchecker, center: [0, 0, 0], half_u: [3, 0, 0], half_v: [0, 2, 0]}
  - rectangle: {center: [-3, 4, 6], half_u: [0.3, 0, 0], half_v: [0, 0, 0.3]}
    emission: lamp
"""


WALL = """metamer_scene: 1
film: {width: 48, height: 32}
camera: {origin: [0, 1.2, 7], target: [0, 1.2, 0], up: [0, 1, 0], fov_x: 40}
integrator: {max_depth: 2, wavelengths: 4}
spectra: {grey: {constant: 0.5}}
shapes:
  - led_wall: {center: [0, 3.2, 0.5], half_u: [1.8, 0, 0], half_v: [0, 0, 1.4], picture: wall.exr,
               emitters: [LED-B1, LED-V1, LED-RGB1], scale: 0.02}
  - rectangle: {center: [0, 0, 1], half_u: [2, 0, 0], half_v: [0, 0, -2]}
    diffuse: grey
  - rectangle: {center: [0, 1.5, -1], half_u: [2, 0, 0], half_v: [0, 1.5, 0]}
    diffuse: grey
  - sphere: {center: [-0.8, 0.5, 1.2], radius: 0.5}
    diffuse: grey
  - chart: {set: colorchecker, center: [0.6, 1.2, 0], half_u: [0.9, 0, 0], half_v: [0, 0.6, 0]}
"""


class AgainstMitsuba(unittest.TestCase):
    def compare(self, lamp):
        runs = [mitsuba_chart.render(lamp, SIZE, 128, "scalar_spectral", seed=100 * run)[0] for run in range(8)]
        theirs = np.array(runs)
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "scene.yaml"
            scene.write_text(SCENE.replace("LAMP", lamp))
            picture = Path(folder) / "chart.exr"
            subprocess.run([PROGRAM, "render", scene, "-o", picture, "--spp", "1024"], check=True)
            patches, areas = [], []
            half_width = np.tan(np.radians(17)) * 10
            scale = SIZE[0] / 2 / half_width
            for i in range(24):
                u, v = 3 * ((2 * (i % 6) + 1) / 6 - 1), 2 * (1 - (2 * (i // 6) + 1) / 4)
                x, y = SIZE[0] / 2 + u * scale, SIZE[1] / 2 - v * scale
                area = (round(x) - 2, round(y) - 2, 4, 4)
                areas.append(area)
                patches += ["--patch", f"{i}=" + ",".join(map(str, area))]
            report = json.loads(subprocess.run([PROGRAM, "measure", picture, "--json", *patches], check=True,
                                               capture_output=True, text=True).stdout)
        largest = 0
        for (x, y, w, h), patch in zip(areas, report["patches"]):
            means = theirs[:, y : y + h, x : x + w].mean((1, 2))
            error = np.hypot(np.sqrt(patch["variance"]), means.std(ddof=1) / np.sqrt(8))
            z = (means.mean() - patch["Y"]) / error
            largest = max(largest, abs(means.mean() / patch["Y"] - 1))
            # Eight runs: Student's t with seven degrees of freedom, 24 patches, 0.1 % in all.
            self.assertLess(abs(z), 9, patch["name"])
            # And no more apart than their noise explains: 128 x 8 samples of 16 pixels.
            self.assertLess(abs(means.mean() / patch["Y"] - 1), 0.03, patch["name"])
        print(f"{lamp}: largest relative difference of a patch {largest:.4f}")

    def test_led_wall(self):
        """Each pixel of the wall, as an area light of its own: rows, columns and mixtures lie where they should."""
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            drives = np.random.default_rng(5).uniform(0, 1, (6, 8, 3)).astype(np.float32) ** 3
            OpenEXR.File({}, {"RGB": drives}).write(str(folder / "wall.exr"))
            theirs = np.array([mitsuba_wall.render(folder / "wall.exr", SIZE, 128, "scalar_spectral", seed=100 * run)[0]
                               for run in range(8)])
            (folder / "scene.yaml").write_text(WALL)
            for restir in ("off", "lanes"):
                ours = []
                for seed in range(8):
                    subprocess.run([PROGRAM, "render", folder / "scene.yaml", "-o", folder / "wall_lit.exr", "--spp", "128",
                                    "--seed", str(seed), "--restir", restir], check=True)
                    picture = OpenEXR.File(str(folder / "wall_lit.exr"), separate_channels=True).channels()
                    ours.append(picture["Y"].pixels.astype(float))
                # Squares of 8 pixels: Y from a tenth of the brightest to the brightest.
                squares = [np.asarray(runs).reshape(8, 4, 8, 6, 8).mean((2, 4)) for runs in (theirs, ours)]
                means = [square.mean(0) for square in squares]
                error = np.sqrt(sum(square.var(0, ddof=1) / 8 for square in squares))
                lit = means[0] > 0.1 * means[0].max()
                z = np.abs(means[1] - means[0])[lit] / error[lit]
                relative = np.abs(means[1] / np.maximum(means[0], 1e-9) - 1)[lit]
                print(f"LED wall, ReSTIR {restir}: {lit.sum()} squares, largest relative difference {relative.max():.4f}, "
                      f"largest z {z.max():.1f}")
                # Eight runs each: Student's t with about ten degrees of freedom, at most 24 squares, 0.1 % in all.
                self.assertLess(z.max(), 6)
                self.assertLess(relative.max(), 0.02)

    def test_tungsten(self):
        self.compare("A")

    def test_fluorescent(self):
        self.compare("FL11")


if __name__ == "__main__":
    unittest.main()
