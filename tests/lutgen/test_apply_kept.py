# SPDX-License-Identifier: Apache-2.0
"""lutgen apply keeps all of a file that is not its colours: types, parts, tiles, windows, attributes, other channels."""

import resource
import shutil
import signal
import subprocess
import unittest
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image

import exr_bytes
from lutgen import LUTGEN, LutgenTest, lutgen

CASES = Path(__file__).parent / "pictures"
RECIPE = "metamer: 1\nscene: {kind: smooth}\ninput: {illuminant: D65}\noutput: {illuminant: A}\n"
COMPRESSIONS = {name: getattr(OpenEXR, f"{name.upper()}_COMPRESSION") for name in
                ("no", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab")}
LOSSLESS = ("no", "rle", "zips", "zip", "piz")


def random_channel(height, width, type_, seed):
    random = np.random.default_rng(seed)
    if type_ == np.uint32:
        return random.integers(0, 2**32, (height, width), dtype=np.uint32)
    return (random.random((height, width)) ** 3).astype(type_)


def channels_of(names, height=24, width=37):
    """{name: type} as random pixels."""
    return {name: random_channel(height, width, type_, k) for k, (name, type_) in enumerate(names.items())}


def part(channels, name=None, **header):
    # A copy: the module puts objects of its own into the dictionary.
    channels = {name_: pixels.copy() for name_, pixels in channels.items()}
    own = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, **header}
    return OpenEXR.Part({**own, "name": name} if name else own, channels)


def parts_of(file):
    with OpenEXR.File(str(file), separate_channels=True) as picture:
        return [(dict(p.header), {name: channel.pixels.copy() for name, channel in p.channels.items()})
                for p in picture.parts]


HALVES = {"R": np.float16, "G": np.float16, "B": np.float16, "A": np.float16}


class Kept(LutgenTest):
    def setUp(self):
        super().setUp()
        (self.folder / "r.yaml").write_text(RECIPE)
        (self.folder / "same.yaml").write_text(RECIPE.replace("A}", "D65}"))

    def apply(self, *arguments, recipe="r.yaml", output="out.exr"):
        self.assertWorks("apply", "--quiet", recipe, *arguments, output)
        return parts_of(self.folder / output)

    def write(self, name, *parts):
        picture = OpenEXR.File(list(parts)) if len(parts) > 1 else OpenEXR.File(parts[0].header, parts[0].channels)
        picture.write(str(self.folder / name))
        return parts_of(self.folder / name)

    def assertKept(self, before, after, changed, part_index=0, same_types=True):
        """All headers are equal, and all channels bit for bit but those that are named, which moved."""
        self.assertEqual(len(before), len(after))
        for index, ((header, channels), (new_header, new_channels)) in enumerate(zip(before, after)):
            for key in header:
                if key != "channels" and same_types:
                    self.assertEqual(repr(new_header[key]), repr(header[key]), key)
            self.assertEqual(list(new_channels), list(channels))
            for name, pixels in channels.items():
                new = new_channels[name]
                if index == part_index and name in changed:
                    self.assertFalse(np.array_equal(new, pixels), name)
                    self.assertTrue(np.isfinite(new).all())
                else:
                    self.assertEqual((new.dtype, new.tobytes()), (pixels.dtype, pixels.tobytes()), name)
                if same_types:
                    self.assertEqual(new.dtype, pixels.dtype)

    def test_pictures_that_were_spoilt(self):
        """ids became light; AO was relit and Combined was not; several parts were refused."""
        for name, changed in (("uint.exr", "RGB"), ("multi.exr", "RGB"),
                              ("blender2.exr", ["ViewLayer.Combined." + c for c in "RGB"])):
            with self.subTest(name):
                shutil.copy(CASES / name, self.folder)
                before = parts_of(self.folder / name)
                after = self.apply(name)
                self.assertKept(before, after, changed)
                # The colours are those of the same pixels alone.
                plain = {c: before[0][1][n] for c, n in zip("RGB", sorted(changed, key=lambda n: "RGB".index(n[-1])))}
                self.write("plain.exr", part(plain))
                alone = self.apply("plain.exr", output="alone.exr")[0][1]
                for c, n in zip("RGB", sorted(changed, key=lambda n: "RGB".index(n[-1]))):
                    np.testing.assert_array_equal(after[0][1][n], alone[c])

    def test_every_compression_type_and_tiling(self):
        channels = channels_of({**HALVES, "N.X": np.float32, "Z": np.float32, "id": np.uint32}, 70, 45)
        tiles = OpenEXR.TileDescription()
        tiles.xSize, tiles.ySize = 16, 24
        for compression in LOSSLESS[1:]:
            for tiled in ({}, {"type": OpenEXR.tiledimage, "tiles": tiles}):
                with self.subTest(compression=compression, tiled=bool(tiled)):
                    before = self.write("in.exr", part(channels, compression=COMPRESSIONS[compression], owner="somebody",
                                                       **tiled))
                    self.assertKept(before, self.apply("in.exr"), "RGB")

    def test_lossy_compressions_stay_near(self):
        smooth = np.linspace(0.1, 0.8, 70 * 45).reshape(70, 45)
        channels = {"R": (smooth * 0.9).astype(np.float16), "G": smooth.astype(np.float16),
                    "B": (smooth[::-1] * 0.5).astype(np.float16).copy(), "A": np.ones((70, 45), np.float16)}
        self.write("zip.exr", part(channels))
        exact = self.apply("zip.exr", output="exact.exr")[0][1]
        for compression in ("pxr24", "b44", "b44a", "dwaa", "dwab"):
            with self.subTest(compression):
                self.write("in.exr", part(channels, compression=COMPRESSIONS[compression]))
                header, found = self.apply("in.exr")[0]
                self.assertEqual(header["compression"], COMPRESSIONS[compression])
                for name in "RGB":
                    # Two rounds of such a compression.
                    np.testing.assert_allclose(found[name].astype(float), exact[name].astype(float), atol=0.02)
                np.testing.assert_array_equal(found["A"], channels["A"])

    def test_identity_copies_every_bit(self):
        channels = channels_of({**HALVES, "id": np.uint32})
        channels["R"][3, 4] = np.nan
        for compression in ("zip", "dwaa", "b44"):
            self.write("in.exr", part(channels, compression=COMPRESSIONS[compression]))
            self.apply("in.exr", recipe="same.yaml")
            self.assertEqual((self.folder / "out.exr").read_bytes()[-4000:], (self.folder / "in.exr").read_bytes()[-4000:])

    def test_types_and_compressions_asked_for(self):
        names = {"R": np.float32, "G": np.float32, "B": np.float32, "A": np.float32, "Z": np.float32, "id": np.uint32}
        channels = channels_of(names, 300, 20)
        channels["G"][0, 0] = 1e30
        before = self.write("in.exr", part(channels))
        exact = self.apply("in.exr", output="exact.exr")[0][1]
        for compression in ("piz", "zips", "none", "dwab", "zip"):
            with self.subTest(compression):
                header, found = self.apply("in.exr", "-d", "half", "--compression", compression)[0]
                self.assertEqual(header["compression"], COMPRESSIONS[compression.replace("none", "no")])
                self.assertEqual([found[c].dtype for c in "RGBA"], [np.float16] * 4)
                if compression != "dwab":
                    for c in "RGB":
                        limited = np.clip(exact[c], -65504, 65504).astype(np.float16)
                        np.testing.assert_array_equal(found[c], limited)
                    for c in ("Z", "id"):
                        np.testing.assert_array_equal(found[c], channels[c])
        # The windows, attributes and line order go with it.
        self.assertKept(before, self.apply("in.exr", "-d", "float", "--compression", "zip"), "RGB")

    def test_decreasing_lines_and_tall_windows(self):
        window = (np.array([-7, -300], np.int32), np.array([3, 99], np.int32))
        channels = channels_of(HALVES, 400, 11)
        for order in (OpenEXR.INCREASING_Y, OpenEXR.DECREASING_Y):
            before = self.write("in.exr", part(channels, lineOrder=order, dataWindow=window,
                                               displayWindow=(np.array([0, 0], np.int32), np.array([99, 9], np.int32))))
            self.assertKept(before, self.apply("in.exr"), "RGB")
            after = self.apply("in.exr", "--compression", "piz")
            self.assertKept(before, after, "RGB", same_types=False)
            self.assertEqual(after[0][0]["lineOrder"], order)

    def test_parts_of_other_windows_and_kinds(self):
        display = (np.array([0, 0], np.int32), np.array([36, 23], np.int32))
        one = part(channels_of(HALVES), "rgba", displayWindow=display, chromaticities=(0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767))
        two = part(channels_of({"R": np.float32, "G": np.float32, "B": np.float32}, 5, 9), "N",
                   displayWindow=display, dataWindow=(np.array([3, 3], np.int32), np.array([11, 7], np.int32)))
        three = part(channels_of({"Z": np.float32}, 9, 3), "depth", displayWindow=display,
                     compression=OpenEXR.PIZ_COMPRESSION)
        before = self.write("in.exr", one, two, three)
        self.assertKept(before, self.apply("in.exr"), "RGB")
        after = self.apply("in.exr", "--compression", "zips")
        self.assertKept(before, after, "RGB", same_types=False)
        self.assertEqual([h["compression"] for h, _ in after], [OpenEXR.ZIPS_COMPRESSION] * 3)
        # Asked for, a layer that is not unmistakable is transformed, and it alone.
        self.assertKept(before, self.apply("in.exr", "--layer", "N"), "RGB", part_index=1)

    def test_attributes_that_no_library_knows(self):
        self.write("in.exr", part(channels_of(HALVES), owner="x" * 11))
        data = (self.folder / "in.exr").read_bytes()
        old = b"owner\0string\0" + (11).to_bytes(4, "little") + b"x" * 11
        new = b"maker\0opaque\0" + (11).to_bytes(4, "little") + bytes(range(11))
        self.assertEqual(data.count(old), 1)
        (self.folder / "in.exr").write_bytes(data.replace(old, new))
        self.assertWorks("apply", "--quiet", "r.yaml", "in.exr", "out.exr")
        self.assertIn(new, (self.folder / "out.exr").read_bytes())

    def test_result_does_not_depend_on_threads(self):
        self.write("in.exr", part(channels_of(HALVES, 200, 31)))
        for threads in (1, 3):
            self.assertWorks("apply", "--quiet", "r.yaml", "in.exr", f"{threads}.exr", "--threads", threads)
        self.assertEqual((self.folder / "1.exr").read_bytes(), (self.folder / "3.exr").read_bytes())

    def test_a_system_without_proc_does_not_say_how_much_memory_it_has(self):
        bare = ["unshare", "--mount", "--map-root-user", "sh", "-c", 'mount -t tmpfs none /proc && exec "$@"', "sh"]
        if subprocess.run([*bare, "true"], capture_output=True, check=False).returncode != 0:
            self.skipTest("this machine lets nobody take /proc away")
        Image.fromarray(np.arange(48, dtype=np.uint8).reshape(4, 4, 3)).save(self.folder / "in.png")
        self.assertWorks("apply", "--quiet", "r.yaml", "in.png", "out.png")
        # The program for pictures: lutgen finds it through /proc.
        words = [*bare, LUTGEN.with_name("lutgen-pictures"), "apply", "--quiet", "r.yaml", "in.png", "bare.png"]
        run = subprocess.run(words, capture_output=True, text=True, cwd=self.folder, check=False, timeout=60)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assertEqual((self.folder / "bare.png").read_bytes(), (self.folder / "out.png").read_bytes())


class Layers(LutgenTest):
    def setUp(self):
        super().setUp()
        (self.folder / "r.yaml").write_text(RECIPE)

    def changed(self, names, *arguments, types=np.float32):
        """Which channels of one part moved."""
        channels = channels_of(dict.fromkeys(names, types), 4, 6)
        written = part(channels)
        OpenEXR.File(written.header, written.channels).write(str(self.folder / "in.exr"))
        self.assertWorks("apply", "--quiet", "r.yaml", "in.exr", "out.exr", *arguments)
        (_, found), = parts_of(self.folder / "out.exr")
        return {name for name in names if not np.array_equal(found[name], channels[name])}

    @staticmethod
    def layer(*names):
        return {f"{name}.{c}" for name in names for c in "RGB"}

    def test_the_one_that_is_unmistakable(self):
        bare = set("RGB")
        self.assertEqual(self.changed([*bare, "A", *self.layer("diffuse", "N")]), bare)
        self.assertEqual(self.changed([*self.layer("ViewLayer.AO", "ViewLayer.Combined", "ViewLayer.Normal")]),
                         self.layer("ViewLayer.Combined"))
        self.assertEqual(self.changed([*self.layer("beauty", "N")]), self.layer("beauty"))
        self.assertEqual(self.changed(["rgba.red", "rgba.green", "rgba.blue", "rgba.alpha", *self.layer("P")]),
                         {"rgba.red", "rgba.green", "rgba.blue"})

    def test_what_is_asked_for(self):
        names = [*self.layer("diffuse", "specular", "N")]
        self.assertEqual(self.changed(names, "--layer", "diffuse"), self.layer("diffuse"))
        self.assertEqual(self.changed(names, "--layer", "diffuse", "--layer", "specular"), self.layer("diffuse", "specular"))
        self.assertEqual(self.changed(names, "--channels", "N.R,N.G,N.B"), self.layer("N"))

    def test_refused_where_it_is_not_sure(self):
        def refused(names, *says, arguments=(), types=np.float32):
            channels = channels_of(dict.fromkeys(names, types), 4, 6)
            OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, channels).write(
                str(self.folder / "in.exr"))
            self.assertFails("apply", "r.yaml", "in.exr", "out.exr", *arguments, says=["in.exr", *says])

        refused(self.layer("AO", "diffuse"), "--layer", "AO, diffuse")
        refused(self.layer("AO"), "--layer")
        refused(self.layer("Fg.Combined", "Bg.Combined"), "--layer", "Bg.Combined")
        refused(["X", "Y", "Z"], "red, green and blue", "--channels")
        refused(set("RGB"), "uint32", types=np.uint32)
        refused(self.layer("beauty"), "layer 'b'", "beauty", arguments=("--layer", "b"))
        refused(self.layer("beauty"), "R, G, X", arguments=("--channels", "R,G,X"))

    def test_views_go_together(self):
        channels = channels_of(dict.fromkeys([*"RGB", "right.R", "right.G", "right.B", "N.R", "N.G", "N.B"], np.float32), 4, 6)
        written = part(channels, multiView=["left", "right"])
        OpenEXR.File(written.header, written.channels).write(str(self.folder / "in.exr"))
        self.assertWorks("apply", "--quiet", "r.yaml", "in.exr", "out.exr")
        (_, found), = parts_of(self.folder / "out.exr")
        moved = {name for name in channels if not np.array_equal(found[name], channels[name])}
        self.assertEqual(moved, {*"RGB", "right.R", "right.G", "right.B"})


