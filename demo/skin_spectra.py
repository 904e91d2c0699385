# SPDX-License-Identifier: Apache-2.0
"""The figures of docs/skin.md that show spectra, and the study of how finely they must be known."""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import metamer
from metamer import skin
from pictures import SRGB, xyz_from_rgb

WAVELENGTHS = np.arange(380, 781, 10)
MEAN = [0.0325, 0.0245, 93.2, 0.1775, 0.4394]
XYZ_FROM_RGB = xyz_from_rgb(SRGB)
# The levels of figure 3.3, as printed but for 28.9 %, where 29.9 % breaks the even spacing of the roots.
MELANIN = np.array([0.2, 0.7, 2.3, 5.4, 10.6, 18.2, 28.9, 43.1]) / 100
BLOOD = np.array([0.1, 0.2, 0.7, 2, 4.5, 9.6, 17.7, 30]) / 100
STEPS = (2, 10, 20, 80)


def srgb_from_linear(linear: np.ndarray) -> np.ndarray:
    light = np.clip(linear, 0, 1)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def colours(estimator: skin.Estimator, skins: np.ndarray) -> np.ndarray:
    """Linear Rec.709 of skins: maps without a residual."""
    maps = np.zeros((len(skins), 9))
    maps[:, :5] = skins
    maps[:, 5] = 1
    return estimator.colour(maps)


def squares(axes: plt.Axes, rgb: np.ndarray) -> None:
    """Colours side by side; rgb: linear, rows x columns x 3."""
    axes.imshow(srgb_from_linear(rgb), aspect="auto", interpolation="nearest")
    axes.set(xticks=[], yticks=[])


def chromophores(estimator: skin.Estimator, file: Path) -> None:
    """What absorbs in skin, and what more of it does to the albedo (figure 3.3)."""
    figure, panels = plt.subplots(2, 3, figsize=(14, 5.6), layout="constrained", height_ratios=[6, 1])
    fine = np.arange(380, 781)
    for name, values in skin.absorption(fine).items():
        panels[0, 0].semilogy(fine, values, label=name.replace("_", ", "))
    panels[0, 0].set(title="Absorption, each alone", xlabel="nm", ylabel="1/cm", ylim=(1e-2, None))
    panels[0, 0].legend(fontsize=8)
    panels[1, 0].axis("off")
    rest = [93.2, 0.7, 0.25]
    for column, (title, skins) in enumerate((("Melanin, blood at 2 %", [[m, 0.02, *rest] for m in MELANIN]),
                                             ("Blood, melanin at 0.8 %", [[0.008, b, *rest] for b in BLOOD])), 1):
        skins = np.array(skins)
        rgb = colours(estimator, skins)
        for one, spectrum, colour in zip(skins, skin.albedo(skins, repair=False), srgb_from_linear(rgb)):
            panels[0, column].plot(WAVELENGTHS, spectrum, color=colour, linewidth=2.5, label=f"{100 * one[column - 1]:.1f} %")
        panels[0, column].set(title=title, xlabel="nm", ylabel="albedo", ylim=(0, 0.9))
        panels[0, column].legend(fontsize=7, ncols=2, loc="upper left")
        squares(panels[1, column], rgb[None])
    figure.savefig(file, dpi=75)
    plt.close(figure)


def resolution(file: Path) -> None:
    """Skins known every 2, 10, 20 and 80 nm, straight between (figure 3.4), and the errors of 300 people."""
    fine = np.arange(380, 781)
    seen = {light: np.array([metamer.tristimulus(dict(zip(fine, hat)), light, "CIE 1931 2") for hat in np.eye(401)]).T
            for light in ("D65", "FL11", "LED-RGB1")}
    to_rgb = np.linalg.inv(XYZ_FROM_RGB)

    def known_every(step: int, skins: np.ndarray) -> np.ndarray:
        at = np.arange(380, 781, step)
        return np.array([np.interp(fine, at, one) for one in skin.albedo_at(skins, at)])

    people = skin.sample(300, seed=3)
    truth = skin.albedo_at(people, fine)
    print("step nm   bands   rms of spectra   W contrast rms   mean (largest) CIEDE2000 in D65, FL11, LED-RGB1")
    for step in STEPS:
        found = known_every(step, people)
        contrast = [s[:, 180] - (s[:, 162] + s[:, 197]) / 2 for s in (found, truth)]
        errors = []
        for light, weights in seen.items():
            white = weights.sum(axis=1)
            lab = [np.array([metamer.lab(xyz, white) for xyz in s @ weights.T]) for s in (found, truth)]
            each = np.array([metamer.delta_e_2000(a, b) for a, b in zip(*lab)])
            errors.append(f"{each.mean():.3f} ({each.max():.3f})")
        print(f"{step:7} {400 // step + 1:7} {np.sqrt(np.mean((found - truth) ** 2)):16.5f} "
              f"{np.sqrt(np.mean((contrast[0] - contrast[1]) ** 2)):16.5f}   {', '.join(errors)}")

    types = np.array([[m, *MEAN[1:]] for m in np.linspace(0.2, 0.7, 6) ** 3])
    figure, panels = plt.subplots(2, 6, figsize=(15, 4.4), layout="constrained", height_ratios=[3, 1], sharey="row")
    for column, one in enumerate(types):
        rgb = []
        for step in STEPS:
            spectrum = known_every(step, one[None])[0]
            panels[0, column].plot(fine, spectrum, linewidth=1.2, label=f"{step} nm")
            rgb.append(to_rgb @ (seen["D65"] @ spectrum))
        panels[0, column].set(title=f"melanin {100 * one[0]:.1f} %", xlabel="nm", ylim=(0, None))
        squares(panels[1, column], np.array(rgb)[None])
        panels[1, column].set_xlabel("  ".join(f"{step}" for step in STEPS) + " nm", fontsize=8)
    panels[0, 0].legend(fontsize=8)
    figure.savefig(file, dpi=75)
    plt.close(figure)


def manifold(estimator: skin.Estimator, file: Path) -> None:
    """The W's contrast, lightness and the colours that melanin and blood span."""
    figure, (contrast, lightness, plane) = plt.subplots(1, 3, figsize=(15, 4.8), layout="constrained")
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
    figure.savefig(file, dpi=75)
    plt.close(figure)
