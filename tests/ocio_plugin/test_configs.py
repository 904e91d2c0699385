# SPDX-License-Identifier: Apache-2.0
"""What lutgen config writes, loaded and run by the newest OpenColorIO and by an older one, the system's."""

import difflib
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
import PyOpenColorIO as ocio

import run_config

BIN = Path(os.environ["METAMER_BIN"])
RECIPES = {
    "day_to_sodium_0": "input: {illuminant: D65}\noutput: {illuminant: HP1, adaptation: 0}",
    "day_to_sodium_1": "input: {illuminant: D65}\noutput: {illuminant: HP1, adaptation: 1}",
    "awg4_to_a": "space: ARRI LogC4\ninput: {illuminant: D65}\noutput: {illuminant: A, adaptation: 1}",
    "nothing": "input: {illuminant: D65}\noutput: {illuminant: D65}",
}
LOG_RECIPE = "awg4_to_a"
# What is tested here depends neither on the tables' size nor on the scene.
SIZE, SCENE = "9", "scene: {kind: smooth}"


def lutgen(*arguments):
    return subprocess.run([BIN / "lutgen", *map(str, arguments)], capture_output=True, text=True, timeout=600)


def recipes_in(folder):
    files = []
    for name, text in RECIPES.items():
        files.append(folder / f"{name}.yaml")
        files[-1].write_text(f"metamer: 1\nname: {name}\n{text}\n{SCENE}\n")
    return files


def write(folder, name, *arguments):
    """A config of all recipes."""
    run = lutgen("config", "-o", folder / name, "--size", SIZE, *arguments, *recipes_in(folder))
    if run.returncode != 0:
        raise AssertionError(run.stderr)
    return folder / name