class Hostile(LutgenTest):
    def setUp(self):
        super().setUp()
        (self.folder / "r.yaml").write_text(RECIPE)
        part_ = channels_of(HALVES, 64, 33)
        OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, part_).write(
            str(self.folder / "good.exr"))
        self.good = (self.folder / "good.exr").read_bytes()

    def test_cut_short_at_any_place(self):
        for size in (0, 3, 60, 330, 380, len(self.good) - 1):
            (self.folder / "in.exr").write_bytes(self.good[:size])
            with self.subTest(size):
                self.assertFails("apply", "r.yaml", "in.exr", "out.exr", says=["in.exr"])

    def test_bytes_changed(self):
        random = np.random.default_rng(4)
        for _ in range(8):
            data = bytearray(self.good)
            for at in random.integers(0, 700, 3):
                data[at] = random.integers(256)
            (self.folder / "in.exr").write_bytes(data)
            run = lutgen("apply", "--quiet", "r.yaml", "in.exr", "out.exr", folder=self.folder)
            self.assertIn(run.returncode, (0, 1), run.stderr)
            self.assertEqual(run.stderr.count("\n"), run.returncode, run.stderr)

    def test_a_window_that_no_memory_holds(self):
        old = self.good.index(b"dataWindow\0box2i\0") + len(b"dataWindow\0box2i\0") + 4
        for corner, says in (((2**31 - 2, 2**31 - 2), "--max-pixels"), ((40000, 40000), "cut short")):
            data = bytearray(self.good)
            data[old + 8:old + 16] = np.array(corner, np.int32).tobytes()
            (self.folder / "in.exr").write_bytes(data)
            self.assertFails("apply", "r.yaml", "in.exr", "out.exr", says=["in.exr", says])
        self.assertFails("apply", "r.yaml", "good.exr", "out.exr", "--max-pixels", "2000", says=["64", "33", "--max-pixels"])

    def test_an_unfinished_render(self):
        data = bytearray(self.good)
        # Four chunks of 16 rows: the table ends where the first chunk begins.
        for at in range(300, 500):
            if int.from_bytes(data[at:at + 8], "little") == at + 32:
                data[at + 16:at + 24] = bytes(8)
                break
        else:
            self.fail("no table of offsets found")
        (self.folder / "in.exr").write_bytes(data)
        self.assertFails("apply", "r.yaml", "in.exr", "out.exr", says=["in.exr", "1 of 4", "missing"])

    def test_outputs_that_cannot_be_written(self):
        (self.folder / "folder.exr").mkdir()
        for output, says in (("no/such/out.exr", "folder"), ("folder.exr", "folder"), ("/dev/null", "device"),
                             ("out.nothing", "format")):
            with self.subTest(output):
                self.assertFails("apply", "r.yaml", "good.exr", output, says=[says])
        self.assertFails("apply", "r.yaml", "good.exr", "out.exr", "-d", "uint16", says=["uint16", "half or float"])
        self.assertFails("apply", "r.yaml", "good.exr", "out.exr", "--compression", "lzw", says=["lzw", "piz"])

    def test_a_full_disk(self):
        random = np.random.default_rng(2).random((90, 120, 3))
        Image.fromarray((255 * random).astype(np.uint8)).save(self.folder / "in.png")

        def full():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))

        before = sorted(self.folder.iterdir())
        for output in ("out.png", "out.jpg", "out.tif", "out.dpx", "out.exr"):
            with self.subTest(output):
                type_ = ["-d", "half"] if output == "out.exr" else []
                run = subprocess.run([LUTGEN, "apply", "r.yaml", "in.png", output, *type_], cwd=self.folder, preexec_fn=full,
                                     capture_output=True, text=True, timeout=300)
                self.assertEqual(run.returncode, 1, run.stderr)
                self.assertEqual(run.stderr.count("\n"), 1, run.stderr)
                self.assertIn(f"lutgen: {output}: output: cannot be written", run.stderr)
                self.assertEqual(sorted(self.folder.iterdir()), before)

    def test_in_place(self):
        before = parts_of(self.folder / "good.exr")
        self.assertWorks("apply", "--quiet", "r.yaml", "good.exr", "out.exr")
        self.assertWorks("apply", "--quiet", "r.yaml", "good.exr", "./good.exr")
        self.assertEqual((self.folder / "good.exr").read_bytes(), (self.folder / "out.exr").read_bytes())
        self.assertNotEqual(before[0][1]["R"].tobytes(), parts_of(self.folder / "good.exr")[0][1]["R"].tobytes())


