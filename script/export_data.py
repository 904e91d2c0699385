#!/usr/bin/env python3
"""Regenerate the measured tables in data/ from pinned registry packages.

Needs Python 3.11 or newer with colour-science 0.4.7 and lighting-filters
0.1.1 installed. The output is the same byte for byte on every run.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import io
import json
import math
import sys
import warnings
from dataclasses import dataclass, field
from decimal import Decimal
from importlib import metadata
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
SOURCES = ROOT / "data" / "sources"

PINNED = {"colour-science": "0.4.7", "lighting-filters": "0.1.1"}
RETRIEVED = "2026-11-22"
COLOUR = "colour-science 0.4.7"
GELS = "lighting-filters 0.1.1"
BSD = "BSD-3-Clause"
RESIDUE = 1e-12  # negative reflectances smaller than this are rounding, not data

GROUPS = ("illuminants", "daylight_basis", "observers", "filters", "reflectances", "rgb_spaces")

# Column name -> {wavelength in nm: value}
Columns = dict[str, dict[float, float]]


@dataclass
class Table:
    """One file of data/ with its manifest entry."""

    file: str
    group: str
    quantity: str
    unit: str
    names: list[str]
    source: str
    licence: str
    content: bytes
    shape: dict[str, float] | None = None
    note: str = ""
    extra: dict[str, Any] = field(default_factory=dict)

    def entry(self) -> dict[str, Any]:
        """Return the manifest entry."""
        out: dict[str, Any] = {
            "file": self.file,
            "group": self.group,
            "quantity": self.quantity,
            "unit": self.unit,
        }
        if self.shape is not None:
            out["shape"] = self.shape
        out["names"] = self.names
        out.update(self.extra)
        out["source"] = self.source
        out["licence"] = self.licence
        out["retrieved"] = RETRIEVED
        out["sha256"] = hashlib.sha256(self.content).hexdigest()
        if self.note:
            out["note"] = self.note
        return out


def number(value: float) -> str:
    """Return the shortest decimal that reads back as the same double."""
    return repr(float(value))


def whole(value: float) -> float:
    """Return an integer where the value is one."""
    return int(value) if float(value).is_integer() else float(value)


def hundredth(value: float) -> float:
    """Return value / 100, rounded once in decimal and not in binary."""
    return float(Decimal(repr(float(value))) / 100)


def encode(columns: Columns, labels: list[str] | None = None) -> tuple[bytes, dict[str, float]]:
    """Return the CSV text of columns that share one shape, and that shape."""
    first = next(iter(columns.values()))
    wavelengths = sorted(first)
    steps = {b - a for a, b in zip(wavelengths, wavelengths[1:])}
    if len(steps) != 1:
        raise ValueError(f"{next(iter(columns))}: uneven wavelengths, steps {sorted(steps)}")
    for name, column in columns.items():
        if sorted(column) != wavelengths:
            raise ValueError(f"{name}: not the wavelengths of the columns beside it")
        if not all(math.isfinite(v) for v in column.values()):
            raise ValueError(f"{name}: a value is not finite")
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["wavelength_nm", *(labels or columns)])
    for w in wavelengths:
        writer.writerow([whole(w), *(number(c[w]) for c in columns.values())])
    shape = {
        "start_nm": whole(wavelengths[0]),
        "end_nm": whole(wavelengths[-1]),
        "interval_nm": whole(steps.pop()),
    }
    return text.getvalue().encode("utf-8"), shape


def pairs(distribution: Any) -> dict[float, float]:
    """Return the samples of a colour-science spectral distribution."""
    return {
        float(w): float(v)
        for w, v in zip(distribution.wavelengths, distribution.values, strict=True)
    }


def triples(distributions: Any) -> list[dict[float, float]]:
    """Return the three columns of colour-science multi-spectral distributions."""
    return [
        {
            float(w): float(row[k])
            for w, row in zip(distributions.wavelengths, distributions.values, strict=True)
        }
        for k in range(3)
    ]


def read_columns(path: Path) -> Columns:
    """Read a CSV file with a header and wavelengths in its first column."""
    with path.open(encoding="utf-8", newline="") as stream:
        header, *rows = csv.reader(stream)
    return {
        name: {float(row[0]): float(row[k + 1]) for row in rows}
        for k, name in enumerate(header[1:])
    }


def crop(column: dict[float, float], low: float, high: float) -> dict[float, float]:
    """Return the samples between two wavelengths, both included."""
    return {w: v for w, v in column.items() if low <= w <= high}


# Illuminants ---------------------------------------------------------------

CIE15 = "CIE 015:2018 Colorimetry, 4th edition, and CIE 15:2004 tables"
ISO7589 = "ISO 7589:2002 Photography, illuminants for sensitometry"
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


# Observers -----------------------------------------------------------------

CVRL = "CVRL, Stockman and Sharpe 2000, adopted in CIE 170-1:2006"
NPL = "Darrodi, Finlayson, Goodman, Mackiewicz 2015 (NPL), doi:10.1364/JOSAA.32.000381"
RAWTOACES = "RAW to ACES 1.0 (Dyer, Forsythe, Irons, Mansencal, Zhu 2017)"

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


# Filters -------------------------------------------------------------------

LEE_NUMBERS = {
    "colour temperature": (
        "200 201 202 203 204 205 206 207 208 218 223 236 237 238 281 283 285 286 287 "
        "441 442 443 444"
    ),
    "green and fluorescent correction": "219 241 242 243 244 245 246 247 248 249 278 279",
    "neutral density": "209 210 211 298 299",
    "reds and ambers": (
        "020 021 022 024 026 027 029 105 106 134 135 147 151 158 164 179 182 550 778 787"
    ),
    "yellows and straws": "010 013 015 100 101 102 103 764 765 767",
    "pinks and lavenders": "004 036 048 058 110 113 126 128 154 180 332 345",
    "blues": (
        "061 063 068 071 079 085 117 118 119 120 132 141 161 165 174 181 183 195 196 "
        "363 711 712 716 721"
    ),
    "cyans and greens": "088 089 115 116 121 122 124 138 139 323 327 728 730 731 733 736 738 740",
    "sodium and mercury looks": "642 650 651 652 653 741",
}


def filter_tables(colour: Any) -> list[Table]:
    """Return the ISO filters and a working set of Lee gels."""
    out = []
    for stem, name, sd in (
        ("iso_7589_diffuser", "ISO 7589 Diffuser", colour.SDS_FILTERS["ISO 7589 Diffuser"]),
        ("iso_standard_lens", "ISO Standard Lens", colour.SDS_LENSES["ISO Standard Lens"]),
    ):
        content, shape = encode({name: pairs(sd)})
        out.append(
            Table(
                f"filters/{stem}.csv",
                "filters",
                "transmittance",
                "1",
                [name],
                f"{ISO7589}; {COLOUR}",
                BSD,
                content,
                shape,
                f"{shape['start_nm']} to {shape['end_nm']} nm; the end values are held outside.",
            )
        )
    path = metadata.distribution("lighting-filters").locate_file("dataset/filters.json")
    gels = json.loads(Path(path).read_text(encoding="utf-8"))["filters"]
    columns: Columns = {}
    for n in sorted(" ".join(LEE_NUMBERS.values()).split()):
        gel = gels[f"L{n}"]
        name = f"Lee {n} {gel['name'].removeprefix('LEE ')}"
        columns[name] = {float(w): float(v) for w, v in gel["sd"].items()}
    content, shape = encode(columns)
    out.append(
        Table(
            "filters/lee.csv",
            "filters",
            "transmittance",
            "1",
            list(columns),
            "Lee Filters, spectral transmittances published at leefilters.com; "
            f"{GELS}, dataset/filters.json",
            "MIT for the package; the numbers are published and owned by Lee Filters, to be asked "
            "about commercial licensing",
            content,
            shape,
            "405 to 700 nm; the end values are held outside, which is a guess below 405 nm and "
            "above 700 nm. A working set of the gels with published spectra; left out are gels "
            "whose spectrum disagrees with the tristimulus values that the maker prints "
            "for a 3200 K source. 211 (0.9ND) disagrees by 0.012 in chromaticity and is kept, as "
            "no other gel is three stops.",
        )
    )
    return out


# Reflectances --------------------------------------------------------------


def reflectance(stem: str, name: str, columns: Columns, source: str, note: str) -> Table:
    """Return one reflectance set's table."""
    content, shape = encode(columns)
    return Table(
        f"reflectances/{stem}.csv",
        "reflectances",
        "reflectance",
        "1",
        [name],
        source,
        BSD,
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
                "TCS13": tcs_columns["TCS13"],
                "TCS15": tcs_columns["TCS15"],
            },
            f"{ces_source}; {tcs_source}; {COLOUR}",
            "Samples that their standards call skin: CES15 and CES18, over which TM-30 takes its "
            "skin fidelity, and CRI test colours 13 (light yellowish pink, human complexion) and "
            "15 (Japanese skin complexion). TCS13 is cut to 380-780 nm; nothing is interpolated. "
            "Four samples, all light to medium: dark skin is not represented.",
        ),
    ]


