# SPDX-License-Identifier: Apache-2.0
"""What stage solve writes for OpenColorIO, read back by its newest release, and its report and figure."""

import json
import unittest

import numpy as np
import PyOpenColorIO as ocio

from lutgen import LutgenTest
from stage_physics import Stage

PIXELS = np.array([[0.18, 0.18, 0.18], [0.4, 0.3, 0.2], [0.9, 0.1, 0.05], [0.02, 0.03, 0.3], [0, 0, 0], [8, 5, 2]])
FLOAT = 1e-6  # OpenColorIO computes in float32


def applied(processor, pixels):
    values = np.array(pixels, dtype=np.float32)
    processor.getDefaultCPUProcessor().applyRGB(values)
    return values.astype(float)


def base_config(name):
    """A config whose reference is Rec.709, not ACES2065-1."""
    config = ocio.Config()
    config.setVersion(2, 1)
    matrix = ocio.MatrixTransform(np.array([
        [0.4395756842, 0.3839125893, 0.1765117265, 0], [0.0896003829, 0.8147141542, 0.0956854629, 0],
        [0.0174154827, 0.1087343522, 0.8738501651, 0], [0, 0, 0, 1]]).ravel().tolist())
    config.addColorSpace(ocio.ColorSpace(name="lin_rec709"))
    config.addColorSpace(ocio.ColorSpace(name="aces", fromReference=matrix))
    config.setRole("aces_interchange", "aces")
    config.setRole("default", "lin_rec709")
    config.addDisplayView("d", "v", "lin_rec709")
    name.write_text(config.serialize())
    return matrix