class Unusual(LutgenTest):
    """Pyramids, subsampled channels, deep pictures: right, or refused in a line."""

    LOOK = "metamer: 1\nname: a\nspace: ACEScg\ninput: {illuminant: D65}\noutput: {illuminant: A}\nscene: {kind: smooth}\n"

    def setUp(self):
        super().setUp()
        (self.folder / "a.yaml").write_text(self.LOOK)
        self.random = np.random.default_rng(4)

    def relit(self, rgb):
        """By a plain file of the same numbers."""
        OpenEXR.File({}, {"RGB": np.ascontiguousarray(rgb, np.float16)}).write(str(self.folder / "plain.exr"))
        self.assertEqual(lutgen("apply", "a.yaml", "plain.exr", "lit.exr", "--quiet", folder=self.folder).returncode, 0)
        return OpenEXR.File(str(self.folder / "lit.exr")).channels()["RGB"].pixels

    def test_every_level_of_a_pyramid(self):
        levels = [self.random.random((side, side, 3)).astype(np.float16) for side in (16, 8, 4, 2, 1)]
        (self.folder / "mip.exr").write_bytes(exr_bytes.pyramid(levels, 8))
        run = lutgen("apply", "a.yaml", "mip.exr", "out.exr", "--quiet", folder=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        got = exr_bytes.pyramid_levels((self.folder / "out.exr").read_bytes(), 16, 8)
        for level, ours in zip(levels, got, strict=True):
            np.testing.assert_array_equal(ours, self.relit(level))

    def test_deep_pictures(self):
        samples = np.empty((2, 3), object)
        for place in np.ndindex(samples.shape):
            samples[place] = np.full(1 + sum(place), 0.5, np.float32)
        OpenEXR.File({"compression": OpenEXR.ZIPS_COMPRESSION, "type": OpenEXR.deepscanline},
                     dict.fromkeys("RGBAZ", samples)).write(str(self.folder / "deep.exr"))
        for command in (("apply", "a.yaml", "deep.exr", "o.exr"), ("compare", "deep.exr", "deep.exr"),
                        ("skin", "estimate", "deep.exr", "-o", "o.exr")):
            self.assertFails(*command, says=["deep.exr", "deep", "flatten"])

    def test_subsampled_channels(self):
        rgb = self.random.random((6, 8, 3)).astype(np.float16)
        small = self.random.random((3, 4)).astype(np.float32)
        planes = {name: (exr_bytes.HALF, 1, rgb[..., k]) for k, name in enumerate("RGB")}
        data = exr_bytes.scanlines({**planes, "U": (exr_bytes.FLOAT, 2, small)})
        (self.folder / "u.exr").write_bytes(data)
        run = lutgen("apply", "a.yaml", "u.exr", "out.exr", "--quiet", folder=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        lit = self.relit(rgb)
        lit_planes = {name: (exr_bytes.HALF, 1, lit[..., k]) for k, name in enumerate("RGB")}
        self.assertEqual((self.folder / "out.exr").read_bytes(),
                         exr_bytes.scanlines({**lit_planes, "U": (exr_bytes.FLOAT, 2, small)}))
        (self.folder / "ryby.exr").write_bytes(exr_bytes.scanlines(
            {"Y": planes["G"], "RY": (exr_bytes.HALF, 2, small), "BY": (exr_bytes.HALF, 2, small)}))
        self.assertFails("apply", "a.yaml", "ryby.exr", "o.exr", says=["ryby.exr: channels '3'", "it has BY, RY, Y"])
        (self.folder / "rb.exr").write_bytes(exr_bytes.scanlines(
            {**planes, "R": (exr_bytes.HALF, 2, small), "B": (exr_bytes.HALF, 2, small)}))
        self.assertFails("apply", "a.yaml", "rb.exr", "o.exr", says=["rb.exr: layer 'R, G, B'", "full resolution"])
        self.assertFails("skin", "estimate", "u.exr", "-o", "o.exr", says=["u.exr"])


if __name__ == "__main__":
    unittest.main()
