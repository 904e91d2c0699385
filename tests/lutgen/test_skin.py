# SPDX-License-Identifier: Apache-2.0
"""lutgen skin: maps of an albedo and back, edits of them, charts; what is no skin, no number, no map."""

import json
import unittest

import numpy as np
import OpenEXR
from PIL import Image

from lutgen import LutgenTest, lutgen

MAPS = ["skin.melanin", "skin.blood", "skin.thickness", "skin.melanin_type", "skin.deoxygenation", "skin.gain",
        "skin.residual.R", "skin.residual.G", "skin.residual.B"]
# Linear Rec.709 of the albedo of a light and of a dark skin, in daylight.
LIGHT, DARK = (0.520, 0.300, 0.215), (0.115, 0.062, 0.043)
REC_709 = (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)


def write(file, channels, **header):
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, **header}
    OpenEXR.File(header, {name: np.ascontiguousarray(pixels) for name, pixels in channels.items()}).write(str(file))


def read(file):
    with OpenEXR.File(str(file), separate_channels=True) as picture:
        return dict(picture.header()), {name: channel.pixels.copy() for name, channel in picture.channels().items()}


def colours(channels, names="RGB"):
    return np.stack([channels[name] for name in names], axis=-1)


class Skin(LutgenTest):
    def albedo(self, rgb, name="a.exr", type_=np.float32, **header):
        """A picture of colours, height x width x 3, with alpha and a depth of its own type."""
        rgb = np.asarray(rgb, type_)
        others = {"A": np.linspace(0, 1, rgb[..., 0].size).reshape(rgb.shape[:2]).astype(np.float16),
                  "id": np.arange(rgb[..., 0].size, dtype=np.uint32).reshape(rgb.shape[:2])}
        header.setdefault("chromaticities", REC_709)
        write(self.folder / name, {**{c: rgb[..., k] for k, c in enumerate("RGB")}, **others}, **header)
        return rgb

    made = {}

    def estimate(self, *arguments, albedo="a.exr", maps="m.exr"):
        """Maps; those of one picture are made once for all tests."""
        key = ((self.folder / albedo).read_bytes(), *map(str, arguments))
        if key not in self.made or "--json" in arguments:
            self.assertWorks("skin", "estimate", albedo, "-o", maps, *arguments)
            self.made[key] = (self.folder / maps).read_bytes()
        (self.folder / maps).write_bytes(self.made[key])
        return read(self.folder / maps)

    def mattes(self, numbers, count):
        """A picture of mattes, one a number, for many edits in one call."""
        write(self.folder / "mattes.exr", {f"n{k}": (numbers == k).astype(np.float32) for k in range(count)})

    @staticmethod
    def at(number, *edits):
        return "--matte", f"mattes.exr:n{number}", *edits

    def edit(self, *arguments, maps="m.exr", output="o.exr"):
        self.assertWorks("skin", "edit", maps, "-o", output, *arguments)
        return read(self.folder / output)


