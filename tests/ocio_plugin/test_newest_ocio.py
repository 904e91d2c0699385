# SPDX-License-Identifier: Apache-2.0
"""What lutgen writes, read by the newest OpenColorIO and by an older one, the system's."""

import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
import PyOpenColorIO as ocio

from ocio_releases import BIN, older, newest

PAIRS = [("D65", "A"), ("D65", "HP1"), ("D65", "FL11"), ("D65", "LED-RGB1"), ("A", "D65"), ("FL11", "D50")]
STOPS = range(-20, 21, 4)


def bake(folder, name, *arguments):
    file = Path(folder) / name
    subprocess.run([BIN / "lutgen", "bake", "-o", file, *arguments], check=True)
    return file


def colours(count, seed=3):
    """Positive colours of every hue and saturation, alpha 1."""
    random = np.random.default_rng(seed)
    pixels = np.ones((count, 4), np.float32)
    pixels[:, :3] = random.random((count, 3)) ** 2 + 1e-3
    return pixels


class NewestOcio(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def test_chains_agree_over_forty_stops(self):
        for pair in PAIRS:
            # The first as large as it comes, the others of half as many nodes, which take an eighth of the time.
            size = [] if pair == PAIRS[0] else ["--size", "33"]
            # A name of its own: OCIO keeps what it has read by name.
            file = bake(self.folder.name, f"{pair[0]}_{pair[1]}.ctf", "--illuminant-in", pair[0], "--illuminant-out", pair[1], *size)
            # All exposures at once: each reader takes the file in once.
            pixels = np.tile(colours(4000), (len(STOPS), 1))
            pixels[:, :3] *= np.repeat(2.0 ** np.array(STOPS), 4000)[:, None]
            a, b = older(file, pixels), newest(file, pixels)
            size = np.abs(a[:, :3]).max(axis=1, keepdims=True)
            worst = float((np.abs(a - b)[:, :3] / size).max())
            print(f"{pair[0]} -> {pair[1]}: releases differ by {worst:.2e}")
            # The chain looks up a logarithm as a float over 115 stops: one unit in its last place is 5e-6 of the light,
            # and the table's slopes and the way back from wide channels make up to ten times that of it.
            self.assertLess(worst, 1e-4)

    def test_every_format_reads_alike(self):
        for name, options in [("a.clf", []), ("a.cube", []), ("b.cube", ["--format", "resolve_cube"])]:
            file = bake(self.folder.name, name, "--illuminant-in", "D65", "--illuminant-out", "HP1", *options)
            pixels = colours(4000)
            a, b = older(file, pixels), newest(file, pixels)
            # A unit in the last place of the log signal, 6e-8, is a millionth of the light.
            np.testing.assert_allclose(a, b, rtol=2e-5, atol=2e-6, err_msg=name)

    def test_identity_is_a_no_op(self):
        for name in ("a.ctf", "a.clf"):
            file = bake(self.folder.name, name, "--illuminant-in", "D65", "--illuminant-out", "D65")
            processor = ocio.Config.CreateRaw().getProcessor(ocio.FileTransform(src=str(file)))
            self.assertTrue(processor.isNoOp(), name)

    def test_gpu_shader_is_written(self):
        file = bake(self.folder.name, "a.ctf", "--illuminant-in", "D65", "--illuminant-out", "A")
        processor = ocio.Config.CreateRaw().getProcessor(ocio.FileTransform(src=str(file)))
        shader = ocio.GpuShaderDesc.CreateShaderDesc(language=ocio.GPU_LANGUAGE_GLSL_4_0)
        processor.getDefaultGPUProcessor().extractGpuShaderInfo(shader)
        self.assertIn("OCIOMain", shader.getShaderText())


if __name__ == "__main__":
    unittest.main()
