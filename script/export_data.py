#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Regenerate the measured tables in data/ from pinned registry packages.

Needs Python 3.11 or newer with colour-science 0.4.7, lighting-filters 0.1.1,
scikit-image 0.26.0 and mne 1.13.2 installed. The output is the same byte for byte on every run.
"""

from __future__ import annotations

import argparse
import json
import sys
import warnings
from importlib import metadata
from pathlib import Path

from data_export.filters import filter_tables
from data_export.illuminants import daylight_basis_table, illuminant_tables
from data_export.observers import observer_tables
from data_export.pixels import PACKAGE as PICTURES
from data_export.pixels import pixel_table
from data_export.reflectances import reflectance_tables
from data_export.rgb_spaces import rgb_space_table
from data_export.skin import skin_tables
from data_export.table import Table
from data_export.uplifts import uplift_tables

ROOT = Path(__file__).resolve().parent.parent
PINNED = {"colour-science": "0.4.7", "lighting-filters": "0.1.1", "mne": "1.13.2"}
GROUPS = (
    "illuminants",
    "daylight_basis",
    "observers",
    "filters",
    "reflectances",
    "rgb_spaces",
    "pixels",
    "chromophores",
    "skin_prior",
    "skin_network",
    "uplifts",
)


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
            pixel_table(colour),
            *skin_tables(),
            *uplift_tables(colour),
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
        found = [f for f in files if ".dist-info" in str(f) and f.name in ("LICENSE", "LICENSE.txt")]
        if len(found) != 1:
            raise ValueError(f"{package}: one licence text expected, found {len(found)}")
        text = Path(found[0].locate()).read_text(encoding="utf-8")
        out[f"licences/{package}.txt"] = (text.rstrip() + "\n").encode("utf-8")
    return out


def missing_package() -> str | None:
    """Return one line on the first pinned package that is not as pinned."""
    for package, wanted in [*PINNED.items(), PICTURES]:
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
