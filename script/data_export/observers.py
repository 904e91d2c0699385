# SPDX-License-Identifier: Apache-2.0
"""Colour matching functions, cone fundamentals and camera sensitivities."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from data_export.table import BSD, COLOUR, RAWTOACES, Table, encode, read_columns, triples

SOURCES = Path(__file__).resolve().parents[2] / "data" / "sources"

CVRL = "CVRL, Stockman and Sharpe 2000, adopted in CIE 170-1:2006"
NPL = "Darrodi, Finlayson, Goodman, Mackiewicz 2015 (NPL), doi:10.1364/JOSAA.32.000381"

OBSERVER_FUNCTIONS = (
    # file, name, response, name in colour-science, source, note
    (
        "cie_1931_2",
        "CIE 1931 2",
        "xyz",
        "CIE 1931 2 Degree Standard Observer",
        "CIE 1931 2 degree standard observer, CVRL tables",
        "",
    ),
    (
        "cie_1964_10",
        "CIE 1964 10",
        "xyz",
        "CIE 1964 10 Degree Standard Observer",
        "CIE 1964 10 degree standard observer, CVRL tables",
        "",
    ),
    (
        "cie_2015_2",
        "CIE 2015 2",
        "xyz",
        "CIE 2015 2 Degree Standard Observer",
        "CIE 170-2:2015, 2 degrees, CVRL tables",
        "Starts at 390 nm; zero below.",
    ),
    (
        "cie_2015_10",
        "CIE 2015 10",
        "xyz",
        "CIE 2015 10 Degree Standard Observer",
        "CIE 170-2:2015, 10 degrees, CVRL tables",
        "Starts at 390 nm; zero below.",
    ),
    (
        "cie_2006_lms_2",
        "CIE 2006 LMS 2",
        "lms",
        "Stockman & Sharpe 2 Degree Cone Fundamentals",
        f"{CVRL}, 2 degrees",
        "Starts at 390 nm; zero below. S was not measurable above 615 nm and is zero there.",
    ),
    (
        "cie_2006_lms_10",
        "CIE 2006 LMS 10",
        "lms",
        "Stockman & Sharpe 10 Degree Cone Fundamentals",
        f"{CVRL}, 10 degrees",
        "Starts at 390 nm; zero below. S was not measurable above 615 nm and is zero there.",
    ),
)


def observer(
    stem: str,
    name: str,
    response: str,
    columns: list[dict[float, float]],
    source: str,
    licence: str,
    note: str,
    to_xyz: list[list[float]] | None = None,
) -> Table:
    """Return one observer's table."""
    labels = {"xyz": "XYZ", "lms": "LMS", "camera": "RGB"}[response]
    content, shape = encode(dict(zip(labels, columns, strict=True)))
    extra: dict[str, Any] = {"response": response}
    if to_xyz is not None:
        extra["to_xyz"] = to_xyz
    return Table(
        f"observers/{stem}.csv",
        "observers",
        "sensitivity",
        "relative",
        [name],
        source,
        licence,
        content,
        shape,
        note,
        extra,
    )


def fitted(parameters: list[float], wavelength: float) -> float:
    """Return the two-term exponential of the camera fits at a wavelength.

    Rounded to six significant digits, so that no mathematical library's last
    bit shows.
    """
    a, b, c, d, e, f, g, h, i, j = parameters
    x = wavelength
    value = a * math.exp(-b * x * ((x - c) / d) ** i) + e * math.exp(-f * x * ((x - g) / h) ** j)
    return float(f"{value:.6g}")


CANON_CURVES = (
    " The curves it was fitted to (the PhysLight project's, after Jiang et al. 2013) are licensed "
    "for non-commercial use and are not included."
)
CAMERA_FIT_NOTES = {
    "Red Mysterium X (fit)": "The tails do not reach zero: R is 0.013 and B 0.034 at 380 nm. "
    "to_xyz suits light near D65, without white balance.",
    "Canon 1D MkIII (fit)": "to_xyz suits light near D55, without white balance." + CANON_CURVES,
    "Canon 5D MkII (fit)": "About a tenth too large against the curves it was fitted to, so "
    "that to_xyz gives Y about a tenth too high. to_xyz suits light near D55, without white "
    "balance." + CANON_CURVES,
}


