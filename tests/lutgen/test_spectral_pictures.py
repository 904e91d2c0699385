# SPDX-License-Identifier: Apache-2.0
"""Spectral OpenEXR pictures as lights: a picture's mean, a pixel of it, an environment."""

import os
import subprocess
import unittest
from pathlib import Path

import numpy as np
import OpenEXR

from lutgen import LutgenTest

SPECTRAL_REF = Path(os.environ["METAMER_BIN"]) / "spectral_ref"
WAVELENGTHS = np.arange(380, 781, 20.0)
RECIPE = "metamer: 1\nname: transform\ninput: {illuminant: D65}\noutput: {illuminant: '%s'}\n"
SCENE = """metamer_scene: 1
film: {width: 8, height: 8, space: XYZ}
camera: {origin: [0, 0, 3], target: [0, 0, 0], up: [0, 1, 0], fov_x: 30}
%s
shapes:
  - rectangle: {center: [0, 0, 0], half_u: [2, 0, 0], half_v: [0, 2, 0]}
    diffuse: 0.5
"""


def lamps():
    """Two halves of a picture, of two lamps."""
    warm = np.exp((WAVELENGTHS - 580) / 120)
    cool = 1.5 + np.sin(WAVELENGTHS / 60)
    return np.concatenate([np.tile(warm, (4, 4, 1)), np.tile(cool, (4, 4, 1))], axis=1)


class SpectralPictures(LutgenTest):
    def setUp(self):
        super().setUp()
        self.pixels = lamps().astype(np.float32)
        self.picture("probe.exr")

    def picture(self, name, kind=OpenEXR.ZIP_COMPRESSION, **header):
        channels = {f"S0.{nm:.6f}nm".replace(".", ",").replace("S0,", "S0."): np.ascontiguousarray(self.pixels[..., k])
                    for k, nm in enumerate(WAVELENGTHS)}
        channels |= {"R": np.ones((4, 8), np.float16)}
        OpenEXR.File({"compression": kind, "type": OpenEXR.scanlineimage, **header}, channels).write(str(self.folder / name))

    def table(self, name, values):
        rows = "".join(f"{nm},{value!r}\n" for nm, value in zip(WAVELENGTHS, values.astype(float).tolist()))
        (self.folder / name).write_text("wavelength_nm,lamp\n" + rows)

    def numbers(self, light):
        (self.folder / "r.yaml").write_text(RECIPE % light)
        self.assertWorks("bake", "r.yaml", "-o", "a.cube", "--size", 7, "--sampled", "--quiet")
        lines = (self.folder / "a.cube").read_text().splitlines()
        return np.array([line.split() for line in lines if line[:1] in "-0123456789" and line], float)

    def test_as_a_light(self):
        """The picture's mean, and a pixel, are what a table of the same numbers is."""
        flat = self.pixels.astype(float).reshape(-1, WAVELENGTHS.size).mean(axis=0)
        for light, values in (("probe.exr", flat), ("probe.exr:1,2", self.pixels[2, 1]), ("probe.exr:6,0", self.pixels[0, 6])):
            with self.subTest(light):
                self.table("lamp.csv", values)
                # The picture's mean is summed in another order than ours.
                np.testing.assert_allclose(self.numbers(light), self.numbers("lamp.csv"), atol=1e-6)
        self.assertWorks("bake", "--illuminant-in", "D65", "--illuminant-out", "probe.exr:7,3", "-o", "b.cube", "--size", 5, "--quiet")

    def test_refusals(self):
        OpenEXR.File({}, {"RGB": np.ones((2, 2, 3), np.float32)}).write(str(self.folder / "rgb.exr"))
        (self.folder / "cut.exr").write_bytes((self.folder / "probe.exr").read_bytes()[:700])
        (self.folder / "text.exr").write_text("hello")
        self.pixels[1, 1, 3] = np.nan
        self.picture("nan.exr")
        for light, says in (
            ("rgb.exr", ["rgb.exr", "not spectral", "S0.550"]),
            ("cut.exr", ["cut.exr", "damaged"]),
            ("text.exr", ["text.exr", "no OpenEXR"]),
            ("gone.exr", ["gone.exr", "no such file"]),
            ("nan.exr", ["nan.exr", "S0.440,000000nm", "finite"]),
            ("probe.exr:8,0", ["pixel '8,0'", "x 0 to 7, y 0 to 3"]),
            ("probe.exr:warm", ["pixel 'warm'", "FILE:x,y"]),
        ):
            with self.subTest(light):
                self.assertFails("bake", "--illuminant-in", "D65", "--illuminant-out", light, "-o", "b.cube", says=says)
        self.assertFails("bake", "--illuminant-in", "D65", "--illuminant-out", "A", "--observer-in", "probe.exr",
                         "--observer-out", "probe.exr", "-o", "b.cube", says=["probe.exr", "sensitivity"])

    def rendered(self, lights):
        (self.folder / "s.yaml").write_text(SCENE % lights)
        run = subprocess.run([SPECTRAL_REF, "render", "s.yaml", "-o", "s.exr", "--spp", "512"], cwd=self.folder,
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        return OpenEXR.File(str(self.folder / "s.exr")).channels()["RGB"].pixels.astype(float).mean(axis=(0, 1))

    def test_as_an_environment(self):
        """Light of one spectrum all around, as a picture and as the spectrum of one of its pixels."""
        self.pixels = np.tile(self.pixels[0, 0], (4, 8, 1))
        self.picture("even.exr")
        picture = self.rendered("lights: [{environment: {picture: even.exr, scale: 2}}]")
        spectrum = self.rendered("spectra: {lamp: {file: 'even.exr:0,0', scale: 2}}\n"
                                 "lights: [{environment: {emission: lamp}}]")
        # 32,768 paths each; a path's Y varies by half of it.
        np.testing.assert_allclose(picture, spectrum, rtol=0.02)
        self.assertGreater(picture[1], 0.2)


if __name__ == "__main__":
    unittest.main()
