#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The figures of docs/skin.md, and what it says of the manifold's volume and of spectral resolution.

    PYTHONPATH=build/release/python build/venv/bin/python demo/skin.py [FOLDER]    (out/ by default; docs/images to renew the page's)
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from scipy.spatial import ConvexHull

import metamer
from metamer import skin
from pictures import ACESCG, SRGB, xyz_from_rgb
from skin_spectra import XYZ_FROM_RGB, chromophores, colours, manifold, resolution, srgb_from_linear

DCI_P3 = ((0.680, 0.320), (0.265, 0.690), (0.150, 0.060)), (0.3127, 0.3290)
REC_2020 = ((0.708, 0.292), (0.170, 0.797), (0.131, 0.046)), (0.3127, 0.3290)
# The face of the photograph, and where in it skin is.
FACE = (slice(38, 218), slice(142, 308))
CENTRE, RADII = (95, 84), (62, 46)
# The photograph is no albedo: its lit skin is brought to where albedos of skin are.
EXPOSURE = 0.6
# Beside the photograph, skins of other people in its maps: what stands before each, and its melanin and blood times so much.
OTHERS = (("as modelled", 1, 1), ("melanin x 4", 4, 1), ("melanin x 10", 10, 1.3))


def linear_from_srgb(codes: np.ndarray) -> np.ndarray:
    return np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)


def albedos(estimator: skin.Estimator) -> tuple[list[tuple[str, np.ndarray]], np.ndarray]:
    """The photograph taken for an albedo, and skins that the model made in its maps (of colours that are all skin's); where skin is."""
    from skimage import data

    photograph = EXPOSURE * linear_from_srgb(data.astronaut()[FACE] / 255)
    maps = estimator.estimate(photograph)
    rows, columns = np.mgrid[: maps.shape[0], : maps.shape[1]]
    distance = np.hypot((rows - CENTRE[0]) / RADII[0], (columns - CENTRE[1]) / RADII[1])
    found = [("photograph", photograph)]
    for name, melanin, blood in OTHERS:
        model = maps.copy()
        model[..., 6:] = 0
        model = skin.multiply(skin.multiply(model, "melanin", melanin), "blood", blood)
        found.append((name, estimator.colour(model)))
    return found, np.clip((1.15 - distance) / 0.3, 0, 1)


def without_residual(maps: np.ndarray) -> np.ndarray:
    bare = maps.copy()
    bare[..., 6:] = 0
    return bare


def reconstructions(estimator: skin.Estimator, given: list[tuple[str, np.ndarray]], matte: np.ndarray, file: Path) -> None:
    """Albedos as each method finds skin in them, no residual added, four times the error beside (figure 3.6)."""
    networks = {loss: skin.Network("Rec.709", loss) for loss in ("rgb", "spectral")}
    # Linear Rec.709 of the decoder's spectra.
    seen = np.linalg.solve(XYZ_FROM_RGB, np.array(
        [metamer.tristimulus(dict(zip(range(380, 781, 10), hat)), "D65", "CIE 1931 2") for hat in np.eye(41)]).T)

    def decoded(loss: str, rgb: np.ndarray) -> np.ndarray:
        maps = networks[loss].estimate(rgb)
        out = networks[loss].decode(maps[..., :5])
        return maps[..., 5:6] * (out if loss == "rgb" else out @ seen.T)

    methods = {"network, RGB-skin-RGB": lambda rgb: decoded("rgb", rgb),
               "network, RGB-skin-spectrum": lambda rgb: decoded("spectral", rgb),
               "most probable skin": lambda rgb: estimator.colour(without_residual(estimator.estimate(rgb)))}
    figure, panels = plt.subplots(len(methods) + 1, 2 * len(given), figsize=(15, 8.6), layout="constrained")
    for column, (name, rgb) in enumerate(given):
        panels[0, 2 * column].imshow(srgb_from_linear(rgb / EXPOSURE))
        panels[0, 2 * column].set_title(name, fontsize=10)
        for row, (method, reconstruct) in enumerate(methods.items(), 1):
            found = reconstruct(rgb)
            error = np.abs(found - rgb)
            on_skin = (error.mean(axis=-1) * matte).sum() / matte.sum()
            panels[row, 2 * column].imshow(srgb_from_linear(found / EXPOSURE))
            panels[row, 2 * column + 1].imshow(np.clip(4 * error, 0, 1))
            panels[row, 2 * column + 1].set_title(f"x 4; skin {on_skin:.4f}", fontsize=8)
            if column == 0:
                panels[row, 0].set_title(method, fontsize=9)
            print(f"{name}, {method}: mean error of RGB on skin {on_skin:.4f}")
    for axes in panels.flat:
        axes.axis("off")
    figure.savefig(file, dpi=65, pil_kwargs={"quality": 85})
    plt.close(figure)


