# SPDX-License-Identifier: Apache-2.0
"""The ready-made looks: script/configs makes what configs/ says of them, every look and view of the config runs alike in
both OpenColorIO releases, and their checkers find nothing.

Of a few looks of each kind; METAMER_LONG=1 makes all of them.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import PyOpenColorIO as ocio

import run_config

ROOT = Path(__file__).resolve().parents[2]
CHECKED_IN = ROOT / "configs"
BIN = Path(os.environ["METAMER_BIN"])
LONG = os.environ.get("METAMER_LONG") == "1"
MADE = BIN.parent / ("configs" if LONG else "configs-sample")
LARGEST = 15_000_000

sys.path.insert(0, str(CHECKED_IN))
import looks  # noqa: E402
import make  # noqa: E402
import manifest  # noqa: E402
import page  # noqa: E402
import parts  # noqa: E402


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


VERSION = subprocess.run([BIN / "lutgen", "--version"], capture_output=True, text=True, check=True).stdout
# Certificates judge files by the linked release, whose processors differ in the last digits.
of_the_release = unittest.skipIf("OpenColorIO 2.1" in VERSION, "the manifest's figures are the newest release's")


class ReadyMade(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        command = [sys.executable, "-B", CHECKED_IN / "make.py", "--lutgen", BIN / "lutgen", "--out", MADE]
        cls.run_of_script = subprocess.run(command + ([] if LONG else ["--sample"]), capture_output=True, text=True)
        if not (MADE / "metamer.ocio").exists():
            raise AssertionError(cls.run_of_script.stderr)
        wanted = parts.of(looks.all_sets(), None, looks.TOLERANCE)
        cls.names = [name for part in wanted if LONG or part.name in make.SAMPLE for name in part.looks]

    @of_the_release
    def test_what_is_made_is_what_is_checked_in(self):
        """Files by their hash, figures of certificates, the config entry by entry."""
        self.assertEqual(self.run_of_script.returncode, 0, self.run_of_script.stdout + self.run_of_script.stderr)
        print(self.run_of_script.stdout)

    def test_manifest_and_config_hold_every_look(self):
        everyone = {name for one in looks.all_sets() for name in one.recipes}
        checked_in = manifest.read(make.MANIFEST)
        self.assertEqual(set(checked_in["looks"]), everyone)
        self.assertLessEqual({f"{name}.json" for name in everyone}, set(checked_in["files"]))
        config = ocio.Config.CreateFromFile(str(CHECKED_IN / "metamer.ocio"))
        self.assertEqual(set(config.getLookNames()), everyone)
        # Each table that the config names is in the manifest.
        _, entries = parts.split((CHECKED_IN / "metamer.ocio").read_text(encoding="utf-8"))
        tables = {word.strip("{},") for entry in entries["looks"] for word in entry.split() if word.strip("{},").endswith(".ctf")}
        self.assertEqual(tables, {name for name in checked_in["files"] if name.endswith(".ctf")})

    def test_page_shows_the_manifest(self):
        text = page.PAGE.read_text(encoding="utf-8")
        self.assertEqual(text, page.with_tables(text, manifest.read(make.MANIFEST)["looks"]), "script/configs --update")

    @of_the_release
    def test_a_change_is_noticed(self):
        checked_in, made = manifest.read(make.MANIFEST), manifest.of(MADE)
        self.assertEqual(manifest.differences(checked_in, made, whole=LONG), [])
        name = self.names[0]
        made["looks"][name]["p99"] += 1e-4
        made["files"][f"{name}.json"] = "0"
        found = manifest.differences(checked_in, made, whole=LONG)
        self.assertEqual([line.split(":")[0] for line in found], [name, f"{name}.json"])
        self.assertGreater(len(manifest.differences(checked_in, {"looks": {}, "files": {}}, whole=True)), len(self.names))

    def test_only_what_changed_is_made_again(self):
        store = parts.Store(MADE)
        wanted = [part for part in parts.of(looks.all_sets(), None, looks.TOLERANCE) if part.name in make.SAMPLE]
        engine = parts.engine_digest(BIN / "lutgen")
        for part in wanted:
            self.assertTrue(store.is_made(part, parts.key(part, engine)), part.name)
            self.assertFalse(store.is_made(part, parts.key(part, engine + "another")), part.name)
        one = wanted[0]
        name, text = next(iter(one.looks.items()))
        other = parts.Part(one.name, one.size, one.tolerance, one.looks | {name: text + "keep_exposure: true\n"})
        self.assertNotEqual(parts.key(one, engine), parts.key(other, engine))

    def test_a_fault_is_one_line(self):
        with tempfile.TemporaryDirectory() as folder:
            run = subprocess.run([sys.executable, "-B", CHECKED_IN / "make.py", "--sample", "--lutgen", "/nowhere/lutgen", "--out", folder],
                                 capture_output=True, text=True)
        self.assertEqual(run.returncode, 1)
        self.assertRegex(run.stderr, r"^script/configs: /nowhere/lutgen: no such program: .*\n$")

    def test_every_look_and_view_runs_alike(self):
        here = run_config.older(MADE / "metamer.ocio")
        there = run_config.newest(MADE / "metamer.ocio")
        self.assertEqual(here.keys(), there.keys())
        self.assertEqual({name for kind, name in here if kind == "look"}, set(self.names))
        self.assertEqual({name for kind, name in here if kind == "named transform"},
                         {f"{name} - Transform" for name in self.names})
        worst = 0.0
        for key, one in here.items():
            other = there[key]
            self.assertTrue(np.isfinite(one).all(), key)
            if key[0] == "view":
                # PQ of a negative is mirrored by later releases and clipped by earlier ones.
                one, other = np.maximum(one, 0), np.maximum(other, 0)
            size = np.abs(one).max(axis=1, keepdims=True)
            worst = max(worst, float((np.abs(one - other) / size).max()))
        print(f"{len(here)} looks, named transforms and views: releases differ by {worst:.1e} of the largest channel")
        # Single precision through the chain (1e-5) and through the views' tone curves.
        self.assertLess(worst, 2e-4)

    def test_neutrals_stay_neutral_with_the_eye_adapted(self):
        results = run_config.newest(MADE / "metamer.ocio")
        worst = 0.0
        for name in self.names:
            if name.endswith("_100") or "_as_" in name:
                grey = results["look", name][0]
                worst = max(worst, float(np.ptp(grey) / grey.mean()))
        print(f"neutrals: channels differ by {worst:.1e}")
        self.assertLess(worst, 1e-4)

    def check(self, folder):
        """ociocheck and ociochecklut of a folder over all that was made."""
        check = subprocess.run([folder / "ociocheck", "--iconfig", MADE / "metamer.ocio"], capture_output=True, text=True,
                               timeout=600)
        said = check.stdout + check.stderr
        self.assertEqual(check.returncode, 0, said)
        for word in ("ERROR", "Error", "WARNING", "Warning", "failed", "NOT DEFINED"):
            self.assertNotIn(word, said)
        self.assertIn("Tests complete.", said)
        luts = sorted((MADE / "luts").glob("*.ctf"))
        for lut in luts:
            run = subprocess.run([folder / "ociochecklut", lut, "0.18", "0.18", "0.18"], capture_output=True, text=True, timeout=60)
            self.assertEqual(run.returncode, 0, f"{lut.name}: {run.stdout}{run.stderr}")
            for word in ("ERROR", "WARNING", "Warning"):
                self.assertNotIn(word, run.stdout + run.stderr)
            values = [float(x.strip("[],")) for x in run.stdout.split()[-3:]]
            self.assertTrue(np.isfinite(values).all())
        print(f"{folder}: ociocheck clean, ociochecklut clean over {len(luts)} files")

    def test_checkers_find_nothing(self):
        program = shutil.which("ociocheck", path="/usr/bin:/usr/local/bin")
        if program is None:
            self.skipTest("ociocheck is not installed (Debian: opencolorio-tools)")
        self.check(Path(program).parent)

    def test_checkers_of_the_newest_release_find_nothing(self):
        # The wheel carries them as console scripts, from 2.5 on.
        self.check(Path(sys.executable).parent)
        config = ocio.Config.CreateFromFile(str(MADE / "metamer.ocio"))
        for role in ("scene_linear", "compositing_log", "color_timing", "data", "aces_interchange",
                     "cie_xyz_d65_interchange", "rendering", "reference", "default", "color_picking", "texture_paint", "matte_paint"):
            self.assertTrue(config.hasRole(role), role)

    def test_certificates_say_what_they_are_of(self):
        for name in self.names:
            certificate = json.loads((MADE / "luts" / f"{name}.json").read_text())
            self.assertEqual(certificate["recipe"]["name"], name)
            self.assertGreaterEqual(certificate["error"]["max"], certificate["error"]["p99"])

    def test_size_of_the_folder(self):
        files = [path for path in MADE.rglob("*") if path.is_file() and ".parts" not in path.parts]
        self.assertLess(sum(path.stat().st_size for path in files), LARGEST)
        self.assertEqual([path for path in files if "partial" in path.name], [])

    def test_recipes_are_those_of_the_script(self):
        with tempfile.TemporaryDirectory() as folder:
            looks.write_recipes(Path(folder), looks.all_sets())
            self.assertEqual(contents(Path(folder)), contents(CHECKED_IN / "recipes"))


if __name__ == "__main__":
    unittest.main()
