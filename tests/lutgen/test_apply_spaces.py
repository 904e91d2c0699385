# SPDX-License-Identifier: Apache-2.0
"""lutgen apply knows what a picture's pixels are: sRGB, a camera's log, chromaticities, stated spaces."""

import struct
import unittest
import zlib

import numpy as np
import OpenEXR
import PyOpenColorIO as ocio
import tifffile
from PIL import Image, ImageCms

from lutgen import LINKED, LutgenTest, lutgen

RECIPE = "metamer: 1\nscene: {kind: smooth}\nspace: %s\ninput: {illuminant: D65}\noutput: {illuminant: A}\n"
REC709 = (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329)


def decoded(signal):
    return np.where(signal <= 0.04045, signal / 12.92, ((signal + 0.055) / 1.055) ** 2.4)


def encoded(light):
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 0) ** (1 / 2.4) - 0.055)


def codes(most, type_, seed=1, height=9, width=14):
    """From the middle of the gamut: what is transformed is not clipped."""
    return np.random.default_rng(seed).integers(most // 5, most // 3, (height, width, 3)).astype(type_)


class Spaces(LutgenTest):
    def setUp(self):
        super().setUp()
        (self.folder / "r.yaml").write_text(RECIPE % "Rec.709")
        (self.folder / "cg.yaml").write_text(RECIPE % "ACEScg")
        (self.folder / "same.yaml").write_text((RECIPE % "Rec.709").replace("A}", "D65}"))

    def exr(self, name, pixels, **header):
        OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, **header},
                     {"RGB": pixels.astype(np.float32)}).write(str(self.folder / name))

    def pixels(self, name):
        with OpenEXR.File(str(self.folder / name)) as file:
            return file.channels()["RGB"].pixels.copy()

    def relit(self, pixels, recipe="r.yaml"):
        """Linear pixels of the recipe's space through it."""
        self.exr("linear.exr", pixels)
        self.assertWorks("apply", "--quiet", recipe, "linear.exr", "linear_out.exr")
        return self.pixels("linear_out.exr")

    def test_png_is_decoded_and_encoded(self):
        for bits, type_ in ((8, np.uint8), (16, np.uint16)):
            most = 2**bits - 1
            before = codes(most, type_)
            if bits == 8:
                Image.fromarray(before).save(self.folder / "in.png")
            else:
                self.write_png16("in.png", before)
            self.assertWorks("apply", "r.yaml", "in.png", "out.png")
            expected = encoded(self.relit(decoded(before / most)))
            found = self.read_png("out.png")
            self.assertEqual(found.dtype, type_)
            # Half a code, and a rounding of float.
            self.assertLessEqual(np.abs(found - expected * most).max(), 0.51 + most * 1e-6)

    def write_png16(self, name, pixels):
        height, width = pixels.shape[:2]
        rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in pixels)
        chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        (self.folder / name).write_bytes(
            b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 16, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))

    def read_png(self, name):
        """PNG of any depth without a library that makes 8 bits of 16."""
        self.assertWorks("apply", "--quiet", "same.yaml", name, "read.tif", "--compression", "none", "--output-space", "sRGB")
        return tifffile.imread(self.folder / "read.tif")

    def test_alpha_of_a_png_is_straight_and_kept(self):
        colours = codes(255, np.uint8)
        alpha = np.random.default_rng(3).integers(0, 256, colours.shape[:2]).astype(np.uint8)
        Image.fromarray(colours).save(self.folder / "opaque.png")
        Image.fromarray(np.dstack([colours, alpha])).save(self.folder / "in.png")
        for name in ("opaque", "in"):
            self.assertWorks("apply", "r.yaml", f"{name}.png", f"{name}_out.png")
        found = np.array(Image.open(self.folder / "in_out.png"))
        np.testing.assert_array_equal(found[..., 3], alpha)
        np.testing.assert_array_equal(found[..., :3], np.array(Image.open(self.folder / "opaque_out.png")))

    def test_nothing_moves_where_nothing_is_to_move(self):
        before = np.random.default_rng(1).integers(0, 256, (9, 14, 3)).astype(np.uint8)
        Image.fromarray(before).save(self.folder / "in.png")
        self.assertWorks("apply", "same.yaml", "in.png", "out.png")
        np.testing.assert_array_equal(np.array(Image.open(self.folder / "out.png")), before)
        # Through a space and back, as another space is the recipe's.
        out = "sRGB - Texture" if LINKED >= (2, 5) else "sRGB"
        (self.folder / "cg_same.yaml").write_text((RECIPE % "ACEScg").replace("A}", "D65}"))
        self.assertWorks("apply", "cg_same.yaml", "in.png", "out.png", "--output-space", out)
        self.assertLessEqual(np.abs(np.array(Image.open(self.folder / "out.png")).astype(int) - before).max(), 0)

    def test_jpeg(self):
        flat = np.full((16, 16, 3), (90, 120, 70), np.uint8)
        Image.fromarray(flat).save(self.folder / "in.jpg", quality=98)
        self.assertWorks("apply", "r.yaml", "in.jpg", "out.jpg")
        found = np.array(Image.open(self.folder / "out.jpg"))[8, 8]
        expected = 255 * encoded(self.relit(decoded(flat[:1, :1] / 255.0)))[0, 0]
        self.assertLess(np.abs(found - expected).max(), 2.5)  # two losses of JPEG

    def test_tiff_of_16_bits_says_nothing(self):
        before = codes(65535, np.uint16)
        tifffile.imwrite(self.folder / "in.tif", before, photometric="rgb", compression="zlib")
        run = lutgen("apply", "r.yaml", "in.tif", "out.tif", folder=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stderr, r"^lutgen: note: in.tif: .*sRGB; --picture-space.*\n$")
        found = tifffile.imread(self.folder / "out.tif")
        self.assertEqual(found.dtype, np.uint16)
        expected = 65535 * encoded(self.relit(decoded(before / 65535.0)))
        self.assertLess(np.abs(found - expected).max(), 0.6)
        with tifffile.TiffFile(self.folder / "out.tif") as file:
            self.assertIn(file.pages[0].compression.name, ("ADOBE_DEFLATE", "DEFLATE"))
        # Stated, and said no more.
        self.assertWorks("apply", "r.yaml", "in.tif", "gamma.tif", "--picture-space", "Gamma 2.4")
        light = (before / 65535.0) ** 2.4
        expected = 65535 * np.maximum(self.relit(light), 0) ** (1 / 2.4)
        self.assertLess(np.abs(tifffile.imread(self.folder / "gamma.tif") - expected).max(), 0.6)

    def test_dpx_of_10_bits(self):
        before = codes(1023, np.uint16)
        wide = (before << 6) | (before >> 4)
        tifffile.imwrite(self.folder / "in.tif", wide, photometric="rgb")
        space = ("--picture-space", "ARRI LogC3")
        self.assertWorks("apply", "same.yaml", "in.tif", "in.dpx", "-d", "uint10", *space)
        self.assertWorks("apply", "same.yaml", "in.dpx", "back.tif", *space)
        np.testing.assert_array_equal(tifffile.imread(self.folder / "back.tif"), wide)
        self.assertWorks("apply", "cg.yaml", "in.dpx", "out.dpx", *space)
        self.assertWorks("apply", "same.yaml", "out.dpx", "out.tif", *space)
        self.assertWorks("apply", "cg.yaml", "in.tif", "expected.tif", *space)
        found = tifffile.imread(self.folder / "out.tif") >> 6
        expected = tifffile.imread(self.folder / "expected.tif") / 65535 * 1023
        self.assertLess(np.abs(found - expected).max(), 0.52)  # rounded, not cut

    def test_profiles_inks_and_film(self):
        """An embedded ICC profile, CMYK, and a DPX of printing densities."""
        shown = codes(255, np.uint8)
        image = Image.fromarray(shown)
        profile = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
        other = profile.replace("sRGB built-in".encode("utf-16-be"), "Wide gamut RGB"[:13].encode("utf-16-be"))
        self.assertNotEqual(other, profile)
        image.save(self.folder / "plain.png")
        self.assertWorks("apply", "r.yaml", "plain.png", "plain_out.png")
        wanted = np.asarray(Image.open(self.folder / "plain_out.png"))
        for extension in ("png", "tif"):
            with self.subTest(extension):
                image.save(self.folder / f"s.{extension}", icc_profile=profile)
                self.assertWorks("apply", "r.yaml", f"s.{extension}", f"out.{extension}")
                out = Image.open(self.folder / f"out.{extension}")
                np.testing.assert_array_equal(np.asarray(out), wanted)
                image.save(self.folder / f"w.{extension}", icc_profile=other)
                run = lutgen("apply", "r.yaml", f"w.{extension}", f"out.{extension}", folder=self.folder)
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertIn("ICC profile 'Wide gamut RG' is not followed", run.stderr)
        for name in ("c.tif", "c.jpg"):
            image.convert("CMYK").save(self.folder / name)
            self.assertFails("apply", "r.yaml", name, "o.png", says=[name, "'CMYK'", "convert the picture to RGB"])
        for transfer, says in ((3, "'KodakLog'"), (1, "'Printing density'")):
            head = bytearray(b"\xff" * 2048)
            head[0:8] = b"SDPX" + struct.pack(">I", 2048)
            head[8:20] = b"V1.0\0\0\0\0" + struct.pack(">I", 2048 + 4 * 48)
            head[36:136] = bytes(100)
            head[768:784] = struct.pack(">HHIII", 0, 1, 8, 6, 0)
            head[800:820] = bytes([50, transfer, transfer, 10]) + struct.pack(">HHIII", 1, 0, 2048, 0, 0)
            (self.folder / "log.dpx").write_bytes(bytes(head) + bytes(4 * 48))
            self.assertFails("apply", "r.yaml", "log.dpx", "o.dpx", says=["log.dpx", says, "film densities", "--picture-space"])

    def test_chromaticities_of_an_exr(self):
        pixels = codes(1000, np.float64) / 500.0
        pixels[0, 0] = [-0.01, 0.2, 3.0]
        self.exr("in.exr", pixels, chromaticities=REC709)
        self.assertWorks("apply", "cg.yaml", "in.exr", "out.exr")
        config = ocio.Config.CreateFromBuiltinConfig("cg-config-v1.0.0_aces-v1.3_ocio-v2.1")

        def moved(rgb, source, destination):
            rgb = rgb.astype(np.float32).copy()
            config.getProcessor(source, destination).getDefaultCPUProcessor().applyRGB(rgb)
            return rgb

        names = ("Linear Rec.709 (sRGB)", "ACEScg")
        expected = moved(self.relit(moved(pixels, *names), "cg.yaml"), *reversed(names))
        np.testing.assert_allclose(self.pixels("out.exr"), expected, rtol=2e-4, atol=2e-5)
        # Those of the recipe's own space change nothing at all.
        self.exr("own.exr", pixels, chromaticities=(0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767))
        self.assertWorks("apply", "cg.yaml", "own.exr", "out.exr")
        np.testing.assert_array_equal(self.pixels("out.exr"), self.relit(pixels, "cg.yaml"))

    def test_a_picture_that_says_nothing(self):
        self.exr("in.exr", codes(1000, np.float64) / 1000)
        run = lutgen("apply", "cg.yaml", "in.exr", "out.exr", folder=self.folder)
        self.assertRegex(run.stderr, r"^lutgen: note: in.exr: .*ACEScg; --picture-space.*\n$")
        self.assertWorks("apply", "cg.yaml", "in.exr", "stated.exr", "--picture-space", "ACEScg")
        np.testing.assert_array_equal(self.pixels("out.exr"), self.pixels("stated.exr"))

    @unittest.skipIf(LINKED < (2, 5), "the linked OpenColorIO has no config of its own")
    def test_names_of_spaces(self):
        pixels = codes(1000, np.float64) / 1000
        self.exr("in.exr", pixels)
        for name, same in (("sRGB", "sRGB - Texture"), ("ACEScct", "acescct"), ("Rec.709", "Linear Rec.709 (sRGB)"),
                           ("Rec.1886", "Gamma 2.4")):
            with self.subTest(name):
                for k, space in enumerate((name, same)):
                    self.assertWorks("apply", "r.yaml", "in.exr", f"{k}.exr", "--picture-space", space)
                np.testing.assert_allclose(self.pixels("0.exr"), self.pixels("1.exr"), rtol=1e-4, atol=1e-5)
        self.assertFails("apply", "r.yaml", "in.exr", "out.exr", "--picture-space", "sRBG", says=["--picture-space", "sRBG"])

    def test_from_one_kind_of_file_to_another(self):
        pixels = codes(1000, np.float64) / 1000
        self.exr("in.exr", pixels, chromaticities=REC709)
        self.assertFails("apply", "r.yaml", "in.exr", "out.png", says=["out.png", "png", "-d uint"])
        run = lutgen("apply", "r.yaml", "in.exr", "out.png", "-d", "uint8", folder=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("written as sRGB", run.stderr)
        found = np.array(Image.open(self.folder / "out.png"))
        self.assertLess(np.abs(found - 255 * encoded(self.relit(pixels))).max(), 0.51)
        self.assertWorks("apply", "same.yaml", "out.png", "back.exr", "-d", "float")
        np.testing.assert_allclose(self.pixels("back.exr"), decoded(found / 255.0), rtol=1e-5, atol=1e-6)
        with OpenEXR.File(str(self.folder / "back.exr")) as file:
            np.testing.assert_allclose(file.header()["chromaticities"], REC709, atol=1e-6)
        self.assertFails("apply", "same.yaml", "out.png", "no.exr", says=["no.exr", "uint8", "-d"])

    def test_luts(self):
        """With a certificate a LUT knows its pixels; without one it is applied to the values as they are."""
        self.assertWorks("bake", "r.yaml", "-o", "look.cube", "--size", "17")
        before = codes(255, np.uint8)
        Image.fromarray(before).save(self.folder / "in.png")
        self.assertWorks("apply", "look.cube", "in.png", "out.png")
        expected = 255 * encoded(self.relit(decoded(before / 255.0)))
        found = np.array(Image.open(self.folder / "out.png"))
        self.assertLess(np.abs(found - expected).max(), 3)  # a cube of 17 nodes
        (self.folder / "look.cube.json").unlink()
        (self.folder / "half.cube").write_text("LUT_3D_SIZE 2\n" + "".join(
            f"{(i & 1) / 2} {(i >> 1 & 1) / 2} {(i >> 2 & 1) / 2}\n" for i in range(8)))
        run = lutgen("apply", "half.cube", "in.png", "half.png", folder=self.folder)
        self.assertIn("as they are", run.stderr)
        np.testing.assert_allclose(np.array(Image.open(self.folder / "half.png")), before / 2, atol=0.51)
        self.assertFails("apply", "half.cube", "in.png", "x.png", "--picture-space", "sRGB", says=["half.cube", "--space"])
        self.assertWorks("apply", "--quiet", "look.cube", "in.png", "said.png", "--space", "Rec.709")
        np.testing.assert_array_equal(np.array(Image.open(self.folder / "said.png")), found)


if __name__ == "__main__":
    unittest.main()
