# SPDX-License-Identifier: Apache-2.0
"""The tables of data/ for the tests beside this file, and what is computed from them."""

from __future__ import annotations

import csv
import json
import math
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "data"
SCRIPT = ROOT / "script" / "export_data.py"
GRID = range(380, 781)

# What is exported, and from which releases, is said in one place.
sys.path.insert(0, str(SCRIPT.parent))
from data_export.rgb_spaces import RGB_SPACES  # noqa: E402
from export_data import PINNED  # noqa: E402

SPACES = set(RGB_SPACES)
Column = dict[float, float]


def load_manifest() -> list[dict]:
    """Return the manifest's tables."""
    document = json.loads((DATA / "manifest.json").read_text(encoding="utf-8"))
    assert document["metamer_data"] == 1
    return document["tables"]


def read_table(file: str) -> dict[str, Column]:
    """Return the columns of a CSV table by name."""
    with (DATA / file).open(encoding="utf-8", newline="") as stream:
        header, *rows = csv.reader(stream)
    assert header[0] == "wavelength_nm", file
    assert all(len(row) == len(header) for row in rows), file
    return {
        name: {float(row[0]): float(row[k]) for row in rows}
        for k, name in enumerate(header)
        if k > 0
    }


def find(group: str, name: str) -> dict[str, Column]:
    """Return the columns behind a name: one of that name, or a set's."""
    for table in load_manifest():
        if table["group"] == group and name in table["names"]:
            columns = read_table(table["file"])
            return {name: columns[name]} if group in ("illuminants", "filters") else columns
    raise KeyError(f"{group}: {name}")


def at(column: Column, wavelength: float, hold: bool = False) -> float:
    """Interpolate linearly; outside, hold the end value or return zero."""
    low, high = min(column), max(column)
    if wavelength < low or wavelength > high:
        return column[low if wavelength < low else high] if hold else 0.0
    if wavelength in column:
        return column[wavelength]
    before = max(w for w in column if w < wavelength)
    after = min(w for w in column if w > wavelength)
    t = (wavelength - before) / (after - before)
    return (1 - t) * column[before] + t * column[after]


def xyz(light: list[float]) -> list[float]:
    """Return CIE 1931 tristimulus values of a light on GRID; E has Y = 1."""
    bars = find("observers", "CIE 1931 2")
    scale = sum(bars["Y"][w] for w in GRID)
    return [sum(bars[k][w] * s for w, s in zip(GRID, light)) / scale for k in "XYZ"]


def chromaticity(values: list[float]) -> tuple[float, float]:
    """Return x and y of tristimulus values."""
    return values[0] / sum(values), values[1] / sum(values)


def illuminant(name: str) -> list[float]:
    """Return an illuminant on GRID."""
    column = find("illuminants", name)[name]
    return [at(column, w) for w in GRID]


def native_chromaticity(name: str) -> tuple[float, float]:
    """Return x and y of an illuminant, summed at its own samples as the CIE does."""
    column = find("illuminants", name)[name]
    bars = find("observers", "CIE 1931 2")
    return chromaticity([sum(bars[k].get(w, 0.0) * v for w, v in column.items()) for k in "XYZ"])


def planck(kelvin: float) -> list[float]:
    """Return a black body's relative spectrum on GRID."""
    return [w**-5 / (math.exp(1.4388e7 / (w * kelvin)) - 1) for w in GRID]


def camera_fits(corrected: bool = True) -> dict[tuple[str, str], list[float]]:
    """Return the parameters of the camera fits by camera and channel."""
    published = json.loads((DATA / "sources/camera_fits.json").read_text(encoding="utf-8"))
    out = {}
    for camera in published["cameras"]:
        for channel, values in camera["printed"].items():
            out[camera["name"], channel] = list(values)
        for fix in camera["corrections"] if corrected else []:
            place = "abcdefghij".index(fix["parameter"])
            out[camera["name"], fix["curve"]][place] = fix["used"]
    return out


def fit(parameters: list[float], x: float) -> float:
    """Return the value of a camera fit at a wavelength."""
    a, b, c, d, e, f, g, h, i, j = parameters
    first = a * math.exp(-b * x * math.pow((x - c) / d, i))
    return first + e * math.exp(-f * x * math.pow((x - g) / h, j))


def peak_and_width(parameters: list[float]) -> tuple[int, int]:
    """Return a fit's peak, and the span not below half of it, in whole nm."""
    values = {x: fit(parameters, x) for x in GRID}
    peak = max(values, key=values.__getitem__)
    above = [x for x in GRID if values[x] >= values[peak] / 2]
    return peak, above[-1] - above[0]
