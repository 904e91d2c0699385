# SPDX-License-Identifier: Apache-2.0
"""Signals at any time, for every command that takes its time.

SIGINT and SIGTERM leave nothing behind, or files that are complete where they came when the work was done, and say
which; SIGKILL leaves the old file whole. METAMER_SIGNALS sets how many of them each command gets: see script/signals.
"""

import os
import random
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import OpenEXR

from lutgen import LUTGEN, LutgenTest
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
SPECTRAL_REF = LUTGEN.parent / "spectral_ref"
DEMO = Path(__file__).resolve().parents[2] / "demo" / "files"


class Folder:
    """A command's own folder: what lay in it at first, and what lies in it now."""

    def __init__(self, original, path):
        self.path = shutil.copytree(original, path)
        self.known = {}
        self.before = self.tree()

    def bytes_of(self, path):
        state = path.stat()
        key = state.st_ino, state.st_mtime_ns, state.st_size
        if self.known.get(path, (None,))[0] != key:
            self.known[path] = key, path.read_bytes()
        return self.known[path][1]

    def tree(self):
        """Every file's bytes, but for the time at which a picture says that it was made; None for a folder."""
        return {str(path.relative_to(self.path)): TIME.sub(b"", self.bytes_of(path)) if path.is_file() else None
                for path in self.path.rglob("*")}

    def restore(self):
        for path, data in sorted(self.tree().items(), reverse=True):
            if path not in self.before:
                (self.path / path).rmdir() if data is None else (self.path / path).unlink()
            elif data != self.before[path]:
                raise AssertionError(f"{path}, which the command only reads, is another")


class Interrupted:
    """One command, let be once and then sent signals at times of its own: counts, and faults in words.

    Half of the times are anywhere within what the command takes, half towards its end, where files are written.
    """

    def __init__(self, name, command, folder):
        program = SPECTRAL_REF if command[0] == "spectral_ref" else LUTGEN
        self.name, self.folder = name, folder
        self.command = [str(program), *command[program is SPECTRAL_REF:]]
        self.order = random.Random(name)
        self.counts = {"stopped": 0, "done before": 0, "left all old files": 0, "new ones": 0}
        self.faults = []
        self.seconds = 0.0
        code, said = self.run(None, 300)
        self.whole = folder.tree()
        if code != 0 or self.whole.keys() == folder.before.keys():
            self.faults.append(f"{name}: let be: code {code}, {said!r}")
        folder.restore()

    def run(self, number, delay):
        """Exit code and what stderr says; a command that is done earlier tells how long it takes."""
        start = time.monotonic()
        process = subprocess.Popen(self.command, cwd=self.folder.path, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   text=True)
        try:
            said = process.communicate(timeout=delay)[1]
            self.seconds = time.monotonic() - start
        except subprocess.TimeoutExpired:
            self.seconds = max(self.seconds, delay)
            process.send_signal(number)
            said = process.communicate(timeout=300)[1]
        return process.returncode, said

    def delay(self):
        low, high = self.order.choice([(0, 1), (0.7, 1.05)])
        return self.seconds * self.order.uniform(low, high)

    def judge(self, number, code, said, faults):
        self.faults += [f"{self.name}: {signal.Signals(number).name}, code {code}, {said!r}: {fault}" for fault in faults]

    def stopped(self):
        number = self.order.choice([signal.SIGINT, signal.SIGTERM])
        code, said = self.run(number, self.delay())
        before, now = self.folder.before, self.folder.tree()
        changed = [path for path in {**before, **now} if now.get(path, 0) != before.get(path, 0)]
        changed = [path for path in changed if not path.endswith(".checkpoint")]  # what a render goes on from
        faults = [f"{path} is not what it becomes" for path in changed if now.get(path, 0) != self.whole.get(path, 0)]
        if code == 0:
            faults += [f"{path} lacks" for path in self.whole if path not in now]
        else:
            faults += [f"not ended by the signal {number}"] if code != -number else []
            faults += ["files are left that it does not tell of"] if changed and "files that are complete" not in said else []
        self.counts["done before" if code == 0 else "stopped"] += 1
        self.judge(number, code, said, faults)
        self.folder.restore()

    def killed(self):
        """Where each file that the command writes is there already: it is the old one or the new."""
        before, whole = self.folder.before, self.whole
        made = [path for path in whole if path not in before and whole[path] is not None]
        for path in made:
            (self.folder.path / path).parent.mkdir(parents=True, exist_ok=True)
            (self.folder.path / path).write_bytes(b"old")
        code, said = self.run(signal.SIGKILL, self.delay())
        now = self.folder.tree()
        new = [path for path in made if now.get(path) != b"old"]
        faults = [f"{path} is neither the old one nor the new" for path in new if now.get(path) != whole[path]]
        faults += [] if code in (0, -signal.SIGKILL, 1) else ["no end that is known"]
        self.counts["new ones" if new else "left all old files"] += 1
        self.judge(signal.SIGKILL, code, said, faults)
        self.folder.restore()

    def all_rounds(self):
        for _ in range(0 if self.faults else ROUNDS):
            self.stopped()
            self.killed()
        c = self.counts
        print(f"{self.name:12} SIGINT and SIGTERM: {c['stopped']} stopped, {c['done before']} done before; SIGKILL: "
              f"{c['left all old files']} left all old files, {c['new ones']} new ones; {len(self.faults)} faults", flush=True)
        return self.faults


