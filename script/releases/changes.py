#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""changes.py VERSION: that version's section of CHANGELOG.md, to stdout."""

import re
import sys
from pathlib import Path

CHANGELOG = Path(__file__).resolve().parent.parent.parent / "CHANGELOG.md"


def section(version: str) -> str:
    found = re.search(rf"^## \[{re.escape(version)}\].*?(?=^## \[|\Z)", CHANGELOG.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    if found is None:
        raise SystemExit(f"CHANGELOG.md: section '{version}': there is none; add what the release brings")
    return found[0].strip() + "\n"


if __name__ == "__main__":
    sys.stdout.write(section(sys.argv[1]))
