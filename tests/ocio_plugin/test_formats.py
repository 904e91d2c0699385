# SPDX-License-Identifier: Apache-2.0
"""Every format lutgen writes: read by both releases of OpenColorIO, and a grey ramp through each."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import colour
import numpy as np

from ocio_releases import BIN, older, newest

SIZE = 33
WHITE = colour.xy_to_XYZ([0.32168, 0.33767])
LINEAR_EXTENSIONS = {".ctf", ".clf"}


def acescct(linear):
    """ACEScct, Academy S-2016-001."""
    return np.where(linear <= 0.0078125, 10.5402377416545 * linear + 0.0729055341958355,
                    (np.log2(np.maximum(linear, 1e-30)) + 9.72) / 17.52)


def acescct_inverse(signal):
    return np.where(signal <= 0.155251141552511, (signal - 0.0729055341958355) / 10.5402377416545,
                    np.exp2(signal * 17.52 - 9.72))


def lutgen(*arguments):
    return subprocess.run([BIN / "lutgen", *map(str, arguments)], check=True, capture_output=True, text=True).stdout


def formats():
    """All tables that `lutgen list formats` prints, but for curves, which hold no look."""
    return [f for f in json.loads(lutgen("list", "formats", "--json")) if f["name"] != "spi1d" and not f["shader"]]


def lab(rgb):
    matrix = colour.RGB_COLOURSPACES["ACEScg"].matrix_RGB_to_XYZ
    return colour.XYZ_to_Lab(rgb @ matrix.T, colour.XYZ_to_xy(WHITE))


def through(reader, file, light):
    """Light through a file: cubes are on ACEScct."""
    isLight = file.suffix in LINEAR_EXTENSIONS
    pixels = np.ones((len(light), 4), np.float32)
    pixels[:, :3] = light if isLight else acescct(light)
    result = reader(file, pixels)[:, :3].astype(np.float64)
    return result if isLight else acescct_inverse(result)


class Formats(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = Path(cls.temporary.name)
        cls.files, cls.has_shaper = {}, {}
        for adaptation in (0, 1):
            for entry in formats():
                file = cls.folder / f"{adaptation}_{entry['name'].replace('/', '_')}{entry['extension']}"
                # The smooth scene is solved in half the time of the others.
                lutgen("bake", "--illuminant-in", "D65", "--illuminant-out", "HP1", "--adaptation", adaptation, "--scene", "smooth",
                       "--size", SIZE, "--format", entry["name"], "-o", file)
                cls.files[adaptation, entry["name"]] = file
                settings = json.loads(Path(f"{file}.json").read_text(encoding="utf-8"))["transform"]
                cls.has_shaper[entry["name"]] = "shaper_entries" in settings

    def test_both_releases_read_what_was_baked(self):
        """Against the same table in the format with most digits: what a format's own precision costs."""
        random = np.random.default_rng(5)
        light = 0.18 * 2.0 ** random.uniform(-4, 4, (2000, 1)) * random.dirichlet([1.5, 1.5, 1.5], 2000) * 3
        scale = 0.18 / light.mean(axis=1, keepdims=True)
        baked = {}
        for name, file in ((n, f) for (a, n), f in self.files.items() if a == 0):
            for release, reader in (("2.1", older), ("newest", newest)):
                baked[name, release] = through(reader, file, light) * scale
        for (name, release), result in baked.items():
            reference = "Color Transform Format" if name == "Color Transform Format" else "iridas_cube"
            if self.has_shaper[name]:
                reference = "Academy/ASC Common LUT Format"
            wanted = baked[reference, "2.1"]
            error = colour.delta_E(lab(wanted), lab(result), method="CIE 2000")
            if name in ("flame", "lustre"):
                # Whole numbers hold nothing below zero: sodium's own dark blues are bent in there, and differ by that.
                error = error[wanted.min(axis=1) > 0.02]
                self.assertGreater(len(error), 500)
            print(f"{name:32s} OCIO {release:7s} dE2000 mean {error.mean():.5f} max {error.max():.5f}")
            # Twelve bits of ACEScct are half a hundredth of a stop: below a tenth of a difference but in dark channels.
            self.assertLess(error.max(), 0.3 if name in ("flame", "lustre") else 0.002, (name, release))
            self.assertLess(error.mean(), 0.05 if name in ("flame", "lustre") else 0.0005, (name, release))

    def test_grey_ramps_rise_and_stay_neutral(self):
        grey = 0.18 * 2.0 ** np.linspace(-10, 6, 4096)
        light = np.repeat(grey[:, None], 3, axis=1)
        for (adaptation, name), file in self.files.items():
            for release, reader in (("2.1", older), ("newest", newest)):
                with self.subTest(format=name, adaptation=adaptation, release=release):
                    result = through(reader, file, light)
                    direction = np.sign(result[-1])
                    self.assertTrue((np.diff(result * direction, axis=0) > 0).all(), "not strictly monotone")
                    if adaptation == 1:
                        spread = np.abs(result / result.mean(axis=1, keepdims=True) - 1).max()
                        print(f"{name:32s} OCIO {release:7s} neutral within {spread:.1e}")
                        self.assertLess(spread, 1e-4)

    def test_certificates_are_inside_where_there_is_room(self):
        for (_, name), file in self.files.items():
            text = file.read_text()
            self.assertEqual("CIEDE2000 against the spectral engine" in text, name not in ("houdini", "spi3d"), name)
            certificate = json.loads(Path(str(file) + ".json").read_text())
            self.assertEqual(certificate["transform"]["format"], name)
            for key in ("recipe", "inputs", "tool", "range", "error", "diagnostics", "policy"):
                self.assertIn(key, certificate)

    def test_what_curves_cannot_hold_is_refused(self):
        run = subprocess.run([BIN / "lutgen", "bake", "--illuminant-in", "D65", "--illuminant-out", "A", "-o",
                              self.folder / "a.spi1d"], capture_output=True, text=True)
        self.assertEqual(run.returncode, 1)
        self.assertIn("mixes channels", run.stderr)
        self.assertFalse((self.folder / "a.spi1d").exists())


if __name__ == "__main__":
    unittest.main()
