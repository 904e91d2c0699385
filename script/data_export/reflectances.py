# SPDX-License-Identifier: Apache-2.0
"""Charts and test colours."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from data_export.table import BSD, COLOUR, RAWTOACES, Columns, Table, crop, encode, hundredth, pairs, read_columns

DATA = Path(__file__).resolve().parents[2] / "data"
SOURCES = DATA / "sources"
# Made by the program: kept as it is.
VIRTUAL_SKINS = DATA / "reflectances" / "virtual_skins.csv"
RESIDUE = 1e-12  # negative reflectances smaller than this are rounding, not data


def reflectance(
    stem: str, name: str, columns: Columns, source: str, note: str, licence: str = BSD
) -> Table:
    """Return one reflectance set's table."""
    content, shape = encode(columns)
    return Table(
        f"reflectances/{stem}.csv",
        "reflectances",
        "reflectance",
        "1",
        [name],
        source,
        licence,
        content,
        shape,
        note,
    )


def reflectance_tables(colour: Any) -> list[Table]:
    """Return the charts, the colour-quality samples, training patches and skin."""
    from colour.characterisation.datasets.colour_checkers.sds import DATA_PMC
    from colour.quality.cfi2017 import load_TCS_CIE2017
    from colour.quality.datasets import SDS_TCS, SDS_VS

    package = Path(colour.__file__).parent

    def columns(sds: Any) -> Columns:
        return {name: pairs(sds[name]) for name in sds}

    held = "{} to {} nm; the end values are held outside.".format
    ces = load_TCS_CIE2017(colour.SpectralShape(380, 780, 5))
    ces_columns: Columns = {
        f"CES{k + 1:02d}": {
            float(w): float(v) for w, v in zip(ces.wavelengths, ces.values[:, k], strict=True)
        }
        for k in range(99)
    }
    tcs_columns = {n: crop(c, 380, 780) for n, c in columns(SDS_TCS["CIE 2024"]).items()}
    patches = {
        name: {w: 0.0 if -RESIDUE < v < 0.0 else v for w, v in column.items()}
        for name, column in read_columns(
            package / "characterisation/datasets/rawtoaces/190_Patches.csv"
        ).items()
    }
    ohta = colour.SDS_COLOURCHECKERS["ColorChecker N Ohta"]
    ces_source = (
        "CIE 224:2017, the 99 colour evaluation samples that ANSI/IES TM-30-18 and later share"
    )
    tcs_source = (
        "CIE 13.3-1995 test colours 1 to 14 (NIST CQS simulation 7.4) and CIE 2024 test "
        "colour 15, doi:10.25039/CIE.DS.7chm7z5h"
    )
    return [
        reflectance(
            "colorchecker",
            "colorchecker",
            columns(colour.SDS_COLOURCHECKERS["BabelColor Average"]),
            f"BabelColor 2012, average of 30 ColorChecker Classic charts; {COLOUR}",
            held(380, 730) + " Data copyright 2004-2012 Danny Pascale (www.babelcolor.com), used "
            "by colour-science with permission.",
        ),
        reflectance(
            "colorchecker_ohta",
            "colorchecker ohta",
            columns(ohta),
            f"Ohta 1997, The basis of color reproduction engineering; {COLOUR}",
            "The same numbers as colorchecker iso 17321-1.",
        ),
        reflectance(
            "colorchecker_iso_17321_1",
            "colorchecker iso 17321-1",
            columns(colour.SDS_COLOURCHECKERS["ISO 17321-1"]),
            f"ISO 17321-1:2012, colour characterisation of digital still cameras; {COLOUR}",
            "The same numbers as colorchecker ohta.",
        ),
        reflectance(
            "pmc",
            "pmc",
            {n: {float(w): hundredth(v) for w, v in d.items()} for n, d in DATA_PMC.items()},
            "Luo 2024, The new preferred memory color (PMC) chart, doi:10.1002/col.22940; "
            f"{COLOUR}",
            held(400, 700) + " The patches imitate the objects they are named after.",
        ),
        reflectance("tm30", "tm30", ces_columns, f"{ces_source}; {COLOUR}", "The 5 nm edition."),
        reflectance(
            "cri",
            "cri",
            tcs_columns,
            f"{tcs_source}; {COLOUR}",
            "Test colours 1 to 14 are cut from 360-830 nm to the 380-780 nm of test colour 15; "
            "nothing is interpolated.",
        ),
        reflectance(
            "cqs",
            "cqs",
            columns(SDS_VS["NIST CQS 9.0"]),
            f"NIST Color Quality Scale 9.0 (Ohno, Davis), samples VS1 to VS15; {COLOUR}",
            "",
        ),
        reflectance(
            "rawtoaces_190",
            "rawtoaces 190",
            patches,
            f"{RAWTOACES}, training set 190_Patches; {COLOUR}",
            "Negative values of rounding size (above -1e-12) are set to zero. Patches 85, 89, 114, "
            "125 and 128 pass 1 beyond 700 nm (1.44 at most), as published.",
        ),
        reflectance(
            "skin",
            "skin",
            {
                "CES15": ces_columns["CES15"],
                "CES18": ces_columns["CES18"],
                "TCS15": tcs_columns["TCS15"],
            },
            f"{ces_source}; {tcs_source}; {COLOUR}",
            "Samples that their standards call skin: CES15 and CES18, over which TM-30 takes its "
            "skin fidelity, and CRI test colour 15 (Japanese skin complexion). Not CRI test colour 13 "
            "(light yellowish pink, human complexion): it has no haemoglobin, a paint of skin's colour. "
            "Three samples, all light to medium: dark skin is not represented.",
        ),
        reflectance(
            "model_skins",
            "model skins",
            read_columns(SOURCES / "model_skins_100.csv"),
            "100 draws from a prior of the parameters of a two-layer skin model, with the model's "
            "mean misfit applied; the prior was fitted to every other subject of Cooksey, Allen, "
            "Tsai 2017, Reference data set of human skin reflectance, J. Res. NIST 122:26",
            "Modelled, not measured: sources/model_skins_100.csv. All depths of skin.",
            "Apache-2.0",
        ),
        reflectance(
            "virtual_skins",
            "virtual skins",
            read_columns(VIRTUAL_SKINS),
            "1000 draws of metamer::skin (seed 1) from data/skin_prior.json, the model's mean misfit "
            "repaired; written by script/virtual_skins.py",
            "Modelled, not measured. All depths of skin.",
            "Apache-2.0",
        ),
    ]