class Signals(LutgenTest):
    def setUp(self):
        super().setUp()
        (self.folder / "r.yaml").write_text(RECIPE)
        (self.folder / "s.yaml").write_text(RECIPE.replace("evening", "night").replace("illuminant: A", "illuminant: HP1"))
        self.assertWorks("bake", "r.yaml", "-o", "old.ctf", "--size", "5")
        pixels = np.random.default_rng(1).random((100, 150, 3)).astype(np.float16)
        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        for frame in range(1, 4):
            OpenEXR.File(dict(header), {"RGB": pixels}).write(str(self.folder / f"in.{frame:04d}.exr"))
        OpenEXR.File(dict(header), {"RGB": pixels[:75]}).write(str(self.folder / "place.exr"))
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
        """Commands that ctest leaves to METAMER_LONG=1 and script/signals."""
        self.assertWorks("skin", "estimate", "in.0001.exr", "-o", "maps.exr", "--picture-space", "ACEScg")
        for file in ("dayglo.csv", "scene.yaml"):
            shutil.copy(DEMO / file, self.folder)
        for file, samples in (("first.exr", "0:4"), ("second.exr", "4:8")):
            subprocess.run([SPECTRAL_REF, "render", "scene.yaml", "-o", file, "--samples", samples], cwd=self.folder, check=True,
                           capture_output=True)
        self.commands |= {
            "report": ["report", "r.yaml", "-o", "r.html", "--picture", "in.0001.exr", "--picture-space", "ACEScg"],
            "estimate": ["skin", "estimate", "in.####.exr", "-o", "maps.####.exr", "--picture-space", "ACEScg", "--json", "s.json"],
            "edit": ["skin", "edit", "maps.exr", "-o", "edited.exr", "--tan", "1", "--smooth", "melanin=4"],
            "patterns": ["stage", "patterns", "-o", "p.yaml", "--pictures", "wall.####.exr", "--resolution", "480x270", "--pitch",
                         "11", "--steps", "3"],
            "environment": ["stage", "environment", "place.exr", "-o", "drives.exr", "--emitter-charts", "r.csv", "g.csv", "b.csv",
                            "--scene-chart", "t.csv"],
            "pack": ["spectrum", "pack", "pmc", "-o", "packed.json", "--tolerance", "0.5"],
            "pairs": ["pairs", "add", "pairs.csv", "colorchecker"],
            "cube": ["bake", "r.yaml", "-o", "a.cube", "--size", "17"],
            "shader": ["bake", "r.yaml", "-o", "a.glsl"],
            "picture": ["apply", "old.ctf", "in.0001.exr", "one.png", "-d", "uint8", "--picture-space", "ACEScg"],
            "fit": ["spectrum", "fit", "dayglo.csv", "-o", "compact.csv"],
            "emitter": ["stage", "emitter", "led:460:16", "-o", "emitter.csv"],
            "job bake": ["job", "bake", "r.yaml", "s.yaml", "-o", "looks", "--slurm", "scripts"],
            "job apply": ["job", "apply", "r.yaml", "in.####.exr", "farm.####.exr", "--openjd", "bundle"],
            "render": ["spectral_ref", "render", "scene.yaml", "-o", "render.exr", "--spp", "64", "--checkpoint", "0"],
            "merge": ["spectral_ref", "merge", "first.exr", "second.exr", "-o", "merged.exr"],
        }

    def test_nothing_is_left_behind_and_old_files_stay_whole(self):
        with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(2) as pool:
            def faults(number, command):
                folder = Folder(self.folder, Path(name) / str(number))
                return Interrupted(command, self.commands[command], folder).all_rounds()

            self.assertEqual([], [fault for found in pool.map(faults, *zip(*enumerate(self.commands))) for fault in found])


if __name__ == "__main__":
    unittest.main()
