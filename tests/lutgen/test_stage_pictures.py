# SPDX-License-Identifier: Apache-2.0
"""Charts, wall patches and environments as pictures: the same answer as numbers, and what can be wrong with them."""

import csv
import json
import unittest

import numpy as np
import OpenEXR
from PIL import Image

from lutgen import LutgenTest
from stage_physics import Stage, numbers

# A chart that leans: corners clockwise from that of the first patch, in pixels.
CORNERS = np.array([[60.0, 40.0], [610.0, 75.0], [585.0, 440.0], [85.0, 405.0]])
SIZE = (480, 680)
CELLS = np.array([[0, 0], [6, 0], [6, 4], [0, 4]], dtype=float)


def homography(cells, pixels):
    """Cells from pixels."""
    rows = []
    for (x, y), (u, v) in zip(pixels, cells):
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y, -u], [0, 0, 0, x, y, 1, -v * x, -v * y, -v]]
    return np.linalg.svd(np.array(rows))[2][-1].reshape(3, 3)


def photograph(rgb, corners=CORNERS, size=SIZE):
    """A 24-patch chart in a grey room."""
    y, x = np.mgrid[0 : size[0], 0 : size[1]] + 0.5
    h = homography(CELLS, corners) @ np.stack([x.ravel(), y.ravel(), np.ones(x.size)])
    column, row = np.floor(h[:2] / h[2]).astype(int)
    inside = (column >= 0) & (column < 6) & (row >= 0) & (row < 4)
    picture = np.full((x.size, 3), 0.05)
    picture[inside] = np.asarray(rgb)[row[inside] * 6 + column[inside]]
    return picture.reshape(*size, 3)


def write_exr(file, picture):
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGB": picture.astype(np.float32)}).write(str(file))


