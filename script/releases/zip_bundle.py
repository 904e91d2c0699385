#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Zips a folder of bundles with its notes: zip_bundle.py FOLDER NOTES VERSION ZIP SECONDS. NOTES, a text in which VERSION stands for
the version and GLIBC for the C library that the bundle's library asks for, becomes INSTALL.txt. Sorted, with one date, so that the
same files give the same bytes."""

import re
import sys
import time
import zipfile
from pathlib import Path


def glibc(files: dict[str, bytes]) -> str:
    """The newest version of the C library that a symbol of theirs is of; empty where there is none."""
    texts = [found for name, data in files.items() if name.endswith(".ofx") for found in re.findall(rb"\0GLIBC_(\d+\.\d+)(?:\.\d+)?(?=\0)", data)]
    return max((text.decode() for text in texts), key=lambda text: [int(part) for part in text.split(".")], default="")


def main(folder: Path, notes: Path, version: str, target: Path, seconds: int) -> None:
    date = time.gmtime(seconds)[:6]
    files = {file.relative_to(folder).as_posix(): file.read_bytes() for file in folder.rglob("*") if file.is_file()}
    text = notes.read_text(encoding="utf-8").replace("VERSION", version).replace("GLIBC", glibc(files))
    # Windows' own editor, of any year, reads the lines.
    text = text.replace("\n", "\r\n" if "windows" in notes.name else "\n")
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, data in sorted({**files, "INSTALL.txt": text.encode()}.items()):
            member = zipfile.ZipInfo(name, date)
            member.compress_type = zipfile.ZIP_DEFLATED
            # A library is a program to macOS; nothing else is.
            member.external_attr = (0o100755 if name.endswith(".ofx") else 0o100644) << 16
            archive.writestr(member, data)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3], Path(sys.argv[4]), int(sys.argv[5]))