class RoundTrip(Skin):
    def faces(self):
        random = np.random.default_rng(3)
        share = random.random((20, 31, 1))
        return (share * LIGHT + (1 - share) * DARK) * random.uniform(0.9, 1.1, (20, 31, 3))

    def test_unedited_comes_back_with_all_that_lay_beside(self):
        rgb = self.albedo(self.faces(), owner="somebody", displayWindow=(np.array([0, 0], np.int32), np.array([40, 30], np.int32)))
        header, maps = self.estimate()
        self.assertEqual(set(maps), {*MAPS, "A", "id"})
        self.assertEqual(header["owner"], "somebody")
        self.assertEqual(header["metamer:skinIlluminant"], "D65")
        after, back = self.edit()
        before, given = read(self.folder / "a.exr")
        np.testing.assert_allclose(colours(back), rgb, rtol=0, atol=1e-6)
        for name in ("A", "id"):
            self.assertEqual((back[name].dtype, back[name].tobytes()), (given[name].dtype, given[name].tobytes()))
        self.assertEqual(set(back), {*"RGBA", "id"})
        self.assertEqual(after["owner"], "somebody")
        self.assertFalse([name for name in after if name.startswith("metamer:skin")])
        for name in ("displayWindow", "dataWindow", "chromaticities", "compression"):
            self.assertEqual(repr(after[name]), repr(before[name]), name)
        # People, not what the ends of the ranges are.
        self.assertTrue(np.all((maps["skin.melanin"] > 0.003) & (maps["skin.melanin"] < 0.35)))
        self.assertTrue(np.all(np.abs(maps["skin.residual.R"]) < 0.05))

    def test_maps_of_a_named_layer_and_of_encoded_pictures(self):
        rgb = np.full((3, 4, 3), LIGHT, np.float32)
        write(self.folder / "l.exr", {f"face.{c}": rgb[..., k] for k, c in enumerate("RGB")}, chromaticities=REC_709)
        self.estimate("--layer", "face", albedo="l.exr")
        _, back = self.edit()
        np.testing.assert_allclose(colours(back, ["face.R", "face.G", "face.B"]), rgb, atol=1e-6)
        codes = np.array([[[190, 148, 128], [90, 66, 55]]], np.uint8)
        Image.fromarray(codes).save(self.folder / "p.png")
        self.estimate(albedo="p.png", maps="p.exr")
        lutgen("skin", "edit", "p.exr", "-o", "q.png", folder=self.folder)
        np.testing.assert_array_equal(np.asarray(Image.open(self.folder / "q.png")), codes)

    def test_halves_and_frames(self):
        for frame in (1, 2):
            rgb = self.albedo(self.faces() * frame, f"a.{frame:04d}.exr", np.float16)
        run = lutgen("skin", "estimate", "a.####.exr", "-o", "m.####.exr", folder=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("2 frames", run.stdout)
        self.assertEqual(lutgen("skin", "edit", "m.####.exr", "-o", "o.####.exr", "-d", "half", folder=self.folder).returncode, 0)
        _, back = read(self.folder / "o.0002.exr")
        self.assertEqual(back["R"].dtype, np.float16)
        np.testing.assert_array_equal(colours(back), rgb)

    def test_threads_change_nothing(self):
        self.albedo(self.faces())
        self.estimate()
        self.estimate("--threads", "1", maps="1.exr")
        self.assertEqual((self.folder / "1.exr").read_bytes(), (self.folder / "m.exr").read_bytes())


class HardColours(Skin):
    def test_what_is_no_skin_comes_back_and_says_so(self):
        """Black, white, blue, green, neon, make-up, negative: the nearest skin, the rest in the residual."""
        given = [(0, 0, 0), (1, 1, 1), (0.05, 0.1, 0.8), (0.05, 0.6, 0.1), (0.9, 1.0, 0.02), (0.75, 0.02, 0.05),
                 (-0.05, 0.2, 0.1), (-0.3, -0.2, -0.1), (65000, 20, 0), LIGHT]
        rgb = self.albedo([given])
        _, maps = self.estimate("--json", "f.json")
        _, back = self.edit()
        size = np.maximum(np.abs(rgb).max(axis=-1, keepdims=True), 1)
        np.testing.assert_allclose(colours(back) / size, rgb / size, rtol=0, atol=1e-6)
        for name, low, high in zip(MAPS, (0, 0, 10, 0, 0), (1, 1, 350, 1, 1)):
            self.assertTrue(np.all((maps[name] >= low) & (maps[name] <= high)), name)
        residual = np.linalg.norm(colours(maps, MAPS[6:]), axis=-1) / np.linalg.norm(rgb, axis=-1).clip(1e-9)
        self.assertTrue(np.all(residual[0, 2:9] > 0.2), residual)
        self.assertLess(residual[0, -1], 0.02)
        found = json.loads((self.folder / "f.json").read_text())
        self.assertEqual((found["pixels"], found["black_or_no_number"]), (10, 2))
        self.assertTrue(found["tells_blood_from_melanin"])
        # An edit of all reaches the skin and leaves black and negative light.
        _, pale = self.edit("--multiply", "blood=2")
        self.assertGreater(np.abs(colours(pale) - rgb)[0, -1].max(), 0.01)
        np.testing.assert_array_equal(colours(pale)[0, [0, 7]], rgb[0, [0, 7]])

    def test_no_numbers_stay_and_do_not_spread(self):
        rgb = np.full((4, 5, 3), LIGHT, np.float32)
        rgb[1, 1], rgb[2, 3, 1] = np.nan, np.inf
        self.albedo(rgb)
        self.estimate()
        _, back = self.edit("--smooth", "blood=2")
        finite = np.isfinite(rgb).all(axis=-1)
        np.testing.assert_array_equal(np.isfinite(colours(back)).all(axis=-1), finite)
        np.testing.assert_allclose(colours(back)[finite], rgb[finite], atol=0.02)

    def test_ten_stops_are_a_gain(self):
        stops = np.array([0, -10, 10, -12, 12])
        rgb = self.albedo(np.float32([[np.multiply(LIGHT, 2.0**stop) for stop in stops]]))
        _, maps = self.estimate()
        _, back = self.edit("--flush", "0.5")
        np.testing.assert_allclose(colours(self.edit()[1]) / rgb, 1, atol=1e-6)
        # A thousand times as dark or bright is the skin at that border, edited alike: two stops more change nothing else.
        change = colours(back)[0] / rgb[0]
        self.assertTrue(np.all((change > 0.5) & (change < 1.5)), change)
        for name in MAPS[:5]:
            np.testing.assert_allclose(maps[name][0, 1:3], maps[name][0, 3:], rtol=1e-4)
        np.testing.assert_allclose(maps["skin.gain"][0, 3:] / maps["skin.gain"][0, 1:3], [0.25, 4], rtol=1e-5)

    def test_parameters_at_every_bound(self):
        """Maps that other programs made, at the ends of the ranges and beyond them."""
        self.albedo(np.full((6, 8, 3), LIGHT, np.float32))
        maps = {name: values.reshape(1, 48)[:, :12] for name, values in self.estimate()[1].items()}
        wide = {"skin.melanin": (0, 1), "skin.blood": (0, 1), "skin.thickness": (10, 350), "skin.melanin_type": (0, 1),
                "skin.deoxygenation": (0, 1), "skin.gain": (0, 1e4)}
        for k, (name, ends) in enumerate(wide.items()):
            maps[name][0, 2 * k:2 * k + 2] = ends
        maps["skin.melanin"][0, 11], maps["skin.thickness"][0, 10] = 7, np.nan
        write(self.folder / "m.exr", maps)
        rows = np.repeat(np.arange(5)[:, None], 12, axis=1)
        write(self.folder / "m.exr", {name: np.repeat(values, 5, axis=0) for name, values in maps.items()})
        self.mattes(rows, 5)
        _, back = self.edit(*self.at(1, "--tan", "4"), *self.at(2, "--vitiligo", "1"), *self.at(3, "--thin", "10"),
                            *self.at(4, "--multiply", "blood=1000"))
        self.assertTrue(np.isfinite(colours(back)).all())

    def test_an_observer_that_cannot_tell_is_reported(self):
        self.albedo([[LIGHT]])
        run = lutgen("skin", "estimate", "a.exr", "-o", "m.exr", "--illuminant", "LPS", "--json", "f.json", folder=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("do not tell blood from melanin", run.stderr)
        self.assertFalse(json.loads((self.folder / "f.json").read_text())["tells_blood_from_melanin"])
        self.assertIn("LPS", run.stdout)
        # The maps know under which light; the way back needs no word.
        np.testing.assert_allclose(colours(self.edit()[1]), [[LIGHT]], atol=1e-6)


class Edits(Skin):
    def setUp(self):
        super().setUp()
        self.rgb = self.albedo(np.full((6, 8, 3), LIGHT, np.float32))
        _, self.maps = self.estimate()

    def edited(self, *arguments):
        return colours(self.edit(*arguments)[1])

    def test_each_edit_does_what_it_says(self):
        edits = ((["--multiply", "blood=1.5"], False, True), (["--multiply", "melanin=2"], False, None),
                 (["--tan", "1"], False, None), (["--flush", "0.7"], None, True), (["--flush", "-0.5"], True, False),
                 (["--vitiligo", "1"], True, None), (["--thin", "3"], True, None), (["--thicken", "2"], False, None),
                 (["--oxygenate", "1"], None, True), (["--oxygenate", "-1"], None, False),
                 (["--set", "blood=0.001"], True, False), (["--thicken", "0.5"], None, None), (["--thin", "2"], None, None))
        numbers = np.arange(48).reshape(6, 8)
        self.mattes(numbers, len(edits))
        new = self.edited(*[word for k, (edit, _, _) in enumerate(edits) for word in self.at(k, *edit)]).reshape(48, 3)
        y, y_before = new @ [0.2126, 0.7152, 0.0722], np.dot(LIGHT, [0.2126, 0.7152, 0.0722])
        red, red_before = new[:, 0] / new[:, 1], LIGHT[0] / LIGHT[1]
        for k, (edit, is_brighter, is_redder) in enumerate(edits):
            if is_brighter is not None:
                self.assertEqual(bool(y[k] > y_before), is_brighter, edit)
            if is_redder is not None:
                self.assertEqual(bool(red[k] > red_before), is_redder, edit)
        np.testing.assert_array_equal(new[11], new[12])
        np.testing.assert_allclose(new[13:], self.rgb.reshape(48, 3)[13:], atol=1e-6)

    def test_order_counts(self):
        numbers = np.arange(48).reshape(6, 8)
        self.mattes(numbers, 4)
        new = self.edited(*self.at(0, "--set", "blood=0.01", "--multiply", "blood=4"),
                          *self.at(1, "--multiply", "blood=4", "--set", "blood=0.01"),
                          *self.at(2, "--set", "blood=0.04"), *self.at(3, "--set", "blood=0.01")).reshape(48, 3)
        np.testing.assert_allclose(new[0:2], new[2:4], atol=1e-6)
        self.assertGreater(np.abs(new[0] - new[1]).max(), 0.01)

    def test_mattes_and_maps(self):
        matte = np.zeros((6, 8), np.float32)
        matte[2, 3] = 1
        write(self.folder / "w.exr", {"A": matte, "R": 1 - matte})
        # Without a channel the red one; then everywhere again.
        new = self.edited("--matte", "w.exr:A", "--flush", "1", "--matte", "w.exr", "--set", "blood=0.05")
        moved = np.abs(new - self.rgb).max(axis=-1) > 1e-6
        self.assertTrue(moved.all())
        self.assertEqual(np.unique(new.reshape(-1, 3), axis=0).shape[0], 2)
        self.assertFalse(np.array_equal(new[2, 3], new[0, 0]))
        both = self.edited("--matte", "w.exr:A", "--flush", "1", "--matte", "none", "--thicken", "1.2")
        self.assertTrue(np.all(np.abs(both - self.rgb).max(axis=-1) > 1e-5))
        # A picture of factors, and a map to set: its own, for which nothing moves.
        factors = np.ones((6, 8), np.float32)
        factors[:, 4:] = 2
        write(self.folder / "f.exr", {"Y": factors})
        by_map = self.edited("--multiply", "blood=f.exr", "--set", "melanin=m.exr:skin.melanin")
        np.testing.assert_allclose(by_map[:, :4], self.rgb[:, :4], atol=1e-6)
        np.testing.assert_allclose(by_map[:, 4:], self.edited("--multiply", "blood=2")[:, 4:], atol=1e-6)

    def test_refusals_are_one_line(self):
        def refused(*arguments, says=(), code=1):
            self.assertFails("skin", "edit", "m.exr", "-o", "o.exr", *arguments, says=says, code=code)

        write(self.folder / "small.exr", {"Y": np.ones((3, 8), np.float32)})
        write(self.folder / "bad.exr", {"Y": np.full((6, 8), -1, np.float32)})
        refused("--matte", "small.exr", "--tan", "1", says=["small.exr", "8 x 3", "8 x 6"])
        refused("--matte", "none.exr", "--tan", "1", says=["none.exr", "is not there"])
        refused("--matte", "m.exr:skin.lips", "--tan", "1", says=["m.exr", "FILE:CHANNEL"])
        refused("--tan", "1", "--matte", "small.exr", says=["--matte", "small.exr", "before the edits"])
        refused("--multiply", "blood=bad.exr", says=["bad.exr", "factor", "-1"])
        refused("--multiply", "lips=2", says=["lips", "melanin_type"])
        refused("--multiply", "blood", says=["--multiply", "blood=1.5"])
        refused("--set", "thickness=5", says=["--set thickness=5", "10"])
        refused("--smooth", "blood=m.exr", says=["--smooth", "pixels"])
        refused("--tan", "nan", says=["--tan"])
        refused("--thin", "0", says=["--thin 0"])
        self.assertFails("skin", "edit", "a.exr", "-o", "o.exr", says=["a.exr", "skin estimate"])
        self.assertFails("skin", "edit", "m.exr", "-o", "o.xyz", says=["o.xyz", ".exr"])
        self.assertFails("skin", "edit", "m.exr", "-o", "none/o.exr", "--tan", "1", says=["none/o.exr"])
        del self.maps["skin.blood"], self.maps["skin.residual.G"]
        write(self.folder / "part.exr", self.maps)
        self.assertFails("skin", "edit", "part.exr", "-o", "o.exr", says=["part.exr", "skin.blood, skin.residual.G", "missing"])


class Doors(Skin):
    def test_refused_before_the_work(self):
        self.albedo([[LIGHT, DARK]])
        self.estimate()
        self.assertFails("skin", "estimate", "a.exr", "-o", "none/m.exr", says=["none/m.exr"])
        self.assertFails("skin", "estimate", "a.exr", "-o", "n.png", says=["n.png", ".exr"])
        self.assertFails("skin", "estimate", "a.exr", "-o", "n.exr", "--json", "none/f.json", says=["none/f.json"])
        self.assertFails("skin", "estimate", "none.exr", "-o", "n.exr", says=["none.exr"])
        self.assertFails("skin", "estimate", "m.exr", "-o", "n.exr", says=["m.exr", "there already"])
        self.assertFails("skin", "estimate", "a.exr", "-o", "n.exr", "--illuminant", "D66", says=["D66"])
        self.assertFails("skin", "estimate", "a.exr", "-o", "n.exr", "--compression", "dwaa", says=["dwaa", "loses bits"])
        self.assertFails("skin", "estimate", "a.exr", says=["--output"], code=2)
        write(self.folder / "grey.exr", {"Y": np.ones((2, 2), np.float32)})
        self.assertFails("skin", "estimate", "grey.exr", "-o", "n.exr", says=["grey.exr", "red, green and blue"])

    def test_quiet_and_summary(self):
        self.albedo([[LIGHT, DARK]])
        self.assertRegex(self.assertWorks("skin", "estimate", "a.exr", "-o", "m.exr"),
                         r"^m.exr: 1 picture, 100 % of the pixels skin, D65, CIE 1931 2, Rec.709, [0-9.]+ s\n$")
        self.assertRegex(self.assertWorks("skin", "edit", "m.exr", "-o", "o.exr", "--tan", "1"),
                         r"^o.exr: 1 picture, 1 edit, 100 % of the pixels changed, Rec.709, [0-9.]+ s\n$")
        self.assertEqual(self.assertWorks("skin", "edit", "m.exr", "-o", "o.exr", "--quiet"), "")

    def test_lossy_pictures_get_maps_that_are_not(self):
        self.albedo(np.full((40, 40, 3), LIGHT, np.float16), type_=np.float16, compression=OpenEXR.DWAA_COMPRESSION)
        run = lutgen("skin", "estimate", "a.exr", "-o", "m.exr", folder=self.folder)
        self.assertIn("written with zip", run.stderr)
        header, _ = read(self.folder / "m.exr")
        self.assertEqual(header["compression"], OpenEXR.ZIP_COMPRESSION)

    def test_networks_find_much_the_same(self):
        """Within a deviation of people's; blood is hard to tell in dark skin."""
        rgb = self.albedo([[LIGHT, DARK]])
        _, by_map = self.estimate()
        for method in ("network", "network-rgb"):
            _, maps = self.estimate("--method", method)
            np.testing.assert_allclose(np.cbrt(maps["skin.melanin"][0, :2]), np.cbrt(by_map["skin.melanin"][0, :2]), atol=0.05)
            np.testing.assert_allclose(maps["skin.blood"][0, 0] ** 0.25, by_map["skin.blood"][0, 0] ** 0.25, atol=0.04)
            np.testing.assert_allclose(colours(self.edit()[1]), rgb, atol=1e-6)
        self.assertFails("skin", "estimate", "a.exr", "-o", "n.exr", "--method", "network", "--illuminant", "A",
                         says=["--method", "trained for"])

    def test_capture_options_and_cameras(self):
        rgb = self.albedo([[LIGHT, DARK]])
        _, day = self.estimate()
        _, tungsten = self.estimate("--illuminant", "A", "--observer", "Nikon D5100")
        self.assertFalse(np.allclose(day["skin.blood"], tungsten["skin.blood"], rtol=1e-3))
        np.testing.assert_allclose(colours(self.edit()[1]), rgb, atol=1e-6)


class Sample(Skin):
    def test_spectra_colours_and_pictures_agree(self):
        self.assertWorks("skin", "sample", "-o", "s.csv", "--colours", "c.csv", "--chart", "c.exr", "--spectral", "s.exr",
                         "--count", "5", "--seed", "4", "--patch", "2")
        spectra = np.loadtxt(self.folder / "s.csv", delimiter=",", skiprows=1)
        self.assertEqual(spectra.shape, (41, 6))
        rows = [line.split(",") for line in (self.folder / "c.csv").read_text().splitlines()]
        self.assertEqual(rows[0][:4], ["patch", "R", "G", "B"])
        rgb = np.array([[float(value) for value in row[1:4]] for row in rows[1:]])
        header, chart = read(self.folder / "s.exr")
        self.assertEqual(header["spectralLayoutVersion"], "1.0")
        for index in range(5):
            at = (index // 3 * 2, index % 3 * 2)
            np.testing.assert_allclose(colours(chart)[at], rgb[index], rtol=1e-6)
            self.assertAlmostEqual(chart["T.550,000000nm"][at], spectra[17, index + 1], 6)
        # A set of reflectances like any other: the estimate of a chart finds what is in it.
        self.estimate(albedo="c.exr")
        maps = read(self.folder / "m.exr")[1]
        self.assertAlmostEqual(float(np.cbrt(maps["skin.melanin"][0, 0])), float(rows[1][7]) ** (1 / 3), delta=0.03)
        self.assertWorks("skin", "sample", "-o", "again.csv", "--count", "5", "--seed", "4")
        self.assertEqual((self.folder / "again.csv").read_bytes(), (self.folder / "s.csv").read_bytes())

    def test_grid_and_refusals(self):
        self.assertWorks("skin", "sample", "--grid", "4", "3", "--colours", "c.csv", "--chart", "c.png")
        rows = [line.split(",") for line in (self.folder / "c.csv").read_text().splitlines()][1:]
        melanin = np.array([float(row[7]) for row in rows]).reshape(3, 4)
        lightness = np.array([float(row[4]) for row in rows]).reshape(3, 4)
        self.assertTrue(np.all(np.diff(melanin, axis=1) > 0))
        self.assertTrue(np.all(np.diff(lightness, axis=1) < 0))
        self.assertTrue(np.all(np.diff(lightness, axis=0) < 0))
        with Image.open(self.folder / "c.png") as chart:
            self.assertEqual(chart.size, (128, 96))
        self.assertFails("skin", "sample", code=2, says=["-o"])
        self.assertFails("skin", "sample", "--spectral", "s.png", says=["s.png", ".exr"])
        self.assertFails("skin", "sample", "-o", "none/s.csv", says=["none/s.csv"])
        self.assertFails("skin", "sample", "-o", "s.csv", "--grid", "4", "3", "--count", "3", code=2, says=["--count"])


if __name__ == "__main__":
    unittest.main()
