#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Zips a folder of bundles: zip_bundle.py FOLDER ZIP SECONDS. Sorted, with one date, so that the same files give the same bytes."""

import sys
import time
import zipfile
from pathlib import Path


def main(folder: Path, target: Path, seconds: int) -> None:
    date = time.gmtime(seconds)[:6]
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for file in sorted(path for path in folder.rglob("*") if path.is_file()):
            member = zipfile.ZipInfo(file.relative_to(folder).as_posix(), date)
            member.compress_type = zipfile.ZIP_DEFLATED
            # A library is a program to macOS; nothing else is.
            member.external_attr = (0o100755 if file.suffix == ".ofx" else 0o100644) << 16
            archive.writestr(member, file.read_bytes())


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3]))
