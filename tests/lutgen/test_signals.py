# SPDX-License-Identifier: Apache-2.0
"""Signals at any time, for every command that takes its time.

SIGINT and SIGTERM leave nothing behind, or files that are complete where they came when the work was done, and say
which; SIGKILL leaves the old file whole. METAMER_SIGNALS sets how many of them each command gets: see script/signals.
"""

import os
import random
import re
import signal
import subprocess
import time
import unittest

import numpy as np
import OpenEXR

from lutgen import LUTGEN, LutgenTest, lutgen
from stage_physics import Stage

RECIPE = """metamer: 1
name: evening
input: {illuminant: D65}
output: {illuminant: A}
scene: {kind: smooth}
"""
RGBW = ["led:628:14", "led:525:24", "led:460:16", "phosphor:450:20:560:120:0.8"]
TIME = re.compile(rb"\d{4}:\d\d:\d\d \d\d:\d\d:\d\d")
LONG = os.environ.get("METAMER_LONG") == "1"
ROUNDS = int(os.environ.get("METAMER_SIGNALS", "50" if LONG else "1"))


class Signals(LutgenTest):
    def setUp(self):
        super().setUp()
        (self.folder / "r.yaml").write_text(RECIPE)
        (self.folder / "s.yaml").write_text(RECIPE.replace("evening", "night").replace("illuminant: A", "illuminant: HP1"))
        self.assertWorks("bake", "r.yaml", "-o", "old.ctf", "--size", "5")
        pixels = np.random.default_rng(1).random((200, 300, 3)).astype(np.float16)
        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        for frame in range(1, 5):
            OpenEXR.File(dict(header), {"RGB": pixels}).write(str(self.folder / f"in.{frame:04d}.exr"))
        OpenEXR.File(dict(header), {"RGB": pixels[:150]}).write(str(self.folder / "place.exr"))
        Stage("FL2").write(self.folder)
        self.commands = {
            "bake": ["bake", "r.yaml", "-o", "a.ctf", "--size", "17"],
            "config": ["config", "r.yaml", "s.yaml", "-o", "c.ocio", "--size", "9"],
            "compare": ["compare", "r.yaml", "old.ctf", "--json", "a.json", "--junit", "a.xml", "--plot", "a.png"],
            "apply": ["apply", "r.yaml", "in.####.exr", "out.####.exr"],
            "apply one": ["apply", "old.ctf", "in.0001.exr", "one.exr"],
            "validate": ["validate", "r.yaml", "--json", "v.json", "--replicates", "3", "--samples", "1", "--tolerance", "9"],
            "skin": ["skin", "sample", "-o", "skins.csv", "--chart", "skins.exr", "--count", "500"],
            "uplift": ["uplift", "in.0001.exr", "-o", "u.exr", "--method", "mallett", "--picture-space", "Rec.709"],
            "solve": ["stage", "solve", "stage.yaml", "-o", "solved.json", "--report", "solved.md", "--luts", "wall", "--config",
                      "wall.ocio", "--figure", "chart.png", "--samples", "5000"],
            "match": ["stage", "match", "--target", "t.csv", "--charts", "r.csv", "g.csv", "b.csv", "--weights", "perceptual",
                      "--samples", "50", "--json", "m.json", "--report", "m.md"],
            "select": ["stage", "select", "--targets", "A", "D65", "--emitters", *RGBW, "--json", "select.json"],
        }
        if LONG:
            self.add_the_others()

    def add_the_others(self):
        """Commands that ctest leaves to script/signals."""
        self.assertWorks("skin", "estimate", "in.0001.exr", "-o", "maps.exr", "--picture-space", "ACEScg")
        self.commands |= {
            "report": ["report", "r.yaml", "-o", "r.html"],
            "estimate": ["skin", "estimate", "in.####.exr", "-o", "maps.####.exr", "--picture-space", "ACEScg", "--json", "s.json"],
            "edit": ["skin", "edit", "maps.exr", "-o", "edited.exr", "--tan", "1", "--smooth", "melanin=4"],
            "patterns": ["stage", "patterns", "-o", "p.yaml", "--pictures", "wall.####.exr", "--resolution", "1920x1080", "--pitch",
                         "2.8", "--steps", "3"],
            "environment": ["stage", "environment", "place.exr", "-o", "drives.exr", "--emitter-charts", "r.csv", "g.csv", "b.csv",
                            "--scene-chart", "t.csv"],
            "pack": ["spectrum", "pack", "pmc", "-o", "packed.json", "--tolerance", "0.5"],
            "pairs": ["pairs", "add", "pairs.csv", "colorchecker"],
        }

    def tree(self):
        """Every file's bytes, but for the time at which a picture says that it was made."""
        return {str(path.relative_to(self.folder)): TIME.sub(b"", path.read_bytes()) if path.is_file() else None
                for path in self.folder.rglob("*")}

    def restore(self, before):
        for path, data in sorted(self.tree().items(), reverse=True):
            if path not in before:
                (self.folder / path).rmdir() if data is None else (self.folder / path).unlink()
        for path, data in before.items():
            if data is not None:
                (self.folder / path).write_bytes(data)

    def interrupted(self, name, number, delay):
        process = subprocess.Popen([LUTGEN, *self.commands[name]], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        time.sleep(delay)
        process.send_signal(number)
        said = process.communicate(timeout=300)[1]
        return process.returncode, said

    def wholes(self, before):
        """What each command makes when it is let be, and how long it takes."""
        whole, seconds = {}, {}
        for name, arguments in self.commands.items():
            start = time.monotonic()
            run = lutgen(*arguments, folder=self.folder)
            self.assertEqual(run.returncode, 0, run.stderr)
            seconds[name] = time.monotonic() - start
            whole[name] = self.tree()
            self.assertNotEqual(whole[name].keys(), before.keys(), name)
            self.restore(before)
        return whole, seconds

    def test_nothing_is_left_behind_and_old_files_stay_whole(self):
        before = self.tree()
        whole, seconds = self.wholes(before)
        order = random.Random(7)
        ended = {name: [0, 0, 0, 0] for name in self.commands}
        for _ in range(ROUNDS):
            for name in self.commands:
                number = order.choice([signal.SIGINT, signal.SIGTERM])
                code, said = self.interrupted(name, number, order.uniform(0, seconds[name]))
                now = self.tree()
                with self.subTest(name, number=number, code=code, said=said):
                    ended[name][0 if code == 0 else 1] += 1
                    if code == 0:
                        self.assertEqual(now, whole[name])
                    else:
                        self.assertEqual(code, -number)
                        if now != before:  # it came when the work was done
                            self.assertIn("files that are complete", said)
                            self.assertTrue(all(now[path] == whole[name].get(path, now[path]) for path in now))
                        self.assertFalse([path for path in now if "partial" in path])
                self.restore(before)
                self.killed(name, order.uniform(0, seconds[name]), before, whole[name], ended[name])
        for name, (done, stopped, whole_old, renewed) in ended.items():
            print(f"{name:10} SIGINT and SIGTERM: {stopped} stopped, {done} done before; SIGKILL: {whole_old} left all old "
                  f"files, {renewed} new ones")

    def killed(self, name, delay, before, whole, counts):
        """SIGKILL, where each file that the command writes is there already: it is the old one or the new."""
        made = [path for path in whole if path not in before and whole[path] is not None]
        for path in made:
            (self.folder / path).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / path).write_bytes(b"old")
        code, said = self.interrupted(name, signal.SIGKILL, delay)
        now = self.tree()
        new = [path for path in made if now.get(path) != b"old"]
        with self.subTest(name, number=signal.SIGKILL, code=code, said=said):
            self.assertIn(code, (0, -signal.SIGKILL, 1))
            for path in new:
                self.assertEqual(now.get(path), whole[path], path)
            counts[3 if new else 2] += 1
        self.restore(before)


if __name__ == "__main__":
    unittest.main()