# RGB spaces ----------------------------------------------------------------

RGB_SPACES = {
    # name here: name in colour-science
    "ACEScg": "ACEScg",
    "ACES2065-1": "ACES2065-1",
    "Rec.709": "ITU-R BT.709",
    "P3-D65": "P3-D65",
    "Rec.2020": "ITU-R BT.2020",
    "ARRI Wide Gamut 3": "ARRI Wide Gamut 3",
    "ARRI Wide Gamut 4": "ARRI Wide Gamut 4",
    "S-Gamut3": "S-Gamut3",
    "S-Gamut3.Cine": "S-Gamut3.Cine",
    "V-Gamut": "V-Gamut",
    "REDWideGamutRGB": "REDWideGamutRGB",
    "Canon Cinema Gamut": "Cinema Gamut",
    "DaVinci Wide Gamut": "DaVinci Wide Gamut",
}


def rgb_space_table(colour: Any) -> Table:
    """Return the primaries and whites of the RGB working spaces."""
    rows = []
    for name, key in RGB_SPACES.items():
        space = colour.RGB_COLOURSPACES[key]
        row = {
            "name": name,
            "primaries": [[float(v) for v in xy] for xy in space.primaries],
            "white": [float(v) for v in space.whitepoint],
            "white_name": space.whitepoint_name,
        }
        rows.append("  " + json.dumps(row, ensure_ascii=False))
    text = '{\n "spaces": [\n' + ",\n".join(rows) + "\n ]\n}\n"
    return Table(
        "rgb_spaces.json",
        "rgb_spaces",
        "chromaticity",
        "1",
        list(RGB_SPACES),
        "The spaces' published specifications (Academy, ITU-R, SMPTE, ARRI, Sony, Panasonic, "
        f"RED, Canon, Blackmagic Design); {COLOUR}",
        BSD,
        text.encode("utf-8"),
        note="CIE 1931 xy. Primaries in the order red, green, blue.",
    )


