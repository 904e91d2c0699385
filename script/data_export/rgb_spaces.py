# SPDX-License-Identifier: Apache-2.0
"""Primaries and white points of RGB spaces."""

from __future__ import annotations

import json
from typing import Any

from data_export.table import BSD, COLOUR, Table

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
