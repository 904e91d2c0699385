# SPDX-License-Identifier: Apache-2.0
"""Users' scenes that once failed: narrow lines, optical constants from files, broken meshes."""

import os
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
import OpenEXR

PROGRAM = Path(os.environ["METAMER_BIN"]) / "spectral_ref"
CASES = Path(__file__).parent / "cases"


class Cases(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def render(self, scene):
        output = self.folder / "a.exr"
        result = subprocess.run([PROGRAM, "render", scene, "-o", output, "--spp", "256"], capture_output=True, text=True,
                                timeout=60)
        self.assertEqual(result.returncode, 0, result.stderr)
        with OpenEXR.File(str(output)) as file:
            channels = file.channels()
            name = next(name for name in ("Y", "RGB", "RGBA") if name in channels) if "Y" in channels else None
            pixels = channels[name].pixels if name else next(iter(channels.values())).pixels
        return pixels[..., 1] if pixels.ndim == 3 else pixels

    def refused(self, scene, *says):
        result = subprocess.run([PROGRAM, "render", scene, "-o", self.folder / "a.exr"], capture_output=True, text=True,
                                timeout=60)
        self.assertGreater(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        for text in says:
            self.assertIn(text, result.stderr)

    def test_a_narrow_line_has_its_energy(self):
        narrow = self.render(CASES / "spike.yaml").mean()
        text = (CASES / "spike.yaml").read_text()
        wide_scene = self.folder / "wide.yaml"
        wide_scene.write_text(text.replace("[532.2, 532.5, 532.8]", "[522.5, 532.5, 542.5]").replace(
            "[0, 1000, 0]", "[0, 30, 0]"))
        wide = self.render(wide_scene).mean()
        # Noise of 256 samples a pixel; the wide line's own curvature is 1e-3.
        self.assertAlmostEqual(narrow / wide, 1, delta=0.03)
        self.assertAlmostEqual(narrow, 2.5, delta=0.2)

    def test_metals_from_files(self):
        inline = self.render(CASES / "cond_inline.yaml")
        np.testing.assert_array_equal(self.render(CASES / "cond_file.yaml"), inline)

    def test_broken_meshes(self):
        self.refused(CASES / "ply" / "neg.yaml", "neg.ply", "face 0 vertex index '-1'", "0 to 2")
        self.refused(CASES / "ply" / "noend.yaml", "noend.ply", "end_header")

    def test_siblings_of_broken_meshes(self):
        head = ("ply\nformat {form} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                "element face 1\nproperty list uchar int vertex_indices\nend_header\n")
        scene = self.folder / "scene.yaml"
        scene.write_text((CASES / "ply" / "neg.yaml").read_text().replace("neg.ply", "m.ply"))
        ascii_head = head.format(form="ascii")
        body = "0 0 0\n1 0 0\n0 1 0\n"
        little = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
        whole = (ascii_head + body + "3 0 1 2\n").encode()
        binary = head.format(form="binary_little_endian").encode() + little
        for data, says in (
            ((ascii_head + body + "3 0 1 3\n").encode(), "face 0 vertex index '3'"),
            ((ascii_head + body + "3 0 1\n").encode(), "cut short"),
            ((ascii_head + "0 0 0\n").encode(), "vertex 1"),
            (whole.replace(b"vertex 3", b"vertex 3000000000"), "cut short"),
            (binary + struct.pack("<B3i", 3, 0, 1, 7), "face 0 vertex index '7'"),
            (binary + struct.pack("<B2i", 3, 0, 1), "cut short"),
            (whole.replace(b"uchar int", b"uchar frog"), "property"),
            ((ascii_head + body + "0\n").encode(), "has no vertices"),
            (whole.replace(b"face 1", b"face 2") + b"0\n", "face 1 '0': has no vertices"),
            (binary + struct.pack("<B", 0), "has no vertices"),
            (whole.replace(b"uchar", b"int").replace(b"3 0 1 2", b"3000" + 1000 * b" 0 1 2"), "face 0 '3000'"),
            (whole.replace(b"3 0 1 2", b"2" + 96 * b"3" + b" 0 1 2"), "export triangles"),  # more than an integer holds
        ):
            (self.folder / "m.ply").write_bytes(data)
            self.refused(scene, "m.ply", says)
        for data in (whole, binary + struct.pack("<B3i", 3, 0, 1, 2)):
            (self.folder / "m.ply").write_bytes(data)
            self.render(scene)

    def test_broken_objs(self):
        scene = self.folder / "scene.yaml"
        scene.write_text((CASES / "ply" / "neg.yaml").read_text().replace("neg.ply", "m.obj"))
        mesh = self.folder / "m.obj"
        body = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n"
        for text, says in (
            (body + "f 1 2 4\n", ("m.obj:6", "face '4'", "3 'v'")),
            (body + "f 1/2 2/1 3/1\n", ("m.obj:6", "'vt'")),
            (body + "f 1//1 2//9 3//1\n", ("m.obj:6", "'vn'")),
            (body + "f -1 -2 -4\n", ("m.obj:6", "corner '-4'", "counts back")),
            (body + "f 0 1 2\n", ("m.obj:6", "corner '0'")),
            (body + "f 1 2 99999999999999999999\n", ("m.obj:6", "corner")),
            (body + "f 1 2 3/1/1/1\n", ("m.obj:6", "V/VT/VN")),
            (body + "f\n", ("m.obj:6", "no corner")),
            ("v 0 0\n", ("m.obj:1", "cut short")),
            ("v 0 0 zero\n", ("m.obj:1", "v 'zero'")),
            ("v 0 0 0\0\n", ("m.obj:1", "no text")),
            ("", ("m.obj",)),
            # What would take minutes: polygons of many corners, alone and together, and materials by the thousand.
            (body + "f" + " 1 2 3" * 1000 + "\n", ("m.obj:6", "face '3000'", "export triangles")),
            (body + ("f" + " 1 2 3" * 100 + "\n") * 50, ("m.obj:50", "face '300'", "export triangles")),
            (body + "".join(f"o o{i}\nusemtl m{i}\nf 1 2 3\n" for i in range(4000)), ("usemtl '3873'", "export fewer")),
        ):
            mesh.write_text(text)
            self.refused(scene, *says)
        # Faces before vertices, lines joined, materials that are devices: the triangle alone counts.
        mesh.write_text("mtllib /dev/zero\nf 1 2 \\\n 3\nusemtl x\n" + body)
        self.render(scene)
        os.mkfifo(self.folder / "m.mtl")
        mesh.write_text("mtllib m.mtl\nusemtl x\n" + body + "f -3 -2 -1\n")
        self.render(scene)
        mesh.unlink()
        os.mkfifo(mesh)
        self.refused(scene, "m.obj", "device, pipe")

    def test_pictures_that_are_pipes_or_declare_too_much(self):
        scene = self.folder / "scene.yaml"
        scene.write_text("metamer_scene: 1\nfilm: {width: 4, height: 4}\nshapes: []\nlights:\n"
                         "  - environment: {picture: pipe.exr}\n")
        os.mkfifo(self.folder / "pipe.exr")
        self.refused(scene, "pipe")
        os.mkfifo(self.folder / "a.exr.checkpoint")
        for arguments in (["merge", "pipe.exr", "pipe.exr", "-o", "a.exr"], ["measure", "pipe.exr"],
                          ["render", CASES / "spike.yaml", "-o", "a.exr", "--resume"]):
            result = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=60)
            self.assertEqual((result.returncode, result.stderr.count("\n")), (1, 1), result.stderr)


if __name__ == "__main__":
    unittest.main()
