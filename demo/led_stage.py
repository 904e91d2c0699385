# SPDX-License-Identifier: Apache-2.0
"""The pictures of docs/led_stage.md: a solved stage's chart, and a photographed chart with the sampled squares.

    build/venv/bin/python demo/led_stage.py [FOLDER]    (out/ by default; docs/images to renew the page's)

Needs lutgen on the path, in build/install/bin, or in $METAMER_BIN.
"""

import csv
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import OpenEXR

ROOT = Path(__file__).resolve().parent.parent
CORNERS = np.array([[62.0, 40.0], [612.0, 78.0], [588.0, 442.0], [88.0, 402.0]])
CELLS = np.array([[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0]])
SIZE = (480, 680)


def lutgen(*arguments):
    folders = [os.environ.get("METAMER_BIN", ""), str(ROOT / "build/install/bin")]
    program = next((str(Path(f) / "lutgen") for f in folders if f and (Path(f) / "lutgen").exists()), None)
    program = program or shutil.which("lutgen") or sys.exit("lutgen is not there; run script/bootstrap")
    environment = {"METAMER_DATA": str(ROOT / "data"), **os.environ}
    subprocess.run([program, "stage", *map(str, arguments)], check=True, env=environment)


def photograph(patches):
    """A leaning 24-patch chart, each patch of one colour with a dark line round it, in a grey room."""
    rows = []
    for (x, y), (u, v) in zip(CORNERS, CELLS):
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y, -u], [0, 0, 0, x, y, 1, -v * x, -v * y, -v]]
    cells_from_pixels = np.linalg.svd(np.array(rows))[2][-1].reshape(3, 3)
    y, x = np.mgrid[: SIZE[0], : SIZE[1]] + 0.5
    cells = cells_from_pixels @ np.stack([x.ravel(), y.ravel(), np.ones(x.size)])
    cells = cells[:2] / cells[2]
    column, row = np.floor(cells).astype(int)
    on_chart = (column >= 0) & (column < 6) & (row >= 0) & (row < 4)
    on_patch = on_chart & (np.abs(cells - np.floor(cells) - 0.5).max(axis=0) < 0.44)
    picture = np.full((x.size, 3), 0.12)
    picture[on_chart] = 0.02
    picture[on_patch] = patches[row[on_patch] * 6 + column[on_patch]]
    return picture.reshape(*SIZE, 3).astype(np.float32)


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "out")
    folder.mkdir(parents=True, exist_ok=True)
    work = folder / "led_stage"
    work.mkdir(exist_ok=True)
    lutgen("solve", ROOT / "demo/stages/fluorescent.yaml", "-o", work / "fluorescent.json", "--report",
           work / "fluorescent.md", "--figure", folder / "stage_chart.png")
    with open(ROOT / "data/reflectances/colorchecker.csv", encoding="utf-8", newline="") as stream:
        table = list(csv.reader(stream))
    # Three broad bands make a picture of the chart good enough to look at.
    values = np.array([[float(cell) for cell in row] for row in table[1:]])
    bands = [(580, 680), (500, 580), (420, 500)]
    patches = np.stack([values[(values[:, 0] >= low) & (values[:, 0] < high), 1:].mean(axis=0) for low, high in bands], 1)
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGB": photograph(patches)}).write(str(work / "chart.exr"))
    lutgen("sample", work / "chart.exr", "--corners", *(f"{x},{y}" for x, y in CORNERS), "-o", work / "chart.csv",
           "--check-picture", folder / "stage_check.png")


if __name__ == "__main__":
    main()
