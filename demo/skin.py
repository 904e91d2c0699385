#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The figures of docs/skin.md: the manifold of skin's colours and spectra, and a face with its skin edited.

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

WAVELENGTHS = np.arange(380, 781, 10)
MEAN = [0.0325, 0.0245, 93.2, 0.1775, 0.4394]
XYZ_FROM_RGB = xyz_from_rgb(SRGB)
DCI_P3 = ((0.680, 0.320), (0.265, 0.690), (0.150, 0.060)), (0.3127, 0.3290)
REC_2020 = ((0.708, 0.292), (0.170, 0.797), (0.131, 0.046)), (0.3127, 0.3290)
# The face of the photograph, and where in it skin is.
FACE = (slice(0, 300), slice(80, 380))
CENTRE, RADII = (133, 146), (62, 46)
# The photograph is no albedo: its lit skin is brought to where albedos of skin are.
EXPOSURE = 0.6


def linear_from_srgb(codes: np.ndarray) -> np.ndarray:
    return np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)


def srgb_from_linear(linear: np.ndarray) -> np.ndarray:
    light = np.clip(linear, 0, 1)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def colours(estimator: skin.Estimator, skins: np.ndarray) -> np.ndarray:
    """Linear Rec.709 of skins: maps without a residual."""
    maps = np.zeros((len(skins), 9))
    maps[:, :5] = skins
    maps[:, 5] = 1
    return estimator.colour(maps)


def manifold(estimator: skin.Estimator, file: Path) -> None:
    """Spectra, the W, lightness and the colours that melanin and blood span (figures 3.3 and 3.4)."""
    figure, ((spectra, contrast), (lightness, plane)) = plt.subplots(2, 2, figsize=(12, 9.4), layout="constrained")
    melanins = np.linspace(0.2, 0.7, 9) ** 3
    steps = np.array([[m, *MEAN[1:]] for m in melanins])
    for step, spectrum, rgb in zip(steps, skin.albedo(steps, repair=False), srgb_from_linear(colours(estimator, steps))):
        spectra.plot(WAVELENGTHS, spectrum, color=rgb, linewidth=2.5, label=f"{100 * step[0]:.1f} %")
    spectra.set(title="Melanin flattens the W", xlabel="nm", ylabel="reflectance", ylim=(0, None))
    spectra.legend(title="melanin", fontsize=8)

    fine = np.linspace(0.15, 0.8, 60) ** 3
    for blood in (0.01, 0.025, 0.06):
        skins = np.array([[m, blood, *MEAN[2:]] for m in fine])
        model = skin.albedo(skins, repair=False)
        # 540, 560 and 580 nm.
        contrast.semilogx(fine, model[:, 18] - (model[:, 16] + model[:, 20]) / 2, label=f"{100 * blood:g} %")
        luminance = (colours(estimator, skins) @ XYZ_FROM_RGB.T)[:, 1]
        lightness.semilogx(fine, 116 * np.cbrt(luminance) - 16, label=f"{100 * blood:g} %")
    contrast.set(title="The W's contrast", xlabel="melanin", ylabel="R(560) - mean of R(540), R(580)")
    contrast.legend(title="blood")
    lightness.set(title="Lightness in daylight", xlabel="melanin", ylabel="L*", ylim=(0, 100))
    lightness.legend(title="blood")

    grid = np.array([[m, b, *MEAN[2:]] for m in np.linspace(0.12, 0.75, 40) ** 3 for b in np.linspace(0.18, 0.75, 30) ** 4])
    people = skin.sample(400, seed=1)
    for skins, size, edge in ((grid, 26, "none"), (people, 9, "black")):
        rgb = colours(estimator, skins)
        xyz = rgb @ XYZ_FROM_RGB.T
        xy = xyz[:, :2] / xyz.sum(axis=1, keepdims=True)
        plane.scatter(*xy.T, c=srgb_from_linear(rgb), s=size, edgecolors=edge, linewidths=0.4)
    plane.plot(0.3127, 0.3290, "k+")
    plane.annotate("white", (0.3127, 0.3290), textcoords="offset points", xytext=(5, -12))
    plane.set(title="Colours: all melanin and blood; ringed, 400 people", xlabel="x", ylabel="y", aspect="equal")
    figure.savefig(file, dpi=80)
    plt.close(figure)


def face(estimator: skin.Estimator, file: Path) -> None:
    """A photograph taken for an albedo, its maps, and edits of them (figures 3.7 and 3.9)."""
    from skimage import data

    codes = data.astronaut()[FACE] / 255
    maps = estimator.estimate(EXPOSURE * linear_from_srgb(codes))
    rows, columns = np.mgrid[: codes.shape[0], : codes.shape[1]]
    distance = np.hypot((rows - CENTRE[0]) / RADII[0], (columns - CENTRE[1]) / RADII[1])
    matte = np.clip((1.15 - distance) / 0.3, 0, 1)
    edits = [
        ("as photographed", maps),
        ("melanin x 2", skin.multiply(maps, "melanin", 2, matte)),
        ("blood x 2", skin.multiply(maps, "blood", 2, matte)),
        ("blood x 0.4", skin.multiply(maps, "blood", 0.4, matte)),
        ("tan 1", skin.tan(maps, 1, matte)),
        ("flush 1", skin.flush(maps, 1, matte)),
        ("oxygen -1", skin.oxygenate(maps, -1, matte)),
        ("thickness x 0.4", skin.thicken(maps, 0.4, matte)),
        ("without melanin 0.8", skin.bleach(maps, 0.8, matte)),
    ]
    figure, panels = plt.subplots(3, 4, figsize=(12, 9.4), layout="constrained")
    shown = [(title, srgb_from_linear(estimator.colour(edited) / EXPOSURE), None) for title, edited in edits]
    shown += [("melanin (cube root)", np.cbrt(maps[..., 0]), (0, 0.8)), ("blood (fourth root)", maps[..., 1] ** 0.25, (0.1, 0.8)),
              ("where it is edited", matte, (0, 1))]
    for axes, (title, picture, limits) in zip(panels.flat, shown):
        if limits is None:
            axes.imshow(picture)
        else:
            axes.imshow(picture, cmap="magma", vmin=limits[0], vmax=limits[1])
        axes.set_title(title, fontsize=10)
        axes.axis("off")
    figure.savefig(file, dpi=75, pil_kwargs={"quality": 88})
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
    manifold(estimator, folder / "skin_manifold.png")
    face(estimator, folder / "skin_edits.jpg")
    volumes(estimator)
    print(f"{folder}/skin_manifold.png, {folder}/skin_edits.jpg (metamer {metamer.__version__})")


if __name__ == "__main__":
    main()