class Outputs(LutgenTest):
    def setUp(self):
        super().setUp()
        self.stage = Stage("FL2", black=(0.01, 0.02, 0.015))
        self.file = self.stage.write(self.folder, extra="name: hangar\ncolour_space: ACEScg\n")
        self.solved = self.stage.solution()
        n, m = self.solved["N"], self.solved["M"]
        self.expected = {"out_of_frustum": np.maximum(PIXELS @ m.T, 0),
                         "in_frustum": np.maximum(PIXELS @ n.T + self.solved["offset"], 0),
                         "post_correction": PIXELS @ self.solved["Q"].T}

    def solve(self, *arguments):
        return self.assertWorks("stage", "solve", self.file, "-o", self.folder / "out.json", *arguments)

    def near(self, ours, theirs):
        self.assertLessEqual(np.abs(ours - theirs).max(), FLOAT * max(1.0, np.abs(theirs).max()) * 10)

    def test_luts(self):
        self.solve("--luts", self.folder / "wall")
        config = ocio.Config.CreateRaw()
        for part, expected in self.expected.items():
            for extension in ("spimtx", "clf", "ctf"):
                with self.subTest(part=part, extension=extension):
                    file = self.folder / f"wall_{part}.{extension}"
                    values = applied(config.getProcessor(ocio.FileTransform(str(file))), PIXELS)
                    if extension == "spimtx" and part != "post_correction":
                        values = np.maximum(values, 0)  # a matrix file cannot cut
                    self.near(values, expected)

    def judge(self, config, aces_from_reference):
        """Colours of the camera's space through the wall's spaces, and the look."""
        config.validate()
        camera = "hangar camera"
        for part in ("out_of_frustum", "in_frustum"):
            space = "hangar wall " + part.replace("_", " ")
            self.near(applied(config.getProcessor(camera, space), PIXELS), self.expected[part])
        look = ocio.LookTransform(src=camera, dst=camera, looks="hangar post-correction")
        self.near(applied(config.getProcessor(look), PIXELS), self.expected["post_correction"])
        # The camera's RGB is ACEScg here: AP0 from AP1 by the Academy's published matrix.
        published = np.array([[0.6954522414, 0.1406786965, 0.1638690622], [0.0447945634, 0.8596711185, 0.0955343182],
                              [-0.0055258826, 0.0040252103, 1.0015006723]])
        self.near(applied(config.getProcessor(camera, aces_from_reference), PIXELS), PIXELS @ published.T)

    def test_new_config(self):
        self.solve("--config", self.folder / "wall.ocio")
        config = ocio.Config.CreateFromFile(str(self.folder / "wall.ocio"))
        self.judge(config, "ACES2065-1")
        self.assertEqual((config.getMajorVersion(), config.getMinorVersion()), (2, 1))
        for display in config.getDisplays():
            for view in config.getViews(display):
                config.getProcessor(ocio.DisplayViewTransform(src="hangar camera", display=display, view=view))

    def test_base_config(self):
        base_config(self.folder / "base.ocio")
        self.solve("--config", self.folder / "wall.ocio", "--base", self.folder / "base.ocio")
        config = ocio.Config.CreateFromFile(str(self.folder / "wall.ocio"))
        self.judge(config, "aces")
        self.assertIn("lin_rec709", [space.getName() for space in config.getColorSpaces()])
        kept = (self.folder / "base.ocio").read_text().splitlines()
        written = iter((self.folder / "wall.ocio").read_text().splitlines())
        self.assertTrue(all(line in written or line.strip() in ("looks:", "looks: []", "") for line in kept))
        # A second stage beside the first; the same one again is refused.
        self.file.write_text(self.file.read_text().replace("hangar", "street"))
        self.solve("--config", self.folder / "both.ocio", "--base", self.folder / "wall.ocio")
        names = [space.getName() for space in ocio.Config.CreateFromFile(str(self.folder / "both.ocio")).getColorSpaces()]
        self.assertIn("hangar wall in frustum", names)
        self.assertIn("street wall in frustum", names)
        self.assertFails("stage", "solve", self.file, "-o", self.folder / "again.json", "--config",
                         self.folder / "again.ocio", "--base", self.folder / "both.ocio",
                         says=["street camera", "already"])

    def test_newest_base(self):
        """A profile that the OCIO metamer is built against does not know, its reference ACES2065-1."""
        base = ocio.Config.CreateFromBuiltinConfig("studio-config-latest")
        (self.folder / "studio.ocio").write_text(base.serialize())
        self.solve("--config", self.folder / "wall.ocio", "--base", self.folder / "studio.ocio")
        self.judge(ocio.Config.CreateFromFile(str(self.folder / "wall.ocio")), "ACES2065-1")

    def test_base_without_interchange(self):
        config = ocio.Config.CreateRaw()
        (self.folder / "raw.ocio").write_text(config.serialize())
        self.assertFails("stage", "solve", self.file, "-o", "o.json", "--config", "w.ocio", "--base", "raw.ocio",
                         says=["raw.ocio", "aces_interchange"])
        self.assertFails("stage", "solve", self.file, "-o", "o.json", "--config", "w.ocio", "--base", "no.ocio",
                         says=["no.ocio"])

    def test_report(self):
        self.solve("--report", self.folder / "report.md", "--figure", self.folder / "chart.png")
        ours = json.loads((self.folder / "out.json").read_text())
        text = (self.folder / "report.md").read_text()
        self.assertIn(f"| all 24 | {ours['dE_before']['mean']:.2f} | {ours['dE_before']['max']:.2f} "
                      f"| {ours['dE_after']['mean']:.2f} | {ours['dE_after']['max']:.2f} |", text)
        self.assertIn("| skin, 2 |", text)
        self.assertIn("(chart.png)", text)
        self.assertIn("Condition numbers", text)
        for patch in ours["patches"]:
            self.assertIn(f"| {patch['name']} | {patch['dE_before']:.2f} | {patch['dE_after']:.2f} |", text)
        self.figure()

    def figure(self):
        """The white patch's ground is white; the inner square of Q's chart is nearer to it than that of M alone."""
        from PIL import Image
        picture = np.asarray(Image.open(self.folder / "chart.png").convert("RGB")).astype(float)
        step, inner, chart = 70, 38, 4 * 70 + 12
        centre = lambda row, column, top: picture[top + 6 + row * step + inner, 6 + column * step + 32]
        edge = lambda row, column, top: picture[top + 6 + row * step + 4, 6 + column * step + 4]
        self.assertGreater(edge(3, 0, 0).min(), 245)
        orange = (1, 0)
        before = np.abs(centre(*orange, 0) - edge(*orange, 0)).max()
        after = np.abs(centre(*orange, chart) - edge(*orange, chart)).max()
        self.assertGreater(before, 20)
        self.assertLess(after, 0.6 * before)


if __name__ == "__main__":
    unittest.main()
