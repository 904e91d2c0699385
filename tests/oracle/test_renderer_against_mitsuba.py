# SPDX-License-Identifier: Apache-2.0
"""A chart under a lamp in two renderers: patch means within their joint intervals."""

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

    def test_tungsten(self):
        self.compare("A")


if __name__ == "__main__":
    unittest.main()
