# SPDX-License-Identifier: Apache-2.0
"""A table of data/: its text and its manifest entry; columns to and from text."""

from __future__ import annotations

import csv
import hashlib
import io
import math
from dataclasses import dataclass, field
from decimal import Decimal
from pathlib import Path
from typing import Any

RETRIEVED = "2026-11-22"
COLOUR = "colour-science 0.4.7"
BSD = "BSD-3-Clause"
ISO7589 = "ISO 7589:2002 Photography, illuminants for sensitometry"
RAWTOACES = "RAW to ACES 1.0 (Dyer, Forsythe, Irons, Mansencal, Zhu 2017)"

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