def edits(estimator: skin.Estimator, given: list[tuple[str, np.ndarray]], matte: np.ndarray, file: Path) -> None:
    """Maps of melanin and blood, and edits of the rest (figures 3.7 and 3.9)."""
    rows, columns = np.mgrid[: matte.shape[0], : matte.shape[1]]
    spots = np.clip(3 * np.sin(rows / 13) * np.sin(columns / 17 + 1) - 0.8, 0, 1)

    def row(rgb: np.ndarray) -> list[tuple[str, np.ndarray]]:
        maps = estimator.estimate(rgb)
        tan = skin.set_quantity(skin.multiply(maps, "melanin", 1.4, matte), "eumelanin", 0, matte)
        flush = skin.oxygenate(skin.multiply(maps, "blood", 1.7, matte), 1, matte)
        changed = [("original", maps), ("without oxygen", skin.oxygenate(maps, -1, matte)), ("all oxygen", skin.oxygenate(maps, 1, matte)),
                   ("thinnest", skin.set_quantity(maps, "thickness", 10, matte)), ("thickest", skin.set_quantity(maps, "thickness", 350, matte)),
                   ("melanin x 1.4, pheomelanin", tan), ("tan 1", skin.tan(maps, 1, matte)),
                   ("blood x 1.7, all oxygen", flush), ("vitiligo", skin.bleach(maps, 0.95, matte * spots))]
        shown = [(title, srgb_from_linear(estimator.colour(one) / EXPOSURE)) for title, one in changed]
        return [*shown, ("melanin (cube root)", np.cbrt(maps[..., 0])), ("blood (fourth root)", maps[..., 1] ** 0.25)]

    lines = [row(rgb) for _, rgb in given]
    figure, panels = plt.subplots(len(lines), len(lines[0]), figsize=(20, 2.05 * len(lines)), layout="constrained")
    for line, (name, _) in enumerate(given):
        for axes, (title, picture) in zip(panels[line], lines[line]):
            if picture.ndim == 2:
                axes.imshow(picture, cmap="magma", vmin=0, vmax=0.8)
            else:
                axes.imshow(picture)
            axes.set(xticks=[], yticks=[])
            if line == 0:
                axes.set_title(title, fontsize=8)
        panels[line, 0].set_ylabel(name, fontsize=9)
    figure.savefig(file, dpi=65, pil_kwargs={"quality": 86})
    plt.close(figure)


def volumes(estimator: skin.Estimator) -> None:
    """How much of each working space the manifold fills: table 3.2's ranges, melanin cubically, blood quartically."""
    draws = np.random.default_rng(1).uniform([0.1, 0.178, 10, 0, 0], [1, 1, 350, 1, 1], (20_000, 5))
    rgb = colours(estimator, np.column_stack([draws[:, 0] ** 3, draws[:, 1] ** 4, draws[:, 2:]]))
    xyz = rgb @ XYZ_FROM_RGB.T
    for name, space in (("Rec.709", SRGB), ("P3-D65", DCI_P3), ("Rec.2020", REC_2020), ("ACEScg", ACESCG)):
        inside = xyz @ np.linalg.inv(xyz_from_rgb(space)).T
        outside = np.mean(np.any(inside < 0, axis=1))
        print(f"{name}: {100 * ConvexHull(inside).volume:.2f} % of the unit cube, {100 * outside:.1f} % of the draws outside the gamut")


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    estimator = skin.Estimator("D65", "CIE 1931 2", "Rec.709")
    chromophores(estimator, folder / "skin_chromophores.png")
    resolution(folder / "skin_resolution.png")
    manifold(estimator, folder / "skin_manifold.png")
    given, matte = albedos(estimator)
    reconstructions(estimator, given, matte, folder / "skin_reconstructions.jpg")
    edits(estimator, given, matte, folder / "skin_edits.jpg")
    volumes(estimator)
    print(f"{folder}/skin_*.png, skin_*.jpg (metamer {metamer.__version__})")


if __name__ == "__main__":
    main()