class Configs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """The new config that several cases read: written once."""
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.new = write(Path(temporary.name), "new.ocio")

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def built_in(self, name):
        """A config of the newest release, as a file."""
        file = self.folder / f"{name}.ocio"
        file.write_text(ocio.Config.CreateFromBuiltinConfig(name).serialize())
        return file

    def assert_alike(self, a, b):
        """Results of two releases: single precision and its pile-up through tone curves, 1e-4 of the signal."""
        self.assertEqual(a.keys(), b.keys())
        for kind, name in a:
            if kind == "named transform" and name.removesuffix(" - Transform") not in RECIPES:
                continue  # the base's own
            one, other = a[kind, name], b[kind, name]
            self.assertTrue(np.isfinite(one).all(), name)
            if kind == "view":
                # PQ of a negative is mirrored by later releases and clipped by earlier ones.
                one, other = np.maximum(one, 0), np.maximum(other, 0)
            if name.startswith(LOG_RECIPE):
                # A signal above 1 stands for more than 469 times white there, and for what is beyond any precision.
                held = (run_config.PROBES <= 1).all(axis=1)
                one, other = one[held], other[held]
            np.testing.assert_allclose(one, other, rtol=2e-4, atol=2e-5, err_msg=f"{kind} {name}")

    def test_new_config_runs_alike_in_both_releases(self):
        file = self.new
        here, there = run_config.older(file), run_config.newest(file)
        self.assert_alike(here, there)
        self.assertEqual(sum(kind == "look" for kind, _ in here), len(RECIPES))
        self.assertEqual(sum(kind == "named transform" for kind, _ in here), len(RECIPES))
        self.assertGreater(sum(kind == "view" for kind, _ in here), 20)
        self.assertIn("ocio_profile_version: 2.1\n", file.read_text())
        # A light that is the same does nothing; sodium does.
        np.testing.assert_allclose(here["look", "nothing"], run_config.PROBES, rtol=1e-6)
        self.assertGreater(np.abs(here["look", "day_to_sodium_0"] - run_config.PROBES).max(), 0.1)
        # With the eye adapted, neutrals stay neutral (the chain's own precision).
        np.testing.assert_allclose(here["look", "day_to_sodium_1"][0], run_config.PROBES[0], rtol=2e-4)

    def test_spaces_are_those_of_the_studio_config(self):
        """Colour spaces of a new config against the newest studio config's of the same names, to ACES2065-1."""
        ours = ocio.Config.CreateFromFile(str(self.new))
        theirs = ocio.Config.CreateFromBuiltinConfig("studio-config-v2.2.0_aces-v1.3_ocio-v2.4")
        ramp = np.random.default_rng(1).random((256, 3)).astype(np.float32) * 0.9 + 0.05
        compared = 0
        for name in ours.getColorSpaceNames():
            if theirs.getColorSpace(name) is None or ours.getColorSpace(name).isData():
                continue
            if ours.getColorSpace(name).getReferenceSpaceType() != ocio.REFERENCE_SPACE_SCENE:
                continue
            results = []
            for config in (ours, theirs):
                pixels = ramp.copy()
                config.getProcessor(name, "aces_interchange").getDefaultCPUProcessor().applyRGB(pixels)
                results.append(pixels)
            # The studio config's matrices are printed to 15 digits; the curves are those of test OcioBuiltinsTest.
            np.testing.assert_allclose(results[0], results[1], rtol=3e-5, atol=1e-5, err_msg=name)
            compared += 1
        self.assertGreaterEqual(compared, 20)

    def test_built_in_configs_are_kept_byte_for_byte(self):
        newest = {"cg": "", "studio": ""}
        for name in sorted(entry[0] for entry in ocio.BuiltinConfigRegistry().getBuiltinConfigs()):
            newest[name.split("-")[0]] = name
        new = run_config.newest(self.new)
        for name in [*newest.values(), "studio-config-v1.0.0_aces-v1.3_ocio-v2.1"]:
            with self.subTest(name):
                base = self.built_in(name)
                file = write(self.folder, f"{name}_added.ocio", "--base", base)
                # Every line of the base is there, in its order; one, the search path, is changed, none is lost.
                before, after = base.read_text().splitlines(), file.read_text().splitlines()
                changes = [line for line in difflib.unified_diff(before, after, n=0, lineterm="")][2:]
                removed = [line[1:] for line in changes if line.startswith("-")]
                self.assertEqual(removed, ['search_path: ""'])
                added = [line[1:] for line in changes if line.startswith("+")]
                self.assertEqual(added[0], "search_path: luts")
                self.assertEqual(sum(line.strip() == "- !<Look>" for line in added), len(RECIPES))
                self.assertEqual(sum(line.strip() == "- !<NamedTransform>" for line in added), len(RECIPES))
                # What the base does, it does still, to the last bit.
                was, now = run_config.newest(base), run_config.newest(file)
                for key in was:
                    np.testing.assert_array_equal(was[key], now[key], err_msg=str(key))
                self.assertEqual(len(now), len(was) + 2 * len(RECIPES))
                # And the looks do what they do in a new config.
                for look in RECIPES:
                    np.testing.assert_allclose(now["look", look], new["look", look], rtol=1e-4, atol=1e-6)
                if name.endswith("ocio-v2.1"):
                    self.assert_alike(run_config.older(file), now)

    def test_a_base_upgraded_from_version_1(self):
        """A legacy config is refused; brought to version 2 by OCIO itself, it is taken."""
        legacy = ocio.Config()
        legacy.setMajorVersion(1)
        legacy.addColorSpace(ocio.ColorSpace(name="lin", family="linear"))
        log = ocio.ColorSpace(name="log", family="log")
        log.setTransform(ocio.AllocationTransform(ocio.ALLOCATION_LG2, [-8, 5]), ocio.COLORSPACE_DIR_FROM_REFERENCE)
        legacy.addColorSpace(log)
        legacy.setRole("default", "lin")
        legacy.setRole("scene_linear", "lin")
        legacy.addDisplayView("sRGB", "Log", "log", "")
        base = self.folder / "legacy.ocio"
        base.write_text(legacy.serialize())
        run = lutgen("config", "-o", self.folder / "out.ocio", "--base", base, *recipes_in(self.folder))
        self.assertEqual(run.returncode, 1)
        self.assertIn("upgradeToLatestVersion", run.stderr)
        self.assertFalse((self.folder / "out.ocio").exists())
        self.assertFalse((self.folder / "luts").exists())

        upgraded = ocio.Config.CreateFromFile(str(base))
        upgraded.upgradeToLatestVersion()
        upgraded.setVersion(2, 1)
        upgraded.setRole("aces_interchange", "lin")
        base.write_text(upgraded.serialize())
        file = write(self.folder, "out.ocio", "--base", base)
        self.assert_alike(run_config.older(file), run_config.newest(file))
        self.assertIn("process_space: lin\n", file.read_text())


if __name__ == "__main__":
    unittest.main()
