# SPDX-License-Identifier: Apache-2.0
"""Lens, diffuser and gels."""

from __future__ import annotations

import json
from importlib import metadata
from pathlib import Path
from typing import Any

from data_export.table import BSD, COLOUR, ISO7589, Columns, Table, encode, pairs

GELS = "lighting-filters 0.1.1"

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
