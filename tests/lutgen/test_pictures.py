# SPDX-License-Identifier: Apache-2.0
"""lutgen apply: pictures through recipes and LUT files."""

import unittest

import numpy as np
import OpenEXR

from lutgen import LutgenTest

RECIPE = "metamer: 1\ninput: {illuminant: D65}\noutput: {illuminant: HP1}\n"


def write(file, channels, **header):
    OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, **header}, channels).write(
        str(file)
    )


def read(file):
    with OpenEXR.File(str(file), separate_channels=True) as picture:
        return {name: channel.pixels.copy() for name, channel in picture.channels().items()}, dict(picture.header())


def ramp(height=24, width=37):
    random = np.random.default_rng(5)
    return random.random((height, width, 3)).astype(np.float32) ** 3


class Apply(LutgenTest):
    def setUp(self):
        super().setUp()
        (self.folder / "r.yaml").write_text(RECIPE)

    def picture(self, name, pixels, **extra):
        write(self.folder / name, {"R": pixels[..., 0].copy(), "G": pixels[..., 1].copy(), "B": pixels[..., 2].copy(), **extra})

    def applied(self, *arguments):
        self.assertWorks("apply", "--quiet", *arguments, "out.exr")
        channels, header = read(self.folder / "out.exr")
        return np.stack([channels[c] for c in "RGB"], axis=-1), channels, header

    def test_result_does_not_depend_on_threads(self):
        self.picture("in.exr", ramp())
        one, _, _ = self.applied("r.yaml", "in.exr", "--threads", "1")
        four, _, _ = self.applied("r.yaml", "in.exr", "--threads", "4")
        np.testing.assert_array_equal(one, four)
        self.assertGreater(np.abs(one - ramp()).max(), 0.05)

    def test_exposure_is_kept(self):
        self.picture("a.exr", ramp())
        self.picture("b.exr", 16 * ramp())
        a, _, _ = self.applied("r.yaml", "a.exr")
        b, _, _ = self.applied("r.yaml", "b.exr")
        np.testing.assert_array_equal(16 * a, b)

    def test_file_and_map_follow_the_exact_engine(self):
        pixels = ramp() * 0.8 + 0.1  # away from the borders of the gamut
        self.picture("in.exr", pixels)
        exact, _, _ = self.applied("r.yaml", "in.exr")
        mapped, _, _ = self.applied("r.yaml", "in.exr", "--engine", "map")
        # The map's tolerance, a tenth of a CIEDE2000 where kinks meet, is a few thousandths of light.
        np.testing.assert_allclose(mapped, exact, atol=5e-3)
        self.assertWorks("bake", "r.yaml", "-o", "r.ctf")
        chain, _, _ = self.applied("r.ctf", "in.exr")
        # Half a CIEDE2000 (the chain's p99) is about a hundredth of light.
        np.testing.assert_allclose(chain, exact, atol=1e-2)

    def test_identity_copies(self):
        (self.folder / "same.yaml").write_text(RECIPE.replace("HP1", "D65"))
        pixels = ramp()
        self.picture("in.exr", pixels)
        found, _, _ = self.applied("same.yaml", "in.exr")
        np.testing.assert_array_equal(found, pixels)

    def test_alpha_other_channels_and_metadata_are_kept(self):
        pixels = ramp()
        depth = np.arange(pixels[..., 0].size, dtype=np.float32).reshape(pixels.shape[:2])
        write(
            self.folder / "in.exr",
            {"R": pixels[..., 0].copy(), "G": pixels[..., 1].copy(), "B": pixels[..., 2].copy(), "A": depth / depth.max(), "Z": depth},
            owner="somebody",
        )
        _, channels, header = self.applied("r.yaml", "in.exr")
        np.testing.assert_array_equal(channels["Z"], depth)
        np.testing.assert_array_equal(channels["A"], depth / depth.max())
        self.assertEqual(header.get("owner"), "somebody")
        self.assertEqual(channels["R"].dtype, np.float32)

    def test_not_a_number_stays_in_its_pixel(self):
        pixels = ramp()
        pixels[3, 4] = [np.nan, 0.2, 0.3]
        pixels[5, 6] = [np.inf, 0.2, 0.3]
        self.picture("in.exr", pixels)
        found, _, _ = self.applied("r.yaml", "in.exr")
        self.assertTrue(np.isnan(found[3, 4, 0]) and found[3, 4, 1] == np.float32(0.2))
        self.assertTrue(np.isinf(found[5, 6, 0]))
        self.assertEqual(np.count_nonzero(~np.isfinite(found)), 2)

    def test_one_pixel_and_a_moved_data_window(self):
        self.picture("one.exr", ramp(1, 1))
        found, _, _ = self.applied("r.yaml", "one.exr")
        self.assertEqual(found.shape, (1, 1, 3))
        window = (np.array([10, -3], np.int32), np.array([46, 20], np.int32))
        pixels = ramp()
        write(
            self.folder / "moved.exr",
            {"R": pixels[..., 0].copy(), "G": pixels[..., 1].copy(), "B": pixels[..., 2].copy()},
            dataWindow=window,
            displayWindow=(np.array([0, 0], np.int32), np.array([99, 49], np.int32)),
        )
        self.picture("in.exr", pixels)
        here, _, _ = self.applied("r.yaml", "in.exr")
        found, _, header = self.applied("r.yaml", "moved.exr")
        np.testing.assert_array_equal(found, here)
        np.testing.assert_array_equal(header["dataWindow"][0], window[0])
        np.testing.assert_array_equal(header["displayWindow"][1], [99, 49])

    def test_bad_pictures_are_named(self):
        write(self.folder / "grey.exr", {"Y": ramp()[..., 0].copy()})
        (self.folder / "noise.exr").write_bytes(b"\x76\x2f\x31\x01 not a picture")
        (self.folder / "empty.exr").write_bytes(b"")
        self.picture("in.exr", ramp())
        for picture, says in [
            ("grey.exr", ["grey.exr", "channels '1'", "RGB"]),
            ("noise.exr", ["noise.exr", "cannot be read"]),
            ("empty.exr", ["empty.exr", "cannot be read"]),
            ("missing.exr", ["missing.exr"]),
        ]:
            with self.subTest(picture):
                self.assertFails("apply", "r.yaml", picture, "out.exr", says=says)
        self.assertFails("apply", "missing.yaml", "in.exr", "out.exr", says=["missing.yaml"])
        self.assertFails("apply", "missing.cube", "in.exr", "out.exr", says=["missing.cube"])
        self.assertFails("apply", "r.yaml", "in.exr", "no/such/out.exr", says=["no/such/out.exr"])
        self.assertFails("apply", "r.yaml", "in.exr", "out.nothing", says=["out.nothing"])


if __name__ == "__main__":
    unittest.main()