class Pictures(LutgenTest):
    def setUp(self):
        super().setUp()
        self.stage = Stage("A")
        self.numbers = self.stage.write(self.folder, "numbers.yaml")
        for key, rgb in zip("rgbt", [*self.stage.charts, self.stage.target]):
            write_exr(self.folder / f"{key}.exr", photograph(rgb))
        wall = np.zeros((100, 300, 3))
        for k in range(3):
            wall[20:80, 20 + 100 * k : 80 + 100 * k] = self.stage.primaries[:, k]
        write_exr(self.folder / "wall.exr", wall)
        self.pictures = self.folder / "pictures.yaml"
        self.write()

    def write(self, corners=CORNERS, extra=""):
        boxes = ", ".join(f"{name}: {{file: wall.exr, box: [{30 + 100 * k}, 30, {70 + 100 * k}, 70]}}"
                          for k, name in enumerate(("red", "green", "blue")))
        listed = "[" + ", ".join(numbers(corner) for corner in corners) + "]"
        self.pictures.write_text(
            f"metamer_stage: 1\nprimaries: {{{boxes}}}\n"
            f"charts: {{red: r.exr, green: g.exr, blue: b.exr, target: t.exr, corners: {listed}}}\n"
            f"environment: {{white: {numbers(self.stage.white)}}}\n{extra}")

    def solve(self, file, *arguments):
        self.assertWorks("stage", "solve", file, "-o", self.folder / "out.json", *arguments)
        return json.loads((self.folder / "out.json").read_text())

    def test_same_as_numbers(self):
        pictures, plain = self.solve(self.pictures), self.solve(self.numbers)
        for key in ("M", "Q", "N"):
            error = np.abs(np.array(pictures[key]) - plain[key]).max() / np.abs(plain[key]).max()
            self.assertLessEqual(error, 1e-6, key)  # pictures are float32
        self.assertEqual([p["name"] for p in pictures["patches"]], [p["name"] for p in plain["patches"]])

    def test_turned_chart(self):
        """The chart stands on its side in the pictures, and the corners are given as the picture shows them."""
        for quarters in (1, 2, 3):
            with self.subTest(quarters=quarters):
                given = np.roll(CORNERS, quarters, axis=0)
                self.write(given)
                ours = self.solve(self.pictures)
                plain = self.solve(self.numbers)
                self.assertLessEqual(np.abs(np.array(ours["Q"]) - plain["Q"]).max(), 1e-5)
                self.assertTrue(any("turned by" in note for note in ours["notes"]))

    def test_check_pictures(self):
        self.solve(self.pictures, "--check-pictures", self.folder / "check")
        for name in ("red", "green", "blue", "target"):
            picture = np.asarray(Image.open(self.folder / f"check_{name}.png").convert("RGB")).astype(int)
            self.assertEqual(picture.shape[:2], SIZE)
            lines = (picture[..., 1] > 200) & (picture[..., 0] < 60) & (picture[..., 2] < 140)
            self.assertGreater(lines.sum(), 24 * 4 * 30)  # 24 squares of about 45 pixels' side
            # The square of the first patch has its corners a quarter of a cell in.
            inverse = np.linalg.inv(homography(CELLS, CORNERS))
            x, y, w = inverse @ [0.25, 0.25, 1]
            near = lines[int(y / w) - 2 : int(y / w) + 3, int(x / w) - 2 : int(x / w) + 3]
            self.assertTrue(near.any())

    def test_sample(self):
        corners = [f"{x},{y}" for x, y in CORNERS]
        self.assertWorks("stage", "sample", self.folder / "t.exr", "--corners", *corners, "-o", self.folder / "s.csv",
                         "--check-picture", self.folder / "s.png")
        with open(self.folder / "s.csv", newline="", encoding="utf-8") as stream:
            rows = list(csv.reader(stream))
        self.assertEqual(rows[0], ["patch", "R", "G", "B"])
        self.assertEqual([row[0] for row in rows[1:]], self.stage.names)
        values = np.array([[float(value) for value in row[1:]] for row in rows[1:]])
        np.testing.assert_allclose(values, self.stage.target, rtol=1e-6, atol=1e-7)

    def test_saturated_and_missing_pixels(self):
        picture = photograph(self.stage.target)
        centre = np.linalg.inv(homography(CELLS, CORNERS)) @ [0.5, 3.5, 1]  # the white patch
        x, y = (centre[:2] / centre[2]).astype(int)
        picture[y, x] = 5.0  # one clipped pixel
        other = np.linalg.inv(homography(CELLS, CORNERS)) @ [1.5, 0.5, 1]  # light skin
        x, y = (other[:2] / other[2]).astype(int)
        picture[y, x, 1] = np.nan
        write_exr(self.folder / "t.exr", picture)
        self.write(extra="saturation: 4\n")
        ours = self.solve(self.pictures)
        reasons = {patch["name"]: patch["reason"] for patch in ours["excluded"]}
        self.assertIn("saturated", reasons["white 9.5 (.05 D)"])
        self.assertIn("missing", reasons["light skin"])
        self.assertEqual(len(reasons), 2)

    def test_bad_pictures(self):
        def fails(*says):
            self.assertFails("stage", "solve", "pictures.yaml", "-o", "out.json", says=says)
        self.write(CORNERS[[0, 2, 1, 3]])
        fails("corners", "in order")
        text = self.pictures.read_text()
        self.pictures.write_text(text[: text.index(", corners")] + "}\n" + f"environment: {{white: [1, 1, 1]}}\n")
        fails("r.exr", "corners", "are missing")
        self.write()
        self.pictures.write_text(self.pictures.read_text().replace("[30, 30, 70, 70]", "[30, 30, 700, 70]"))
        fails("wall.exr", "box", "within the picture")
        self.write()
        (self.folder / "g.exr").write_bytes(b"no picture")
        fails("g.exr", "cannot be read")
        write_exr(self.folder / "g.exr", photograph(self.stage.charts[1])[:100])
        ours = self.solve(self.pictures)  # rows 2 to 4 lie outside that picture
        self.assertTrue(all("g.exr" in patch["reason"] for patch in ours["excluded"]))

    def environment(self, picture, facing=None):
        write_exr(self.folder / "environment.exr", picture)
        text = self.numbers.read_text()
        text = text[: text.index("environment")] + "environment: {file: environment.exr"
        self.numbers.write_text(text + (f", facing: {numbers(facing)}" if facing else "") + "}\n")

    def test_environment(self):
        """Even light is its own radiance; a half sphere of it before the chart too, behind the chart nothing."""
        even = np.ones((64, 128, 3)) * [0.7, 0.5, 0.3]
        self.environment(even)
        np.testing.assert_allclose(self.solve(self.numbers)["environment_white"], [0.7, 0.5, 0.3], rtol=1e-6)
        # The middle of the picture is +z: columns 32 to 95 are the hemisphere before a chart that faces it.
        half = even.copy()
        half[:, :32] = half[:, 96:] = 0
        self.environment(half, [0, 0, 1])
        np.testing.assert_allclose(self.solve(self.numbers)["environment_white"], [0.7, 0.5, 0.3], rtol=1e-6)
        self.environment(half, [0, 0, -2])
        self.assertFails("stage", "solve", "numbers.yaml", "-o", "out.json", says=["environment.white", "no light"])
        # A chart that faces up sees half of it; and the top rows are up.
        self.environment(half, [0, 1, 0])
        np.testing.assert_allclose(self.solve(self.numbers)["environment_white"], [0.35, 0.25, 0.15], rtol=1e-6)
        sky = even.copy()
        sky[32:] = 0
        self.environment(sky, [0, 3, 0])
        np.testing.assert_allclose(self.solve(self.numbers)["environment_white"], [0.7, 0.5, 0.3], rtol=1e-6)
        # +x is at the left quarter, as OpenEXR has it.
        left = even.copy()
        left[:, 64:] = 0
        self.environment(left, [1, 0, 0])
        np.testing.assert_allclose(self.solve(self.numbers)["environment_white"], [0.7, 0.5, 0.3], rtol=1e-6)

    def test_bad_environment(self):
        self.environment(np.ones((64, 64, 3)))
        self.assertFails("stage", "solve", "numbers.yaml", "-o", "out.json", says=["64 x 64", "twice as wide"])
        self.environment(np.zeros((32, 64, 3)))
        self.assertFails("stage", "solve", "numbers.yaml", "-o", "out.json", says=["no light"])
        negative = np.ones((32, 64, 3))
        negative[3, 5] = [-100, np.nan, np.inf]
        self.environment(negative)
        np.testing.assert_allclose(self.solve(self.numbers)["environment_white"], [1, 1, 1], rtol=2e-3)


if __name__ == "__main__":
    unittest.main()
