# SPDX-License-Identifier: Apache-2.0
"""docs/images/differences.jpg: what the figures of three certificates look like in a shot.

    build/venv/bin/python demo/differences.py [FOLDER OF lutgen]    (build/install/bin by default)
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from pictures import read_exr, scene, scikit_image, view, write_exr

ROOT = Path(__file__).resolve().parent.parent
RECIPE = ROOT / "demo" / "files" / "look.yaml"
FILES = {"look.ctf": [], "look.cube": ["--format", "resolve_cube"], "coarse.cube": ["--size", "17"]}
SIZE = 320
GAIN = 60
BAR = 26


def small(picture):
    """Half the size, in linear light."""
    height, width = (length // 2 * 2 for length in picture.shape[:2])
    return picture[:height, :width].reshape(height // 2, 2, width // 2, 2, 3).mean(axis=(1, 3))[:SIZE, :SIZE]


def labelled(panel, text):
    canvas = Image.new("RGB", (panel.shape[1], panel.shape[0] + BAR), "white")
    canvas.paste(Image.fromarray(panel), (0, BAR))
    font = ImageFont.truetype("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", 14)
    ImageDraw.Draw(canvas).text((2, 4), text, "black", font)
    return np.asarray(canvas)


def main():
    lutgen = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build" / "install" / "bin") / "lutgen"
    shot = small(scene(scikit_image("astronaut.png")))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_exr(folder / "shot.exr", shot)

        def through(what):
            subprocess.run([lutgen, "apply", what, folder / "shot.exr", folder / "out.exr"], check=True)
            return view(read_exr(folder / "out.exr"))

        exact = through(RECIPE)
        columns = [[labelled(view(shot), "as shot, under tungsten"), labelled(exact, "in daylight, exact")]]
        for file, options in FILES.items():
            subprocess.run([lutgen, "bake", RECIPE, *options, "-o", folder / file], check=True, stdout=subprocess.DEVNULL)
            p99 = json.loads((folder / f"{file}.json").read_text())["error"]["p99"]
            seen = through(folder / file)
            off = np.clip(np.abs(seen.astype(int) - exact) * GAIN, 0, 255).astype(np.uint8)
            columns.append([labelled(seen, f"through a file of p99 {p99:.2g}"), labelled(off, f"its difference, × {GAIN}")])
    gap = np.full((2 * (len(exact) + BAR), 6, 3), 255, np.uint8)
    panels = [np.concatenate(column) for column in columns]
    sheet = np.concatenate([part for panel in panels for part in (panel, gap)][:-1], axis=1)
    target = ROOT / "docs" / "images" / "differences.jpg"
    Image.fromarray(sheet).save(target, quality=80, optimize=True)
    print(target, sheet.shape, target.stat().st_size, "bytes")


if __name__ == "__main__":
    main()
