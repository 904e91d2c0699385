# SPDX-License-Identifier: Apache-2.0
"""lutgen validate: renders under both lights judge a recipe's transform."""

import json
import tempfile
import unittest
from pathlib import Path

from lutgen import LutgenTest, lutgen

RECIPE = "metamer: 1\nspace: ACEScg\ninput: {illuminant: D65}\noutput: {illuminant: A}\n"
FEW = ("--replicates", "3", "--samples", "4")
HELD = ("--tolerance", "0.1")


class Validate(LutgenTest):
    def setUp(self):
        super().setUp()
        (self.folder / "r.yaml").write_text(RECIPE)

    @classmethod
    def setUpClass(cls):
        """What several cases look at: rendered once."""
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "r.yaml").write_text(RECIPE)
            run = lutgen("validate", "r.yaml", "--json", "r.json", *FEW, *HELD, "--threads", "2", folder=folder)
            if (run.returncode, run.stderr) != (0, ""):
                raise AssertionError(run.stderr)
            cls.table, cls.shared = run.stdout, json.loads((Path(folder) / "r.json").read_text())

    def test_what_remains_has_its_name(self):
        report, table = self.shared, self.table
        scenes = {scene["name"]: scene for scene in report["scenes"]}
        self.assertEqual(list(scenes), ["smooth objects", "chart", "skin and leaves", "box"])
        for name, scene in scenes.items():
            self.assertIn(f"{name:18}{scene['total']:7.3f}", table)
            # Direct light: the engine errs by metamerism alone, but for noise.
            if name != "box":
                self.assertLess(abs(scene["engine"] - scene["metamerism"]), scene["noise"], name)
            self.assertLess(scene["representation"], 0.05, name)
        self.assertLess(scenes["smooth objects"]["metamerism"], 0.001)
        # The natural scene knows the chart's own patches, and still smooths between them.
        self.assertGreater(scenes["chart"]["metamerism"], 0.3)
        # Light from wall to wall changes what is left, up or down.
        self.assertGreater(abs(scenes["box"]["interreflection"]), 0.05)
        self.assertLess(report["led_wall"]["corrected"], 0.7 * report["led_wall"]["driven_only"])

    def test_threads_change_no_bit(self):
        self.assertWorks("validate", "r.yaml", "--json", "r.json", *FEW, *HELD, "--threads", "1")
        self.assertEqual(json.loads((self.folder / "r.json").read_text()), self.shared)

    def test_another_seed_beyond_the_tolerance(self):
        run = lutgen("validate", "r.yaml", "--json", "r.json", *FEW, "--seed", "9", "--tolerance", "0", folder=self.folder)
        self.assertEqual(run.returncode, 3)
        self.assertIn("more than the tolerance 0", run.stdout)
        self.assertNotEqual(json.loads((self.folder / "r.json").read_text())["scenes"], self.shared["scenes"])

    def test_bad_input(self):
        self.assertFails("validate", "no.yaml", says=["no.yaml"])
        self.assertFails("validate", "r.yaml", "--replicates", "2", code=2, says=["--replicates"])

    def test_a_place_that_cannot_be_written_is_told_before_anything_is_rendered(self):
        run = lutgen("validate", "r.yaml", *FEW, "--json", "no/r.json", folder=self.folder)
        self.assertEqual((run.returncode, run.stderr.count("\n"), run.stdout), (1, 1, ""), run.stderr)
        self.assertIn("no/r.json", run.stderr)


if __name__ == "__main__":
    unittest.main()
