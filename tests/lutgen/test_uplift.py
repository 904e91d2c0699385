# SPDX-License-Identifier: Apache-2.0
"""lutgen uplift: the spectra are those of the Python module, the file is read by another reader, and what is no picture
of colours fails."""

import unittest

import metamer
import numpy as np
import OpenEXR
from PIL import Image

from lutgen import LutgenTest, lutgen

REC_709 = (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)
AP1 = (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767)
BANDS = [f"T.{nm},000000nm" for nm in range(380, 781, 10)]


def write(file, channels, **header):
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, "chromaticities": REC_709, **header}
    OpenEXR.File(header, {name: np.ascontiguousarray(pixels) for name, pixels in channels.items()}).write(str(file))


def read(file):
    with OpenEXR.File(str(file), separate_channels=True) as picture:
        return dict(picture.header()), {name: channel.pixels.copy() for name, channel in picture.channels().items()}


def stacked(channels, names):
    return np.stack([channels[name] for name in names], axis=-1)


class Uplift(LutgenTest):
    def picture(self, rgb, name="a.exr", **header):
        rgb = np.asarray(rgb, np.float32)
        write(self.folder / name, {c: rgb[..., k] for k, c in enumerate("RGB")}, **header)

    def spectra(self, *arguments, name="a.exr"):
        said = self.assertWorks("uplift", name, "-o", "o.exr", "-d", "float", *arguments)
        header, channels = read(self.folder / "o.exr")
        return header, channels, said

    def test_every_method_writes_what_the_module_says(self):
        rgb = np.random.default_rng(1).uniform(0.02, 0.9, size=(19, 37, 3)).astype(np.float32)
        self.picture(rgb)
        nm = np.arange(380, 781, 10)
        for method in ("smits", "mallett", "jakob", "otsu", "meng", "smooth", "natural", "skin"):
            uplift = metamer.Uplift(method)
            wanted = uplift(rgb.astype(np.float64))
            wanted = np.apply_along_axis(lambda own: np.interp(nm, uplift.wavelengths, own), -1, wanted)
            run = lutgen("uplift", "a.exr", "-o", "o.exr", "-d", "float", "--method", method, folder=self.folder)
            self.assertEqual(run.returncode, 0, run.stderr)
            header, channels = read(self.folder / "o.exr")
            self.assertEqual(sorted(channels), sorted(["R", "G", "B", *BANDS]))
            np.testing.assert_allclose(stacked(channels, BANDS), wanted, atol=2e-6, err_msg=method)
            np.testing.assert_array_equal(stacked(channels, "RGB"), rgb)
            self.assertEqual(header["spectralLayoutVersion"], "1.0")
            self.assertEqual(header["metamer:uplift"], method)

    def test_halves_are_the_nearest(self):
        bits = np.random.default_rng(7).integers(0, 2**32, size=(30, 70, 3), dtype=np.uint32)
        # Every exponent of a half, ties, the least ones, and in a few rows what is no finite number.
        bits[:20] = bits[:20] & 0x8FFFFFFF | 0x30000000
        bits[5:8] &= np.uint32(0xFFFFF000)
        numbers = bits.view(np.float32)
        numbers[:20][~np.isfinite(numbers[:20])] = 1
        self.picture(numbers)
        run = lutgen("uplift", "a.exr", "-o", "o.exr", "--method", "mallett", folder=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        with np.errstate(over="ignore", invalid="ignore"):
            wanted = np.where(np.isfinite(numbers), np.clip(numbers, -65504, 65504), numbers).astype(np.float16)
        written = stacked(read(self.folder / "o.exr")[1], "RGB")
        np.testing.assert_array_equal(np.isnan(written), np.isnan(wanted))
        np.testing.assert_array_equal(written.view(np.uint16)[~np.isnan(wanted)], wanted.view(np.uint16)[~np.isnan(wanted)])

    def test_threads_types_and_compressions_change_nothing_else(self):
        self.picture(np.random.default_rng(2).uniform(size=(61, 23, 3)))
        for method in ("natural", "jakob"):
            files = []
            for threads in (1, 2, 5):
                lutgen("uplift", "a.exr", "-o", "o.exr", "--method", method, "--threads", threads, folder=self.folder)
                files.append((self.folder / "o.exr").read_bytes())
            self.assertEqual(len(set(files)), 1, method)
        halves = stacked(read(self.folder / "o.exr")[1], BANDS)
        self.assertEqual(halves.dtype, np.float16)
        floats = stacked(self.spectra("--method", "jakob")[1], BANDS)
        np.testing.assert_array_equal(floats.astype(np.float16), halves)
        for method in ("smooth", "natural", "skin"):
            written = {}
            for kind in ("float", "half"):
                run = lutgen("uplift", "a.exr", "-o", "o.exr", "-d", kind, "--method", method, folder=self.folder)
                self.assertEqual(run.returncode, 0, run.stderr)
                written[kind] = stacked(read(self.folder / "o.exr")[1], BANDS).astype(np.float32)
            floats, halves = written["float"], written["half"]
            # A table, and a rounding to halves: 4.9e-4 above 1.
            self.assertLess(np.quantile(np.abs(halves - floats).max(axis=-1), 0.99), 1.25e-3, method)
            self.assertLess(np.abs(halves - floats).max(), 2e-3, method)
            self.assertFalse(np.array_equal(floats.astype(np.float16), halves.astype(np.float16)), method)
        floats = stacked(self.spectra("--method", "jakob")[1], BANDS)
        for compression in ("none", "zips", "piz", "rle"):
            other = stacked(self.spectra("--method", "jakob", "--compression", compression)[1], BANDS)
            np.testing.assert_array_equal(other, floats)

    def test_spaces_and_codes(self):
        """White of any space is the perfect reflector; the same colours in two spaces have the same spectra."""
        rgb = np.random.default_rng(3).uniform(0.1, 0.8, size=(4, 5, 3))
        self.picture(rgb)
        here = stacked(self.spectra("--method", "smooth")[1], BANDS)
        self.picture(np.ones((2, 2, 3)), "w.exr", chromaticities=AP1)
        header, channels, _ = self.spectra("--method", "smooth", name="w.exr")
        np.testing.assert_allclose(stacked(channels, BANDS), 1, atol=1e-4)
        np.testing.assert_allclose(header["chromaticities"], AP1, atol=1e-6)
        codes = np.round(255 * np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * rgb ** (1 / 2.4) - 0.055))
        Image.fromarray(codes.astype(np.uint8)).save(self.folder / "c.png")
        coded = stacked(self.spectra("--method", "smooth", name="c.png")[1], BANDS)
        np.testing.assert_allclose(coded, here, atol=0.01)  # half a code, where codes are coarsest

    def test_alpha_goes_through_and_premultiplied_colours_are_not_dark_surfaces(self):
        rgb = np.tile(np.float32((0.5, 0.3, 0.2)), (1, 3, 1))
        alpha = np.float32([[1, 0.25, 0]])
        write(self.folder / "a.exr",
              {**{c: rgb[..., k] * np.where(alpha > 0, alpha, 1) for k, c in enumerate("RGB")}, "A": alpha})
        _, channels, _ = self.spectra("--method", "jakob")
        np.testing.assert_array_equal(channels["A"], alpha)
        found = stacked(channels, BANDS)[0]
        np.testing.assert_allclose(found[1], 0.25 * found[0], atol=1e-6)
        np.testing.assert_allclose(found[2], found[0], atol=1e-6)

    def test_windows_wavelengths_and_colours_without_reflectance(self):
        rgb = np.full((20, 6, 3), 0.4, np.float32)
        rgb[3, 2] = np.nan
        rgb[5, 1] = 3
        self.picture(rgb, dataWindow=((4, 7), (9, 26)), displayWindow=((0, 0), (63, 31)))
        run = lutgen("uplift", "a.exr", "-o", "o.exr", "--wavelengths", "450,550,650", "--method", "mallett",
                     folder=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("0.83 % of the pixels have spectra above 1", run.stderr)
        self.assertIn("0.83 % of the pixels are not numbers", run.stderr)
        header, channels = read(self.folder / "o.exr")
        self.assertEqual(sorted(channels), ["B", "G", "R", *(f"T.{nm},000000nm" for nm in (450, 550, 650))])
        np.testing.assert_array_equal(np.asarray(header["dataWindow"]), [[4, 7], [9, 26]])
        np.testing.assert_array_equal(np.asarray(header["displayWindow"]), [[0, 0], [63, 31]])
        bad = np.isnan(channels["T.550,000000nm"])
        self.assertEqual(np.argwhere(bad).tolist(), [[3, 2]])

    def test_what_fails(self):
        self.picture(np.full((2, 2, 3), 0.4))
        self.assertFails("uplift", "a.exr", "-o", "o.png", says=["o.png", "holds no spectra; write .exr"])
        self.assertFails("uplift", "a.exr", "-o", "o.exr", "--method", "jakub",
                         says=["--method", "jakub", "smits, mallett, jakob, jakob table, otsu, meng, smooth, natural, skin"])
        for nm in ("780-380x10", "200-700x10", "red", "400-1200x100"):
            self.assertFails("uplift", "a.exr", "-o", "o.exr", "--wavelengths", nm, says=["--wavelengths", nm, "rising"])
        self.assertFails("uplift", "gone.exr", "-o", "o.exr", says=["gone.exr"])
        self.assertFails("uplift", "a.exr", "-o", "nowhere/o.exr", says=["nowhere"])
        write(self.folder / "grey.exr", {"Y": np.ones((2, 2), np.float32)})
        self.assertFails("uplift", "grey.exr", "-o", "o.exr", says=["grey.exr"])


if __name__ == "__main__":
    unittest.main()
