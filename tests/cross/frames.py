# SPDX-License-Identifier: Apache-2.0
"""Pictures that the plug-in renders on every system: the jobs, and whether two systems' are the same bit for bit."""

import os
import re
import shutil
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RECIPES = 12
SETTINGS = [
    (0, ["outputIlluminant=HP1", "adaptation=0.3"]),
    (0, ["outputIlluminant=HP1", "quality=Exact", "mix=0.5"]),
    (0, ["outputIlluminant=Blackbody", "outputTemperature=2000", "scene=Skin", "quality=Exact"]),
    (0, ["outputIlluminant=FL11", "scene=Smooth", "cat=bradford", "keepExposure=1"]),
    (0, ["outputIlluminant=A", "scene=Data set", "space=ARRI LogC4", "quality=Exact"]),
    (2, ["melanin=2", "blood=1.5", "quality=Exact"]),
    (2, ["tan=1", "flush=0.5", "illuminant=A"]),
]


def output(*words):
    """What a program prints."""
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=True).stdout


def environment(library, **more):
    """For a program of the bare host: the plug-in to load, with its own tables."""
    own = dict(os.environ, METAMER_OFX_LIBRARY=str(library), LC_ALL="C.UTF-8", **more)
    own.pop("METAMER_DATA", None)
    return own


def jobs(folder, system):
    """Writes folder/SYSTEM.txt for metamer_ofx_frames; gives the pictures that it will make. Every system sees the same files by the same
    relative names."""
    made = [(effect, settings) for effect, settings in SETTINGS]
    recipes = folder / "レシピ é"
    shutil.copytree(ROOT / "configs/recipes", recipes, dirs_exist_ok=True)
    names = sorted((ROOT / "configs/recipes").glob("*.yaml"))
    for k, recipe in enumerate(names[:: len(names) // RECIPES][:RECIPES]):
        copy = recipes / f"{recipe.stem} 夜.yaml"
        shutil.copy(recipe, copy)
        made.append((0, [f"recipeFile={copy.relative_to(folder)}", f"quality={('Map', 'Exact')[k % 2]}"]))
    lamp = recipes / "лампа.csv"
    lamp.write_text("nm,power\n380,1\n580,1\n780,3\n", encoding="utf-8")
    lit = lamp.with_name("灯.yaml")
    lit.write_text("metamer: 1\ninput: {illuminant: D65}\noutput: {illuminant: лампа.csv}\n", encoding="utf-8")
    made.append((0, [f"recipeFile={lit.relative_to(folder)}"]))
    pictures = [f"{system} 絵 {k}.f32" for k in range(len(made))]
    text = "".join("\t".join([str(effect), picture, *settings]) + "\n" for (effect, settings), picture in zip(made, pictures))
    (folder / f"{system}.txt").write_text(text, encoding="utf-8", newline="\n")
    return [folder / picture for picture in pictures]


def assert_same(test, folder, system, ones, others):
    """Pictures of two systems, of the jobs of SYSTEM: the same bit for bit, and all unlike one another."""
    texts = (folder / f"{system}.txt").read_text(encoding="utf-8").splitlines()
    seen = {}
    for text, one, other in zip(texts, ones, others, strict=True):
        a, b = one.read_bytes(), other.read_bytes()
        test.assertEqual(len(a), 160 * 90 * 16)
        test.assertNotIn(a, seen, f"{text} is {seen.get(a)}: not told apart")
        seen[a] = text
        differing = sum(a[i : i + 4] != b[i : i + 4] for i in range(0, len(a), 4)) if a != b else 0
        test.assertEqual(differing, 0, f"numbers of {len(a) // 4} that differ: {text}")


def assert_passes(test, run):
    """A run of the bare host's whole suite."""
    test.assertEqual(run.returncode, 0, run.stdout[-6000:] + run.stderr[-2000:])
    passed = re.search(r"\[  PASSED  \] (\d+) tests", run.stdout)
    test.assertGreater(int(passed[1]), 50, run.stdout[-2000:])
    test.assertNotIn("SKIPPED", run.stdout)