# The whole -----------------------------------------------------------------


def check_names(tables: list[Table]) -> None:
    """Raise where a name occurs twice in a group."""
    seen: set[tuple[str, str]] = set()
    for table in tables:
        for name in table.names:
            if (table.group, name) in seen:
                raise ValueError(f"{table.file}: {name!r} occurs twice in {table.group}")
            seen.add((table.group, name))


def build() -> list[Table]:
    """Return every table, in manifest order."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import colour

        tables = [
            *illuminant_tables(colour),
            daylight_basis_table(colour),
            *observer_tables(colour),
            *filter_tables(colour),
            *reflectance_tables(colour),
            rgb_space_table(colour),
        ]
    check_names(tables)
    return sorted(tables, key=lambda t: (GROUPS.index(t.group), t.file))


def manifest(tables: list[Table]) -> bytes:
    """Return the text of manifest.json."""
    document = {"metamer_data": 1, "tables": [table.entry() for table in tables]}
    return (json.dumps(document, indent=1, ensure_ascii=False) + "\n").encode("utf-8")


def licence_texts() -> dict[str, bytes]:
    """Return the packages' licence texts, which go with their numbers."""
    out = {}
    for package in PINNED:
        files = metadata.files(package) or []
        found = [f for f in files if ".dist-info" in str(f) and f.name == "LICENSE"]
        if len(found) != 1:
            raise ValueError(f"{package}: one licence text expected, found {len(found)}")
        text = Path(found[0].locate()).read_text(encoding="utf-8")
        out[f"licences/{package}.txt"] = (text.rstrip() + "\n").encode("utf-8")
    return out


def missing_package() -> str | None:
    """Return one line on the first pinned package that is not as pinned."""
    for package, wanted in PINNED.items():
        try:
            found = metadata.version(package)
        except metadata.PackageNotFoundError:
            found = "none"
        if found != wanted:
            return f"{package} {wanted} is needed, found {found}: pip install {package}=={wanted}"
    return None


def main(arguments: list[str] | None = None) -> int:
    """Run the command line and return its exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--output",
        type=Path,
        default=ROOT / "data",
        metavar="DIR",
        help="folder to write (default: the repository's data/)",
    )
    options = parser.parse_args(arguments)
    complaint = missing_package()
    if complaint:
        print(f"export_data: {complaint}", file=sys.stderr)
        return 1
    tables = build()
    files = {table.file: table.content for table in tables}
    files["manifest.json"] = manifest(tables)
    files.update(licence_texts())
    for name, content in files.items():
        path = options.output / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    return 0


if __name__ == "__main__":
    sys.exit(main())
