# SPDX-License-Identifier: Apache-2.0
"""Measured tables of data/, and the smoothest reflectance, written down a second time for the plots.

The engine is C++ (sip/). This file draws what it does with a general solver instead.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import quadprog

DATA = Path(__file__).resolve().parent.parent / "data"
WAVELENGTHS = np.arange(380.0, 781.0)  # nm


def table(file: str) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Wavelengths in nm and the columns of one table."""
    with open(DATA / file, newline="", encoding="utf-8") as stream:
        rows = list(csv.reader(stream))
    numbers = np.array(rows[1:], dtype=float)
    return numbers[:, 0], dict(zip(rows[0][1:], numbers[:, 1:].T))


def illuminant(file: str, name: str) -> np.ndarray:
    """Relative power on WAVELENGTHS, zero outside its table."""
    wavelengths, columns = table(file)
    return np.interp(WAVELENGTHS, wavelengths, columns[name], left=0, right=0)


def observer() -> np.ndarray:
    """CIE 1931 2 degree colour matching functions, 401 x 3."""
    wavelengths, columns = table("observers/cie_1931_2.csv")
    return np.stack([np.interp(WAVELENGTHS, wavelengths, columns[c], left=0, right=0) for c in "XYZ"], axis=1)


def reflectance(name: str) -> np.ndarray:
    """One patch of the ColorChecker, end values held."""
    wavelengths, columns = table("reflectances/colorchecker.csv")
    return np.interp(WAVELENGTHS, wavelengths, columns[name])


def smoothest(measured: np.ndarray, light: np.ndarray, bands: int = 81) -> tuple[np.ndarray, np.ndarray]:
    """Band centres and smoothest reflectance with the tristimulus that `measured` has under `light`.

    Minimises the sum of squared differences of neighbours, subject to the tristimulus and to nothing below zero.
    """
    centres = np.linspace(WAVELENGTHS[0], WAVELENGTHS[-1], bands)
    hats = np.stack([np.interp(WAVELENGTHS, centres, unit) for unit in np.eye(bands)])
    response = light[:, None] * observer()
    response = response / response[:, 1].sum()
    weights = (hats @ response).T
    differences = np.diff(np.eye(bands), axis=0)
    cost = 2 * differences.T @ differences + 1e-9 * np.eye(bands)  # the solver wants strict convexity
    constraints = np.vstack([weights, np.eye(bands)]).T
    bounds = np.concatenate([response.T @ measured, np.zeros(bands)])
    return centres, quadprog.solve_qp(cost, np.zeros(bands), constraints, bounds, 3)[0]
