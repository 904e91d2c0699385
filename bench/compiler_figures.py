# SPDX-License-Identifier: Apache-2.0
"""What one compiler's build makes of the same inputs: numbers and files, to hold against another's.

Run apart for each build (sections/compilers.py), so that no symbol of one library can stand in for the other's.
"""

import hashlib
import subprocess
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))

from door import Door, Engine, Map, targets, use_target  # noqa: E402
from hard.files import SCENE  # noqa: E402
from sections.stability import adversarial  # noqa: E402

# Lights, and the scene.
ENGINES = {"D65->A": ("D65", "A", "smooth"), "D65->HP1": ("D65", "HP1", "smooth"), "FL11->D50": ("FL11", "D50", "smooth"),
           "LED-RGB1->D65": ("LED-RGB1", "D65", "smooth"), "D65->FL11, natural": ("D65", "FL11", "natural")}
# Two recipes in every kind of table, and a matrix.
BAKES = {f"{light}{suffix}": ("--illuminant-in", "D65", "--illuminant-out", light, *options)
         for light in ("A", "HP1")
         for suffix, options in ((".ctf", ("--size", "33")), (".clf", ("--size", "17")), (".cube", ("--size", "17")),
                                 (" sampled.cube", ("--size", "17", "--sampled")), (".spimtx.ctf", ("--tolerance", "60")))}
THREADS = (1, 2, 3)
RENDERS = {"plain": (), "guided, resampled": ("--guiding", "on", "--restir", "lanes")}
RECIPE = "metamer: 1\nname: t\nspace: ACEScg\ninput: {illuminant: D65}\noutput: {illuminant: HP1}\n"


def sha256(file):
    return hashlib.sha256(Path(file).read_bytes()).hexdigest()


def main():
    bin_folder, folder = Path(sys.argv[1]), Path(sys.argv[2])
    door = Door(bin_folder.parent / "lib" / "libmetamer_bench_door.so")
    colours = adversarial(door, 20_000)[:, :3].astype(np.float64)
    pixels = adversarial(door, 100_003)
    pixels[:7, 0] = [np.nan, np.inf, -np.inf, 0.0, -0.0, 1e-45, 65504]
    arrays = {}
    for name, (source, destination, scene) in ENGINES.items():
        engine = Engine(door, source, destination, 251, scene)
        arrays[f"exact/{name}"], _ = engine.apply(colours)
        if scene != "smooth":
            continue
        table = Map(engine, 0.09)
        for target, bit in targets(door).items():
            use_target(door, bit)
            output = np.empty_like(pixels)
            table.run(pixels, output)
            arrays[f"map/{name}/{target}"] = output
        use_target(door, 0)
    for name, options in BAKES.items():
        subprocess.run([bin_folder / "lutgen", "bake", *options, "-o", folder / name], check=True, stdout=subprocess.DEVNULL)
        arrays[f"file/{name}"] = np.array(sha256(folder / name))
        arrays[f"certificate/{name}"] = np.array(sha256(folder / f"{name}.json"))
    recipe, picture = folder / "t.yaml", folder / "in.tif"
    recipe.write_text(RECIPE)
    import imageio.v3 as imageio

    imageio.imwrite(picture, np.clip(np.random.default_rng(2).normal(0.3, 0.3, (180, 320, 3)), -0.1, None).astype(np.float32))
    for threads in THREADS:
        subprocess.run([bin_folder / "lutgen", "apply", recipe, picture, folder / "out.tif", "--threads", str(threads)],
                       check=True, stdout=subprocess.DEVNULL)
        arrays[f"threads/{threads}"] = imageio.imread(folder / "out.tif")
    import OpenEXR

    (folder / "scene.yaml").write_text(SCENE.replace("illuminant: A", "illuminant: FL11"))
    for name, options in RENDERS.items():
        subprocess.run([bin_folder / "spectral_ref", "render", folder / "scene.yaml", "-o", folder / "render.exr", "--spp", "16",
                        *options], check=True, stdout=subprocess.DEVNULL)
        channels = OpenEXR.File(str(folder / "render.exr"), separate_channels=True).channels()
        arrays[f"render/{name}"] = np.dstack([channels[c].pixels for c in "RGB"])
    np.savez(folder / "figures.npz", **arrays)


if __name__ == "__main__":
    main()
