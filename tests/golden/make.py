#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the golden files of this folder anew, and prints what `lutgen compare` says of them.

Only for a change that is meant to move results: say in its message which figures moved, from what to what. Run with
build/venv/bin/python and $METAMER_BIN; the bounds of the files stand in CMakeLists.txt, a fiftieth above what this prints.
"""

import os
import subprocess
from pathlib import Path

import numpy as np
import OpenEXR

FOLDER = Path(__file__).resolve().parent
LUTGEN = Path(os.environ["METAMER_BIN"]) / "lutgen"
NODES = {".ctf": "13", ".cube": "9"}
FILES = ("camera.ctf", "day_to_sodium.ctf", "day_to_tungsten.ctf", "gel.cube", "skin.ctf")


def write_exr(file, pixels):
    OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, {"RGB": pixels}).write(str(file))


def probes():
    """Natural, saturated and impossible colours from ten stops under 18 % grey to ten above."""
    generator = np.random.default_rng(11)
    pixels = generator.random((24, 40, 3)) ** np.array([1, 2, 4, 8])[np.arange(24) % 4][:, None, None]
    pixels[20:] -= 0.2 * generator.random((4, 40, 3))
    pixels[0] = 0.18
    return (pixels * 2.0 ** np.linspace(-10, 10, 40)[:, None]).astype(np.float32)


def main():
    write_exr(FOLDER / "probes.exr", probes())
    for name in FILES:
        recipe, file = FOLDER / f"{Path(name).stem}.yaml", FOLDER / name
        subprocess.run([LUTGEN, "bake", recipe, "--size", NODES[file.suffix], "-o", file], check=True)
        # The comparison must not depend on what a bake says of itself.
        Path(f"{file}.json").unlink()
        subprocess.run([LUTGEN, "apply", recipe, FOLDER / "probes.exr", file.with_suffix(".exr")], check=True)
        print(subprocess.run([LUTGEN, "compare", recipe, file], check=True, capture_output=True, text=True).stdout)


if __name__ == "__main__":
    main()
