# SPDX-License-Identifier: Apache-2.0
"""CIE illuminants, measured lamps and the daylight basis."""

from __future__ import annotations

from typing import Any

from data_export.table import BSD, COLOUR, ISO7589, Table, encode, pairs

CIE15 = "CIE 015:2018 Colorimetry, 4th edition, and CIE 15:2004 tables"
POINTER = "Pointer 1980, Pointer's gamut data, PointerData.xls (RIT)"
CQS = "NIST CQS simulation 7.4 (Ohno, Davis 2008)"

ILLUMINANT_TABLES = (
    ("cie_standard", ("A", "C", "D50", "D55", "D65", "D75", "ID50", "ID65"), CIE15, ""),
    ("cie_b", ("B",), CIE15, "Withdrawn by the CIE; kept for old data."),
    (
        "cie_d60",
        ("D60",),
        CIE15,
        "A model: calculated with the CIE daylight formula.",
    ),
    ("cie_e", ("E",), CIE15, "A definition: equal energy."),
    (
        "cie_fl",
        (*(f"FL{n}" for n in range(1, 13)), *(f"FL3.{n}" for n in range(1, 16))),
        CIE15,
        "",
    ),
    (
        "cie_hp",
        tuple(f"HP{n}" for n in range(1, 6)),
        CIE15,
        "HP1 is the standard high-pressure sodium lamp, HP2 the colour-enhanced one, "
        "HP3 to HP5 are metal halide lamps.",
    ),
    (
        "cie_led",
        (*(f"LED-B{n}" for n in range(1, 6)), "LED-BH1", "LED-RGB1", "LED-V1", "LED-V2"),
        CIE15,
        "Typical LED illuminants: B blue-pumped phosphor, BH with red added, "
        "RGB three chips, V violet-pumped phosphor.",
    ),
    (
        "iso_7589",
        tuple(
            f"ISO 7589 {kind}"
            for kind in (
                "Photographic Daylight",
                "Sensitometric Daylight",
                "Studio Tungsten",
                "Sensitometric Studio Tungsten",
                "Photoflood",
                "Sensitometric Photoflood",
            )
        ),
        ISO7589,
        "Ends at 690 nm; zero beyond. Sensitometric kinds include the ISO standard lens.",
    ),
    (
        "iso_7589_printer",
        ("ISO 7589 Sensitometric Printer",),
        ISO7589,
        "Ends at 560 nm; zero beyond.",
    ),
)


def illuminant_tables(colour: Any) -> list[Table]:
    """Return the CIE and ISO illuminants and the measured light sources."""
    from colour.colorimetry.datasets.light_sources import sds as lamps

    lps = (
        "LPS (low-pressure sodium) is one 5 nm sample at 590 nm and zero elsewhere: "
        "interpolate linearly, never with a smooth kernel."
    )
    sets = [
        (name, {n: colour.SDS_ILLUMINANTS[n] for n in members}, f"{source}; {COLOUR}", note)
        for name, members, source, note in ILLUMINANT_TABLES
    ]
    listed = [n for _, members, _, _ in ILLUMINANT_TABLES for n in members]
    if sorted(listed) != sorted(colour.SDS_ILLUMINANTS):
        raise ValueError("the illuminants of colour-science are not the ones listed here")
    sets += [
        ("lamps_rit", dict(lamps.SDS_LIGHT_SOURCES_RIT), f"{POINTER}; {COLOUR}", ""),
        (
            "lamps_nist_traditional",
            dict(lamps.SDS_LIGHT_SOURCES_NIST_TRADITIONAL),
            f"{CQS}, traditional sources; {COLOUR}",
            lps + " 'Neodimium' is the source's spelling.",
        ),
        (
            "lamps_nist_led",
            dict(lamps.SDS_LIGHT_SOURCES_NIST_LED),
            f"{CQS}, LED sources; {COLOUR}",
            "The sources named after peak wavelengths (in nm) are models of mixed chips.",
        ),
        (
            "lamps_nist_philips",
            dict(lamps.SDS_LIGHT_SOURCES_NIST_PHILIPS),
            f"{CQS}, Philips sources; {COLOUR}",
            "",
        ),
        (
            "lamps_projector",
            dict(lamps.SDS_LIGHT_SOURCES_COMMON),
            f"Borer, private communication 2017 (Kinoton 75P xenon projector); {COLOUR}",
            "",
        ),
    ]
    lamp_names = [n for name, members, _, _ in sets if name.startswith("lamps_") for n in members]
    if sorted(lamp_names) != sorted(colour.SDS_LIGHT_SOURCES):
        raise ValueError("the light sources of colour-science are not the ones listed here")
    out = []
    for name, members, source, note in sets:
        content, shape = encode({n: pairs(sd) for n, sd in members.items()})
        out.append(
            Table(
                f"illuminants/{name}.csv",
                "illuminants",
                "spectral power distribution",
                "relative",
                list(members),
                source,
                BSD,
                content,
                shape,
                note,
            )
        )
    return out


def daylight_basis_table(colour: Any) -> Table:
    """Return the three components from which the CIE builds daylight."""
    components = colour.colorimetry.SDS_BASIS_FUNCTIONS_CIE_ILLUMINANT_D_SERIES
    names = ["S0", "S1", "S2"]
    content, shape = encode({n: pairs(components[n]) for n in names})
    return Table(
        "illuminants/cie_daylight_components.csv",
        "daylight_basis",
        "spectral power distribution",
        "relative",
        names,
        f"CIE 015:2018 Colorimetry, 4th edition, table 6; {COLOUR}",
        BSD,
        content,
        shape,
        "Components of S0 + M1 S1 + M2 S2, not lights of their own: S1 and S2 go below zero.",
    )
