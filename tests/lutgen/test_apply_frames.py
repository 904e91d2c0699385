# SPDX-License-Identifier: Apache-2.0
"""lutgen apply on frames."""

import unittest

import numpy as np
import OpenEXR

from lutgen import LutgenTest, lutgen

RECIPE = "metamer: 1\nscene: {kind: smooth}\ninput: {illuminant: D65}\noutput: {illuminant: A}\n"


class Frames(LutgenTest):
    def setUp(self):
        super().setUp()
        (self.folder / "look.yaml").write_text(RECIPE)
        random = np.random.default_rng(2)
        for frame in range(1001, 1007):
            pixels = random.random((5, 7, 3)).astype(np.float16)
            OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, {"RGB": pixels}).write(
                str(self.folder / f"shot.{frame}.exr"))

    def written(self, *arguments):
        before = set(self.folder.iterdir())
        self.assertWorks("apply", "--quiet", "look.yaml", *arguments)
        return sorted(path.name for path in set(self.folder.iterdir()) - before)

    def test_every_way_to_say_which(self):
        for k, (arguments, frames) in enumerate((
            (["shot.####.exr", "{}.####.exr"], range(1001, 1007)),
            (["shot.%04d.exr", "{}.%04d.exr", "--frames", "1002-1004"], (1002, 1003, 1004)),
            (["shot.####.exr", "1001-1006x2", "{}.#.exr"], (1001, 1003, 1005)),
            (["shot.$F4.exr", "{}.#####.exr", "1001,1005-1006"], (1001, 1005, 1006)),
        )):
            with self.subTest(arguments):
                names = self.written(*(a.format(f"o{k}") for a in arguments))
                digits = 5 if "#####" in arguments[1] else 4
                self.assertEqual(names, [f"o{k}.{frame:0{digits}d}.exr" for frame in frames])
        # Each is its own frame, and the same as by itself.
        self.assertEqual(self.written("shot.1003.exr", "alone.exr"), ["alone.exr"])
        alone = (self.folder / "alone.exr").read_bytes()
        self.assertEqual((self.folder / "o0.1003.exr").read_bytes(), alone)
        self.assertNotEqual((self.folder / "o0.1004.exr").read_bytes(), alone)

    def test_threads_do_not_matter(self):
        for threads in (1, 4):
            self.written("shot.####.exr", f"t{threads}.####.exr", "--threads", threads, "--engine", "map")
        for frame in range(1001, 1007):
            self.assertEqual((self.folder / f"t1.{frame}.exr").read_bytes(), (self.folder / f"t4.{frame}.exr").read_bytes())

    def test_missing_frames_are_named_before_any_work(self):
        (self.folder / "shot.1003.exr").unlink()
        self.assertFails("apply", "look.yaml", "shot.####.exr", "out.####.exr", "--frames", "1001-1010",
                         says=["shot.####.exr", "1003, 1007-1010", "5 of 10"])
        self.assertFails("apply", "look.yaml", "none.####.exr", "out.####.exr", says=["none.####.exr", "--frames"])

    def test_a_fault_on_the_way(self):
        (self.folder / "shot.1004.exr").write_bytes(b"\x76\x2f\x31\x01")
        run = lutgen("apply", "--quiet", "look.yaml", "shot.####.exr", "out.####.exr", "--threads", 1, folder=self.folder)
        self.assertEqual(run.returncode, 1)
        self.assertIn("shot.1004.exr", run.stderr)
        self.assertEqual(run.stderr.count("\n"), 1)
        # What is done is done, whole; nothing is half-written.
        self.assertEqual(sorted(p.name for p in self.folder.glob("out.*")), [f"out.{f}.exr" for f in (1001, 1002, 1003)])

    def test_lines_for_logs_and_a_summary(self):
        run = lutgen("apply", "look.yaml", "shot.####.exr", "out.####.exr", "--picture-space", "ACEScg", folder=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        lines = run.stderr.splitlines()
        self.assertEqual(len(lines), 6)
        self.assertEqual(sorted(line.split()[2] for line in lines), [str(frame) for frame in range(1001, 1007)])
        self.assertIn("6 of 6", lines[-1])
        self.assertRegex(run.stdout, r"^out\.####\.exr: 6 frames, exact engine, ACEScg, \d+\.\d s\n$")

    def test_what_makes_no_sense(self):
        for arguments, says, code in (
            (["shot.####.exr", "out.exr"], "out.####.exr", 1),
            (["shot.1001.exr", "out.####.exr", "--frames", "1-2"], "shot.####.exr", 1),
            (["shot.####.exr", "out.####.exr", "--frames", "9-1"], "rise", 1),
            (["shot.####.exr", "out.####.exr", "--frames", "all"], "1001-1100", 1),
            (["shot.####.exr", "out.####.exr", "--frames", "1-2000000000"], "million", 1),
            (["shot.####.exr", "no/such/out.####.exr"], "folder", 1),
            (["shot.####.exr", "1001-1002", "out.####.exr", "--frames", "1001"], "twice", 2),
            (["shot.####.exr", "out.####.exr", "other.exr"], "other.exr", 2),
        ):
            with self.subTest(arguments):
                self.assertFails("apply", "look.yaml", *arguments, says=[says], code=code)


if __name__ == "__main__":
    unittest.main()
