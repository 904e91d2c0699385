# SPDX-License-Identifier: Apache-2.0
"""What `--tolerance` promises, measured again by other means on other probes.

The files are read by the newest OpenColorIO, differences are colour-science's, the lights are colour-science's own, and
the truth is tests/oracle/bounded_engine.py: the definition by dense algebra with 201 bands, which shares no code with
metamer. By default a few recipes at one tolerance; METAMER_LONG=1 has all twelve at 0.5, 1 and 2.
"""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import colour
import matplotlib.path
import numpy as np
from scipy.stats import qmc

from ocio_releases import BIN, newest

sys.path.append(str(Path(__file__).parents[1] / "oracle"))
import bounded_engine  # noqa: E402

LONG = bool(os.environ.get("METAMER_LONG"))
BANDS = 201
COUNT = 1000 if LONG else 400
# Input, output, adaptation, file, stops. Tables of a log signal are asked for the exposures they are good at.
WIDE = (-10, 10)
RECIPES = [
    ("D65", "A", 0, ".ctf", WIDE),
    ("D65", "HP1", 0, ".ctf", WIDE),
    ("D65", "FL11", 0.5, ".ctf", WIDE),
    ("D65", "LED-RGB1", 1, ".ctf", WIDE),
    ("A", "D65", 0, ".ctf", WIDE),
    ("FL11", "D50", 0, ".ctf", WIDE),
    ("D65", "D50", 1, ".ctf", WIDE),
    ("D50", "D65", 0.5, ".ctf", WIDE),
    ("D65", "A", 0, ".cube", (-1, 5)),
    ("D65", "D50", 1, ".clf", (-1, 5)),
    ("A", "D65", 1, ".clf", (0, 5)),
    ("D50", "HP1", 0.5, ".cube", (0, 5)),
]
SHORT = [0, 3, 6, 8]
AP1 = np.array([[0.713, 0.293], [0.165, 0.830], [0.128, 0.044]])
WHITE_XY = np.array([0.32168, 0.33767])
XYZ_FROM_RGB = colour.RGB_COLOURSPACES["ACEScg"].matrix_RGB_to_XYZ


def locus():
    """Chromaticities of all wavelengths, closed by the line of purples."""
    curves = bounded_engine.observer(bounded_engine.EYE)
    # Where the eye sees next to nothing, chromaticities are noise.
    curves = curves[curves.sum(axis=1) > 1e-3 * curves.sum(axis=1).max()]
    return matplotlib.path.Path(curves[:, :2] / curves.sum(axis=1, keepdims=True))


def probes(engine, adaptation, seed):
    """Colours of lights spread over AP1 at Y = 0.18, and where they go.

    Evenly, but not where metamer's own probes lie: by chance, a percentile that depends on how many of a thousand fall
    into one corner of the gamut would itself be uncertain by a third.
    """
    sequence, border = qmc.Halton(2, seed=seed), locus()
    light = []
    while len(light) < COUNT:
        u, v = sequence.random()[0]
        u, v = (1 - u, 1 - v) if u + v > 1 else (u, v)
        xy = AP1[0] + u * (AP1[1] - AP1[0]) + v * (AP1[2] - AP1[0])
        if border.contains_point(xy):
            light.append(np.linalg.inv(XYZ_FROM_RGB) @ (0.18 * colour.xy_to_XYZ(xy)))
    return np.array(light), np.array([engine.apply(rgb, adaptation) for rgb in light])


def lab(rgb):
    return colour.XYZ_to_Lab(rgb @ XYZ_FROM_RGB.T, WHITE_XY)


def encode(linear):
    """ACEScct, Academy S-2016-001."""
    return np.where(linear <= 0.0078125, 10.5402377416545 * linear + 0.0729055341958355,
                    (np.log2(np.maximum(linear, 1e-30)) + 9.72) / 17.52)


def decode(signal):
    return np.where(signal <= 0.155251141552511, (signal - 0.0729055341958355) / 10.5402377416545,
                    np.exp2(signal * 17.52 - 9.72))


def measure(file, light, expected, stops):
    """99th percentile over the probes at every stop."""
    differences = []
    for stop in range(stops[0], stops[1] + 1):
        exposed = light * 2.0**stop
        pixels = np.ones((len(light), 4), np.float32)
        pixels[:, :3] = encode(exposed) if file.suffix == ".cube" else exposed
        result = newest(file, pixels)[:, :3].astype(np.float64)
        result = (decode(result) if file.suffix == ".cube" else result) / 2.0**stop
        differences.append(colour.delta_E(lab(expected), lab(result), method="CIE 2000"))
    return float(np.quantile(np.concatenate(differences), 0.99))


class Tolerances(unittest.TestCase):
    def test_the_certificate_is_not_exceeded(self):
        chosen = range(len(RECIPES)) if LONG else SHORT
        with tempfile.TemporaryDirectory() as folder:
            for index in chosen:
                source, destination, adaptation, extension, stops = RECIPES[index]
                engine = bounded_engine.Engine(source, destination, bounded_engine.EYE, "natural", BANDS)
                light, expected = probes(engine, adaptation, index)
                for tolerance in (0.5, 1, 2) if LONG else (1,):
                    # A name of its own: OCIO keeps what it has read by name.
                    file = Path(folder) / f"{index}_{tolerance}{extension}"
                    with self.subTest(recipe=RECIPES[index], tolerance=tolerance):
                        run = subprocess.run(
                            [BIN / "lutgen", "bake", "--illuminant-in", source, "--illuminant-out", destination,
                             "--adaptation", str(adaptation), "--tolerance", str(tolerance), "--size", "97",
                             "--stops", str(stops[0]), str(stops[1]), "-o", file],
                            capture_output=True, text=True)
                        self.assertEqual(run.returncode, 0, run.stderr)
                        certificate = json.loads(Path(str(file) + ".json").read_text())
                        stated, transform = certificate["error"]["p99"], certificate["transform"]
                        tried = transform["choice"]["tried"]
                        found = measure(file, light, expected, stops)
                        print(f"{source:4s} -> {destination:8s} D={adaptation} {extension:5s} {stops} tolerance {tolerance}: "
                              f"{transform['representation']} {transform.get('size', '')} states {stated:.3f}, "
                              f"measured again {found:.3f}; next cheaper "
                              f"{tried[-2]['p99'] if len(tried) > 1 else float('nan'):.3f}", flush=True)
                        self.assertLessEqual(stated, tolerance)
                        self.assertLessEqual(found, 1.2 * stated)
                        for cheaper in tried[:-1]:
                            self.assertGreater(cheaper["p99"], tolerance)


if __name__ == "__main__":
    unittest.main()