def camera_fit_tables() -> list[Table]:
    """Return the cameras that are published as analytic fits."""
    published = json.loads((SOURCES / "camera_fits.json").read_text(encoding="utf-8"))
    out = []
    for camera in published["cameras"]:
        name = camera["name"]
        parameters = {curve: list(values) for curve, values in camera["printed"].items()}
        note = (
            f"A fit, not a measurement: {published['form']}; parameters in "
            "sources/camera_fits.json, values rounded to six significant digits."
        )
        for fix in camera["corrections"]:
            place = "abcdefghij".index(fix["parameter"])
            if parameters[fix["curve"]][place] != fix["printed"]:
                raise ValueError(f"{name}: the printed parameter is not the corrected one")
            parameters[fix["curve"]][place] = fix["used"]
            note += (
                f" Corrected: {fix['parameter']} of {fix['curve']} is {fix['used']!r} and not "
                f"{fix['printed']!r} as printed, because {fix['reason']}."
            )
        note += " " + CAMERA_FIT_NOTES[name]
        stem = name.removesuffix(" (fit)").lower().replace(" ", "_") + "_fit"
        columns = [
            {float(w): fitted(parameters[k], w) for w in range(380, 781, 5)} for k in "RGB"
        ]
        out.append(
            observer(
                stem,
                name,
                "camera",
                columns,
                published["citation"],
                "No licence stated; parameters quoted from the publication, copyright its authors",
                note,
                camera["camera_to_xyz"],
            )
        )
    return out


def observer_tables(colour: Any) -> list[Table]:
    """Return the standard observers and the cameras."""
    from colour.characterisation.datasets.aces_it import MSDS_ACES_RICD

    out = [
        observer(
            stem,
            name,
            response,
            triples(colour.MSDS_CMFS[key]),
            f"{source}; {COLOUR}",
            BSD,
            note,
        )
        for stem, name, response, key, source, note in OBSERVER_FUNCTIONS
    ]
    cameras = colour.MSDS_CAMERA_SENSITIVITIES
    out.append(
        observer(
            "nikon_d5100",
            "Nikon D5100",
            "camera",
            triples(cameras["Nikon 5100 (NPL)"]),
            f"{NPL}; {COLOUR}",
            BSD,
            "Each channel has its own peak at 1.",
        )
    )
    out.append(
        observer(
            "sigma_sdmerrill",
            "Sigma SDMerrill",
            "camera",
            triples(cameras["Sigma SDMerill (NPL)"]),
            f"{NPL}; {COLOUR}",
            BSD,
            "Each channel has its own peak at 1. 400 to 680 nm; zero outside.",
        )
    )
    out.append(
        observer(
            "aces_ricd",
            "ACES RICD",
            "camera",
            triples(MSDS_ACES_RICD),
            f"Academy TB-2014-004, reference input capture device of SMPTE ST 2065-1; {COLOUR}",
            BSD,
            "A definition: the CIE 1931 2 degree functions in ACES2065-1 primaries, each "
            "channel scaled to unit sum.",
        )
    )
    canon = read_columns(
        Path(colour.__file__).parent
        / "characterisation/datasets/rawtoaces/CANON_EOS_5DMark_II_RGB_Sensitivities.csv"
    )
    out.append(
        observer(
            "canon_eos_5d_mark_ii",
            "Canon EOS 5D Mark II",
            "camera",
            [canon[k] for k in "RGB"],
            f"{RAWTOACES}, CANON_EOS_5DMark_II_RGB_Sensitivities; {COLOUR}",
            BSD,
            "As published, with the measurement's floor of 0.03 at 380 nm left in.",
        )
    )
    return out + camera_fit_tables()
