# SPDX-License-Identifier: Apache-2.0
"""What colours skin: its chromophores, and how its parameters are distributed among people."""

from __future__ import annotations

import json
import math
from importlib import metadata
from pathlib import Path

from data_export.table import BSD, Columns, Table, encode

SOURCES = Path(__file__).resolve().parents[2] / "data" / "sources"
HAEMOGLOBIN = ("mne", "1.13.2")
UNIT = "decadic, 1/cm per mol/L"


def haemoglobin_table() -> Table:
    """Return the molar extinction of the haemoglobin tetramer, with and without oxygen."""
    from scipy.io import loadmat

    package = metadata.distribution(HAEMOGLOBIN[0])
    rows = loadmat(str(package.locate_file("mne/data/extinction_coef.mat")))["extinct_coef"]
    columns: Columns = {
        name: {float(row[0]): float(row[k]) for row in rows}
        for k, name in ((1, "oxyhaemoglobin"), (2, "deoxyhaemoglobin"))
    }
    content, shape = encode(columns)
    return Table(
        "chromophores/haemoglobin.csv",
        "chromophores",
        "molar extinction",
        UNIT,
        list(columns),
        "Prahl 1998, Optical absorption of hemoglobin (omlc.org), compiled from Gratzer, MRC Labs, and Kollias, "
        f"Wellman Laboratories; {' '.join(HAEMOGLOBIN)}, mne/data/extinction_coef.mat",
        BSD,
        content,
        shape,
        "Of the tetramer, 64500 g/mol: not to be combined with extinctions per haem.",
    )


def pigment_table() -> Table:
    """Return the pigments that are known as fits."""
    document = json.loads((SOURCES / "chromophore_fits.json").read_text(encoding="utf-8"))

    def extinction(terms: list[list[float]], wavelength: float) -> float:
        value = sum(a * math.exp(-(((wavelength - c) / s) ** 2) / 2) for c, s, a in terms)
        # Six digits, so that no mathematical library's last bit shows.
        return float(f"{value:.6g}") if value >= 1e-6 else 0.0

    columns: Columns = {
        pigment["name"]: {float(w): extinction(pigment["terms"], w) for w in range(380, 781)}
        for pigment in document["pigments"]
    }
    content, shape = encode(columns)
    return Table(
        "chromophores/pigments.csv",
        "chromophores",
        "molar extinction",
        UNIT,
        list(columns),
        "Own fits of Gaussians, sources/chromophore_fits.json, to " + "; ".join(p["fitted_to"] for p in document["pigments"]),
        "Apache-2.0",
        content,
        shape,
        "Fits, not measurements: " + ", ".join(f"{p['name']} rms {p['rms']}" for p in document["pigments"]) + " over 380 to 560 nm.",
    )


def skin_prior_table() -> Table:
    """Return the prior of the skin model's parameters."""
    document = json.loads((SOURCES / "skin_prior.json").read_text(encoding="utf-8"))
    content = (json.dumps(document, indent=1, ensure_ascii=False) + "\n").encode("utf-8")
    return Table(
        "skin_prior.json",
        "skin_prior",
        "distribution of parameters",
        "stated a parameter",
        ["skin prior"],
        document["source"],
        "Apache-2.0",
        content,
        None,
        "Means, standard deviations, correlations and the model's mean misfit; fits, not measurements.",
    )


def skin_network_table() -> Table:
    """Return the weights that script/train_skin.py found, as they are."""
    content = (SOURCES / "skin_network.json").read_bytes()
    return Table(
        "skin_network.json",
        "skin_network",
        "weights of networks",
        "none",
        ["skin network"],
        json.loads(content)["source"],
        "Apache-2.0",
        content,
        None,
        "Trained on draws of the model, not on measurements.",
    )


def skin_tables() -> list[Table]:
    """Return the chromophores, the prior and the networks."""
    return [haemoglobin_table(), pigment_table(), skin_prior_table(), skin_network_table()]
