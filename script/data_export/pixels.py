# SPDX-License-Identifier: Apache-2.0
"""Colours by which certificates judge files: photographs, their noise, saturated lights, and what no light makes."""

from __future__ import annotations

from typing import Any

import numpy as np

from data_export.table import COLOUR, Table

PICTURES = ("astronaut", "chelsea", "coffee", "rocket")
PACKAGE = ("scikit-image", "0.26.0")
CLEAN_EACH, NOISY_EACH, BEYOND = 256, 512, 528
# Of a camera: photons' variance, and a floor's standard deviation.
PHOTONS, FLOOR = 0.0015, 0.0015
WIDTHS, SHARES = (15.0, 25.0), (0.0, 0.2, 0.4, 0.6)
SODIUM = 589.3


def photographs(colour: Any) -> list[np.ndarray]:
    """Return the pictures' pixels as linear ACEScg, n x 3 each."""
    from skimage import data

    spaces = colour.RGB_COLOURSPACES
    matrix = colour.matrix_RGB_to_RGB(spaces["sRGB"], spaces["ACEScg"], "Bradford")
    pictures = []
    for name in PICTURES:
        code = getattr(data, name)()[..., :3].reshape(-1, 3) / 255.0
        linear = np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)
        pictures.append(linear @ matrix.T)
    return pictures


def saturated_lights(colour: Any) -> np.ndarray:
    """Return LEDs of every 5 nm and sodium, with some white, n x 3: the largest channel is 1."""
    cmfs = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    rgb_from_xyz = colour.RGB_COLOURSPACES["ACEScg"].matrix_XYZ_to_RGB
    lights = []
    for peak, width in [*((p, w) for p in np.arange(400.0, 701.0, 5.0) for w in WIDTHS), (SODIUM, 1.0), (SODIUM, 5.0)]:
        power = np.exp(-4.0 * np.log(2.0) * ((cmfs.wavelengths - peak) / width) ** 2)
        xyz = power @ cmfs.values
        rgb = rgb_from_xyz @ (xyz / xyz[1])
        for share in SHARES:
            mixed = (1.0 - share) * rgb + share
            lights.append(mixed / np.abs(mixed).max())
    return np.array(lights)


def pixel_table(colour: Any) -> Table:
    """Return the set of pixels, by kind."""
    random = np.random.default_rng(1)
    rows: list[tuple[str, np.ndarray]] = []
    pictures = photographs(colour)
    for picture in pictures:
        chosen = picture[random.choice(len(picture), CLEAN_EACH, replace=False)]
        rows += [("photograph", rgb) for rgb in chosen]
    for picture in pictures:
        chosen = picture[random.choice(len(picture), NOISY_EACH, replace=False)]
        deviation = np.sqrt(PHOTONS * np.maximum(chosen, 0.0) + FLOOR**2)
        rows += [("noisy photograph", rgb) for rgb in chosen + deviation * random.standard_normal(chosen.shape)]
    rows += [("saturated light", rgb) for rgb in saturated_lights(colour)]
    directions = random.standard_normal((BEYOND, 3)) * 10.0 ** random.uniform(-3.0, 0.0, (BEYOND, 1))
    rows += [("beyond gamut", rgb) for rgb in directions]
    lines = ["kind,red,green,blue"]
    lines += [",".join([kind, *(f"{value:.5g}" for value in rgb)]) for kind, rgb in rows]
    return Table(
        "pixels/certificate.csv",
        "pixels",
        "linear ACEScg",
        "1",
        ["certificate"],
        f"Photographs of scikit-image {PACKAGE[1]}: astronaut (NASA), chelsea (Stéfan van der Walt), coffee (Rachel "
        f"Michetti), rocket (SpaceX); lights worked out with {COLOUR}",
        "CC0-1.0",
        ("\n".join(lines) + "\n").encode("utf-8"),
        note=f"{len(rows)} pixels, seed 1. Noise: variance {PHOTONS} x + {FLOOR}^2. Saturated lights: Gaussians 15 and 25 nm "
        "wide every 5 nm from 400 to 700 nm and sodium, with 0 to 60 % of white. Beyond the gamut: random directions.",
    )
