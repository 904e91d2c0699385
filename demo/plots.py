# SPDX-License-Identifier: Apache-2.0
"""The two plots: what the lights and reflectances are, and where chromaticities go."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import pictures
import spectra


@dataclass(frozen=True)
class Light:
    key: str  # of its recipes: day_to_<key>_000.yaml ...
    title: str
    name: str  # in data/
    file: str
    colour: str


DAYLIGHT = Light("daylight", "Daylight", "D65", "illuminants/cie_standard.csv", "#3b78c2")
LIGHTS = (
    Light("tungsten", "Tungsten", "A", "illuminants/cie_standard.csv", "#d9822b"),
    Light("sodium", "Sodium", "HP1", "illuminants/cie_hp.csv", "#b8a100"),
    Light("rgb_led", "RGB LEDs", "LED-RGB1", "illuminants/cie_led.csv", "#8e3ba8"),
)
PATCHES = {
    "light skin": "#d19a80",
    "blue sky": "#5b7ba5",
    "foliage": "#5a6e3f",
    "orange": "#e0792b",
    "red": "#b3323b",
    "yellow": "#e8c31f",
}


def plot_spectra(path: Path) -> None:
    """Illuminants at equal luminance; under them, measured patches beside the smoothest spectra of the same colour."""
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(9, 9), constrained_layout=True)
    luminosity = spectra.observer()[:, 1]
    for light in (DAYLIGHT, *LIGHTS):
        power = spectra.illuminant(light.file, light.name)
        power = power / (power @ luminosity) * luminosity.sum()
        upper.plot(spectra.WAVELENGTHS, power, color=light.colour, label=f"{light.title} ({light.name})")
    upper.set(title="Lights, at equal luminance", ylabel="relative power", xlim=(380, 780), ylim=(0, None))
    upper.legend(frameon=False)

    daylight = spectra.illuminant(DAYLIGHT.file, DAYLIGHT.name)
    for name, colour in PATCHES.items():
        measured = spectra.reflectance(name)
        lower.plot(spectra.WAVELENGTHS, measured, color=colour, linestyle=":")
        lower.plot(*spectra.smoothest(measured, daylight), color=colour, label=name)
    lower.set(
        title="Reflectances: the smoothest with the patch's colour in daylight (solid), as measured (dotted)",
        xlabel="wavelength in nm", ylabel="reflectance", xlim=(380, 780), ylim=(0, 1),
    )
    lower.legend(frameon=False, ncols=2)
    figure.savefig(path, dpi=120)
    plt.close(figure)


def probe_colours(spacing: float = 0.03) -> np.ndarray:
    """ACEScg colours of Y = 0.18 on a grid of chromaticities inside the gamut's triangle, N x 3."""
    x, y = np.meshgrid(np.arange(0.1, 0.72, spacing), np.arange(0.04, 0.84, spacing))
    xyz = np.stack([x / y, np.ones_like(x), (1 - x - y) / y], axis=-1).reshape(-1, 3) * 0.18
    rgb = xyz @ np.linalg.inv(pictures.xyz_from_rgb(pictures.ACESCG)).T
    return rgb[(rgb > 1e-3 * rgb.max(axis=1, keepdims=True)).all(axis=1)].astype(np.float32)


def chromaticity(rgb: np.ndarray) -> np.ndarray:
    xyz = rgb.astype(np.float64) @ pictures.xyz_from_rgb(pictures.ACESCG).T
    return xyz[..., :2] / xyz.sum(axis=-1, keepdims=True)


def plot_vector_field(path: Path, before: np.ndarray, after: dict[tuple[str, int], np.ndarray]) -> None:
    """Arrows from each colour's chromaticity to what it becomes: a column a light, a row a degree of adaptation.

    `after[key, percent]` is the transformed `before`, as the recipe day_to_<key>_<percent> makes it.
    """
    locus = spectra.observer()
    locus = locus[:, :2] / locus.sum(axis=1, keepdims=True)
    locus = np.vstack([locus, locus[:1]])
    triangle = np.array([*pictures.ACESCG[0], pictures.ACESCG[0][0]])
    rows = {0: "the eye stays with daylight", 100: "the eye adapts to the light"}
    figure, axes = plt.subplots(
        len(rows), len(LIGHTS), figsize=(15, 11), sharex=True, sharey=True, constrained_layout=True
    )
    start = chromaticity(before)
    colours = pictures.swatch(before / before.max(axis=1, keepdims=True)) / 255 * 0.85
    for row, (percent, title) in zip(axes, rows.items()):
        for panel, light in zip(row, LIGHTS):
            end = chromaticity(after[light.key, percent])
            panel.plot(*locus.T, color="black", linewidth=1)
            panel.plot(*triangle.T, color="grey", linewidth=0.8, linestyle="--")
            panel.quiver(
                *start.T, *(end - start).T, color=colours, angles="xy", scale_units="xy", scale=1,
                width=0.0028, headwidth=4, headlength=5, headaxislength=4.5,
            )
            white = pictures.ACESCG[1]
            panel.plot(*white, marker="+", color="black", markersize=9)
            panel.set(aspect="equal", xlim=(-0.02, 0.80), ylim=(-0.02, 0.88))
            panel.set_title(f"{DAYLIGHT.title} to {light.title} ({light.name}), {title}", fontsize=10)
    for panel in axes[-1]:
        panel.set_xlabel("CIE 1931 x")
    for panel in axes[:, 0]:
        panel.set_ylabel("y")
    figure.suptitle("Where chromaticities go (dashed: ACEScg's gamut, +: its white)")
    figure.savefig(path, dpi=110)
    plt.close(figure)
