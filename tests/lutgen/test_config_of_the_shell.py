# SPDX-License-Identifier: Apache-2.0
"""$OCIO and the configs and files of the newest OpenColorIO: opened where they are asked for, and only there."""

import json
import os
import shutil
import unittest
from pathlib import Path

import numpy as np
import PyOpenColorIO as ocio

from lutgen import LINKED, LutgenTest
from test_pictures import RECIPE, ramp, read, write

FILES = Path(__file__).with_name("files")
# The quickest: which configs are opened depends neither on the scene nor on the size.
DAY_TO_TUNGSTEN = ["--illuminant-in", "D65", "--illuminant-out", "A", "--scene", "smooth", "--size", "9"]
STUDIO = "studio-config-latest"


class ConfigOfTheShell(LutgenTest):
    def setUp(self):
        super().setUp()
        (self.folder / "r.yaml").write_text(RECIPE + "scene: {kind: smooth}\n")
        pixels = ramp()
        write(self.folder / "in.exr", {name: pixels[..., k].copy() for k, name in enumerate("RGB")})
        (self.folder / "studio.ocio").write_text(ocio.Config.CreateFromBuiltinConfig(STUDIO).serialize())

    def of_the_shell(self):
        """$OCIO as people have it: a name of OCIO's own, a config of the newest profile, a path that is stale."""
        return ("ocio://default", str(self.folder / "studio.ocio"), "/nonexistent/studio/config.ocio")

    def test_built_in_spaces_do_not_ask_for_it(self):
        self.assertWorks("bake", *DAY_TO_TUNGSTEN, "-o", "none.cube")
        self.assertWorks("apply", "--quiet", "r.yaml", "in.exr", "none.exr")
        without = (self.folder / "none.cube").read_bytes(), read(self.folder / "none.exr")[0]
        for value in self.of_the_shell():
            with self.subTest(OCIO=value):
                shell = {"OCIO": value}
                self.assertWorks("bake", *DAY_TO_TUNGSTEN, "-o", "q.cube", environment=shell)
                self.assertEqual((self.folder / "q.cube").read_bytes(), without[0])
                self.assertWorks("apply", "--quiet", "r.yaml", "in.exr", "out.exr", environment=shell)
                for name, channel in read(self.folder / "out.exr")[0].items():
                    np.testing.assert_array_equal(channel, without[1][name])
                said = self.assertWorks("compare", "r.yaml", "r.yaml", "--tolerance", "0.01", environment=shell)
                self.assertIn("p99", said)
                self.assertWorks("compare", "in.exr", "in.exr", "--tolerance", "0", environment=shell)
                self.assertWorks("config", "r.yaml", "-o", "new.ocio", "--size", "9", environment=shell)
                self.assertWorks("list", "spaces", environment=shell)

    def test_a_fault_is_said_where_a_space_is_asked_for(self):
        stale = self.of_the_shell()[-1]
        says = ["$OCIO", stale, "there is no such file", "lutgen list spaces"]
        self.assertFails("bake", *DAY_TO_TUNGSTEN, "--space", "studio linear", "-o", "a.ctf", environment={"OCIO": stale},
                         says=says)
        self.assertFails("apply", "r.yaml", "in.exr", "out.exr", "--space", "studio linear", environment={"OCIO": stale},
                         says=says)
        self.assertFails("compare", "in.exr", "in.exr", "--space", "studio linear", environment={"OCIO": stale}, says=says)

    @unittest.skipIf(LINKED < (2, 5), "the linked OpenColorIO does not know these configs")
    def test_spaces_of_todays_configs(self):
        """A space of theirs, linear, against the same recipe in the engine's own space, brought there by OCIO."""
        space = "Linear P3-D65"
        config = ocio.Config.CreateFromFile("ocio://studio-config-latest")
        pixels = ramp()
        for name in ("ocio://studio-config-latest", str(self.folder / "studio.ocio")):
            with self.subTest(OCIO=name):
                self.assertWorks("apply", "--quiet", "r.yaml", "in.exr", "out.exr", "--space", space, environment={"OCIO": name})
                ours = np.stack([read(self.folder / "out.exr")[0][c] for c in "RGB"], axis=-1)
                there = pixels.copy()
                config.getProcessor(space, "ACES2065-1").getDefaultCPUProcessor().applyRGB(there)
                write(self.folder / "ap0.exr", {c: there[..., k].copy() for k, c in enumerate("RGB")})
                self.assertWorks("apply", "--quiet", "r.yaml", "ap0.exr", "relit.exr", "--space", "ACES2065-1")
                back = np.stack([read(self.folder / "relit.exr")[0][c] for c in "RGB"], axis=-1).copy()
                config.getProcessor("ACES2065-1", space).getDefaultCPUProcessor().applyRGB(back)
                np.testing.assert_allclose(ours, back, rtol=1e-5, atol=1e-6)
                self.assertWorks("bake", *DAY_TO_TUNGSTEN, "--space", space, "-o", "s.ctf", environment={"OCIO": name})
                self.assertWorks("bake", *DAY_TO_TUNGSTEN, "--space", space, "--iconfig", name, "-o", "i.ctf")
                self.assertEqual((self.folder / "s.ctf").read_bytes(), (self.folder / "i.ctf").read_bytes())

    @unittest.skipIf(LINKED < (2, 5), "the linked OpenColorIO does not know these configs")
    def test_looks_of_todays_configs(self):
        look = "ACES 1.3 Reference Gamut Compression"
        for name in ("ocio://studio-config-latest", "studio.ocio"):
            said = self.assertWorks("compare", f"{name}:{look}", f"studio.ocio:{look}", "--tolerance", "0.001")
            self.assertIn("look", said)
        self.assertFails("compare", "ocio://studio-config-latest:nothing", "r.yaml", says=["nothing", "look"])

    @unittest.skipIf(LINKED < (2, 5), "the linked OpenColorIO does not know these configs")
    def test_a_built_in_config_as_base(self):
        self.assertWorks("config", "r.yaml", "-o", "show.ocio", "--base", "ocio://studio-config-latest", "--size", "9")
        config = ocio.Config.CreateFromFile(str(self.folder / "show.ocio"))
        config.validate()
        self.assertIn("Linear P3-D65", config.getColorSpaceNames())
        self.assertEqual(len(config.getLookNames()), len(ocio.Config.CreateFromBuiltinConfig(STUDIO).getLookNames()) + 1)
        self.assertFails("config", "r.yaml", "-o", "b.ocio", "--base", "ocio://nothing", says=["ocio://nothing"])

    @unittest.skipIf(LINKED < (2, 6), "files of later releases")
    def test_files_of_todays_programs(self):
        """SMPTE ST 2136, and a collection of corrections without the name of one: as the newest OCIO reads them."""
        pixels = ramp()
        for name in ("smpte.clf", "two.ccc"):
            with self.subTest(name):
                shutil.copy(FILES / name, self.folder / name)
                self.assertWorks("apply", "--quiet", name, "in.exr", "out.exr")
                ours = np.stack([read(self.folder / "out.exr")[0][c] for c in "RGB"], axis=-1)
                # The first channel is doubled, in the first correction of the collection too.
                np.testing.assert_allclose(ours, pixels * np.float32([2, 1, 1]), rtol=1e-6)

    def test_what_is_written_stays_what_older_releases_read(self):
        """No version in a file or config rises with the OpenColorIO that writes it."""
        self.assertWorks("bake", *DAY_TO_TUNGSTEN, "-o", "a.ctf")
        self.assertIn('<ProcessList version="2"', (self.folder / "a.ctf").read_text()[:200])
        self.assertWorks("bake", *DAY_TO_TUNGSTEN, "-o", "a.clf")
        self.assertIn('compCLFversion="3"', (self.folder / "a.clf").read_text()[:200])
        self.assertWorks("config", "r.yaml", "-o", "new.ocio", "--size", "9")
        self.assertTrue((self.folder / "new.ocio").read_text().startswith("ocio_profile_version: 2.1\n"))


class Library(LutgenTest):
    def test_another_release_in_the_way_is_not_taken(self):
        """A shell whose LD_LIBRARY_PATH leads to a libOpenColorIO.so of another release."""
        others = sorted(Path("/usr/lib").glob("*/libOpenColorIO.so"))
        if not others:
            self.skipTest("no other OpenColorIO is installed")
        shell = {"LD_LIBRARY_PATH": os.pathsep.join(str(one.parent) for one in others)}
        self.assertWorks("bake", *DAY_TO_TUNGSTEN, "-o", "a.cube", environment=shell)
        self.assertEqual(json.loads((self.folder / "a.cube.json").read_text())["transform"]["format"], "iridas_cube")


if __name__ == "__main__":
    unittest.main()
