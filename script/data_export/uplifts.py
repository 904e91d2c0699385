# SPDX-License-Identifier: Apache-2.0
"""Bases of published ways from a colour to a reflectance."""

from __future__ import annotations

import json
from typing import Any

from data_export.table import BSD, COLOUR, Table, number


def uplift(stem: str, name: str, document: dict[str, Any], source: str, note: str) -> Table:
    """Return one basis's table, a curve a line."""

    def line(key: str, value: Any) -> str:
        return f"  {json.dumps(key)}: {json.dumps(value)}"

    parts = []
    for field, value in document.items():
        if isinstance(value, dict):
            rows = ",\n".join(line(key, row) for key, row in value.items())
            parts.append(f" {json.dumps(field)}: {{\n{rows}\n }}")
        else:
            parts.append(f" {json.dumps(field)}: {json.dumps(value)}")
    text = "{\n" + ",\n".join(parts) + "\n}\n"
    return Table(
        f"uplifts/{stem}.json",
        "uplifts",
        "basis of reflectances",
        "1",
        [name],
        f"{source}; {COLOUR}",
        BSD,
        text.encode("utf-8"),
        note=note,
    )


def numbers(values: Any) -> list[float]:
    """Return plain numbers, each the shortest decimal that reads back."""
    return [float(number(v)) for v in values]


def uplift_tables(colour: Any) -> list[Table]:
    """Return the bases of Smits, of Mallett and Yuksel, and of Otsu and others."""
    from colour.recovery.datasets import otsu2018
    from colour.recovery.datasets.mallett2019 import MSDS_BASIS_FUNCTIONS_sRGB_MALLETT2019
    from colour.recovery.datasets.smits1999 import SDS_SMITS1999

    smits = ("white", "cyan", "magenta", "yellow", "red", "green", "blue")
    mallett = MSDS_BASIS_FUNCTIONS_sRGB_MALLETT2019
    clusters = {}
    for k, mean in enumerate(otsu2018.CLUSTER_MEANS_OTSU2018):
        clusters[f"mean {k}"] = numbers(mean)
        for j, curve in enumerate(otsu2018.BASIS_FUNCTIONS_OTSU2018[k]):
            clusters[f"basis {k} {j}"] = numbers(curve)
    return [
        uplift(
            "smits_1999",
            "smits",
            {
                "wavelengths_nm": numbers(SDS_SMITS1999["white"].wavelengths),
                "curves": {name: numbers(SDS_SMITS1999[name].values) for name in smits},
            },
            "Smits 1999, An RGB-to-spectrum conversion for reflectances, Journal of Graphics "
            "Tools 4(4):11-22, table 1",
            "Made for primaries xy (.64,.33), (.3,.6), (.15,.06) under equal energy.",
        ),
        uplift(
            "mallett_2019",
            "mallett",
            {
                "wavelengths_nm": numbers(mallett.wavelengths),
                "curves": {
                    name: numbers(mallett.values[:, k])
                    for k, name in enumerate(("red", "green", "blue"))
                },
            },
            "Mallett, Yuksel 2019, Spectral primary decomposition for rendering with sRGB "
            "reflectance, doi:10.2312/sr.20191216",
            "Made for Rec.709 under D65. The curves add to 1 within 1e-5 at each wavelength.",
        ),
        uplift(
            "otsu_2018",
            "otsu",
            {
                "wavelengths_nm": numbers(otsu2018.SPECTRAL_SHAPE_OTSU2018.wavelengths),
                "selector": [numbers(row) for row in otsu2018.SELECTOR_ARRAY_OTSU2018],
                "curves": clusters,
            },
            "Otsu, Yamamoto, Hachisuka 2018, Reproducing spectral reflectances from tristimulus "
            "colours, doi:10.1111/cgf.13332",
            "Eight clusters of measured reflectances: mean and three principal components each. "
            "A row of the selector: bound, coordinate (0: x, 1: y), where to go at or below the "
            "bound and above it: a cluster, or the row of the opposite number.",
        ),
    ]
