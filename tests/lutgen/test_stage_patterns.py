# SPDX-License-Identifier: Apache-2.0
"""lutgen stage patterns: every code of every file type by other readers, and the stage file from there to a solved wall."""

import json
import re
import struct
import unittest
import zlib

import numpy as np
import OpenEXR
import tifffile

from lutgen import LutgenTest
from stage_physics import Stage, numbers
from test_stage_pictures import CORNERS, photograph, write_exr

WALL = (64, 36)
# 0.1 m x 0.05 m at 5 mm: 20 x 10 pixels amid 64 x 36.
SQUARE = (slice(13, 23), slice(22, 42))
CHANNELS = ("red", "green", "blue")
GEOMETRY = ("--resolution", "64x36", "--pitch", 5, "--square", "0.1x0.05")


def read_png(file):
    """Codes, by the standard's filters."""
    data, at, packed = file.read_bytes(), 8, b""
    while at < len(data):
        (length,), kind = struct.unpack(">I", data[at : at + 4]), data[at + 4 : at + 8]
        if kind == b"IHDR":
            width, height, bits, colour, _, _, interlaced = struct.unpack(">IIBBBBB", data[at + 8 : at + 21])
            assert colour == 2 and not interlaced
        packed += data[at + 8 : at + 8 + length] if kind == b"IDAT" else b""
        at += 12 + length
    step = 3 * bits // 8
    lines = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + width * step)
    above = [0] * (width * step)
    rows = []
    for kind, line in zip(lines[:, 0], lines[:, 1:].tolist()):
        for i, value in enumerate(line):
            a, b, c = line[i - step] if i >= step else 0, above[i], above[i - step] if i >= step else 0
            paeth = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            line[i] = (value + (0, a, b, (a + b) // 2, paeth)[kind]) % 256
        above = line
        rows.append(line)
    raw = np.array(rows, np.uint8)
    return (raw if bits == 8 else raw.view(">u2").astype(np.uint16)).reshape(height, width, 3)


def read_dpx(file):
    """Codes of 8 or 16 bits, 10 filled into words from above (SMPTE 268M, packing 1), or 12 packed into words from below."""
    data = file.read_bytes()
    order = {b"SDPX": ">", b"XPDS": "<"}[data[:4]]
    (offset,) = struct.unpack(order + "I", data[4:8])
    width, height = struct.unpack(order + "II", data[772:780])
    bits, packing = data[803], struct.unpack(order + "H", data[804:806])[0]
    if bits == 10:
        assert packing == 1
        words = np.frombuffer(data, order + "u4", width * height, offset)
        codes = np.stack([words >> shift & 1023 for shift in (22, 12, 2)], axis=-1)
    elif bits == 12:
        assert packing == 0 and order == "<"
        lines = np.frombuffer(data, np.uint8, height * -(-36 * width // 32) * 4, offset).reshape(height, -1)
        stream = np.unpackbits(lines, axis=1, bitorder="little")[:, : 36 * width].reshape(-1, 12)
        codes = stream @ (1 << np.arange(12))
    else:
        codes = np.frombuffer(data, np.uint8 if bits == 8 else order + "u2", 3 * width * height, offset)
    return codes.reshape(height, width, 3)


def read_exr(file):
    return OpenEXR.File(str(file)).channels()["RGB"].pixels


READERS = {".png": read_png, ".dpx": read_dpx, ".tif": tifffile.imread, ".exr": read_exr}


class Patterns(LutgenTest):
    def patterns(self, pictures, *arguments):
        self.printed = self.assertWorks("stage", "patterns", "-o", "wall.yaml", "--pictures", pictures, *GEOMETRY,
                                        *arguments)

    def expected(self, drive, square):
        picture = np.zeros((WALL[1], WALL[0], 3))
        picture[SQUARE if square else ...] = drive
        return picture

    def test_every_code(self):
        """Every pixel of every picture is the code of its drive, and drives are as equal steps as the type holds."""
        for extension, name, full in ((".png", "", 255), (".png", "uint16", 65535), (".dpx", "", 1023),
                                      (".dpx", "uint8", 255), (".dpx", "uint12", 4095), (".dpx", "uint16", 65535),
                                      (".tif", "", 65535), (".tif", "uint8", 255), (".exr", "", 0),
                                      (".exr", "float", 0)):
            with self.subTest(extension=extension, type=name):
                self.patterns("w" + extension, "--steps", 8, *(["-d", name] if name else []))
                held = np.float32 if name == "float" else np.float16
                drives = [round(i / 7 * full) if full else held(i / 7) for i in range(8)]
                wanted = {}
                for square in (False, True):
                    for k, channel in enumerate((*CHANNELS, "white", "black")):
                        drive = [1, 1, 1] if channel == "white" else [0, 0, 0] if k == 4 else np.eye(3)[k]
                        wanted[("square_" if square else "") + channel] = np.array(drive) * (full or 1), square
                del wanted["square_black"]
                for k, channel in enumerate(CHANNELS):
                    for i, drive in enumerate(drives):
                        wanted[f"ramp_{channel}_{i:02d}"] = np.eye(3)[k] * drive, True
                files = {file.stem[2:]: file for file in self.folder.glob("w_*" + extension)}
                self.assertEqual(sorted(files), sorted(wanted))
                for pattern, file in files.items():
                    pixels = READERS[extension](file)
                    if not full:
                        self.assertEqual(pixels.dtype, held)
                    np.testing.assert_array_equal(pixels, self.expected(*wanted[pattern]), pattern)
                stated = re.findall(r"^#   ([0-9.]+) +w_ramp_red_", (self.folder / "wall.yaml").read_text(), re.MULTILINE)
                # Nine digits are printed.
                np.testing.assert_allclose([float(text) for text in stated], np.array(drives, float) / (full or 1), rtol=5e-9)
                for file in files.values():
                    file.unlink()

    def test_frames(self):
        self.patterns("w.####.png", "--steps", 3, "--first-frame", 1001)
        self.assertEqual(sorted(file.name for file in self.folder.glob("*.png")),
                         [f"w.{1001 + i}.png" for i in range(9 + 9)])
        np.testing.assert_array_equal(read_png(self.folder / "w.1002.png"), self.expected([0, 255, 0], False))
        np.testing.assert_array_equal(read_png(self.folder / "w.1018.png"), self.expected([0, 0, 255], True))
        self.assertIn("w.1018.png", (self.folder / "wall.yaml").read_text())
        self.assertEqual(self.printed.count("\n"), 1)
        self.assertRegex(self.printed, r"^18 pictures of 64 x 36, square of 20 x 10 \(0.1 m x 0.05 m\), 3 steps")
        quiet = self.assertWorks("stage", "patterns", "-o", "q.yaml", "--pictures", "q.png", *GEOMETRY, "--quiet")
        self.assertEqual(quiet, "")

    def test_from_the_stage_file_to_a_wall(self):
        """The file parses as it is and cannot be solved by mistake; filled in, it gives the answer of the same numbers."""
        stage = Stage("A", square=(0.1, 0.05, 0.2))
        self.patterns("w.png", "--distance", 0.2)
        file = self.folder / "wall.yaml"
        solve = ("stage", "solve", "wall.yaml", "-o", "out.json")
        self.assertFails(*solve, says=["captures/red.exr"])
        (self.folder / "captures").mkdir()
        for key, rgb in zip((*CHANNELS, "target"), [*stage.charts, stage.target]):
            write_exr(self.folder / f"captures/chart_{key}.exr", photograph(rgb))
        for k, channel in enumerate(CHANNELS):
            write_exr(self.folder / f"captures/{channel}.exr", np.full((20, 30, 3), stage.primaries[:, k]))
        self.assertFails(*solve, says=["captures/red.exr", "box"])
        text = file.read_text().replace("[0, 0, 0, 0]", "[5, 5, 25, 15]")
        file.write_text(text)
        self.assertFails(*solve, says=["captures/chart_red.exr", "corners"])
        listed = "[" + ", ".join(numbers(corner) for corner in CORNERS) + "]"
        file.write_text(text.replace("[[0, 0], [0, 0], [0, 0], [0, 0]]", listed)
                        .replace("# environment: {white: [1.1, 1.0, 0.8]}", f"environment: {{white: {numbers(stage.white)}}}"))
        self.assertWorks(*solve)
        ours, theirs = json.loads((self.folder / "out.json").read_text()), stage.solution()
        for key in ("M", "Q", "N", "beta"):
            # Pictures are float.
            np.testing.assert_allclose(ours[key], theirs[key], rtol=0, atol=1e-5 * np.abs(theirs[key]).max(), err_msg=key)

    def test_refusals(self):
        def failing(*says, pictures="w.png", arguments=(), geometry=GEOMETRY):
            self.assertFails("stage", "patterns", "-o", "wall.yaml", "--pictures", pictures, *geometry, *arguments,
                             says=says)

        failing("extension", ".jpg", ".png", pictures="w.jpg")
        failing("-d", "half", ".png", "uint16", arguments=("-d", "half"))
        failing("-d", "uint10", "float", pictures="w.exr", arguments=("-d", "uint10"))
        failing("--resolution", "64x", geometry=("--resolution", "64x", "--pitch", 5))
        failing("--resolution", "0x10", geometry=("--resolution", "0x10", "--pitch", 5))
        failing("--resolution", "64.5x10", geometry=("--resolution", "64.5x10", "--pitch", 5))
        failing("--square", "200 x 200", "64 x 36", geometry=("--resolution", "64x36", "--pitch", 5))
        failing("--square", "nan", geometry=("--resolution", "64x36", "--pitch", 5, "--square", "nanx1"))
        failing("none/w_red.png", pictures="none/w.png")
        self.assertFails("stage", "patterns", "-o", "none/w.yaml", "--pictures", "w.png", *GEOMETRY, says=["none"])


if __name__ == "__main__":
    unittest.main()
