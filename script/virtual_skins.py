#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes data/reflectances/virtual_skins.csv: skins that metamer::skin draws from its prior.

What knows skins without the model (scenes, stages) reads them there. Run it where the model or its prior has changed,
and script/export_data.py after it, which takes the table into the manifest.

    PYTHONPATH=build/release/python build/venv/bin/python script/virtual_skins.py
"""

from __future__ import annotations

import csv
import io
from pathlib import Path

from metamer import skin

TABLE = Path(__file__).resolve().parents[1] / "data" / "reflectances" / "virtual_skins.csv"
COUNT = 1000
SEED = 1
DIGITS = 4


def text() -> str:
    """Return the table."""
    skins = skin.virtual_skins(COUNT, SEED)
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["wavelength_nm", *(f"skin_{k:04d}" for k in range(COUNT))])
    for row, wavelength in enumerate(skins[0].wavelengths):
        writer.writerow([int(wavelength), *(round(float(one.values[row]), DIGITS) for one in skins)])
    return out.getvalue()


if __name__ == "__main__":
    TABLE.write_text(text(), encoding="utf-8")
