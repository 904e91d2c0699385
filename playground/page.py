# SPDX-License-Identifier: Apache-2.0
"""Puts the playground's page together: one file, with the engine in it.

    python3 playground/page.py FOLDER-OF-THE-ENGINE PAGE.html
"""

import base64
import gzip
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
PHOTOGRAPH = ROOT / "lutgen" / "pictures" / "report" / "page" / "astronaut.jpg"


def coded(data):
    return base64.b64encode(data).decode()


def script(*files):
    """Program text that can stand within an element."""
    text = "\n".join(file.read_text(encoding="utf-8") for file in files)
    for end in ("</script", "<!--"):
        if end in text.lower():
            raise SystemExit(f"playground/page.py: {files}: '{end}' would end the page's element")
    return text


def page(engine):
    version = re.search(r"^project\(metamer VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)[1]
    parts = {
        "style": (HERE / "page" / "page.css").read_text(encoding="utf-8"),
        "made": f"Made by metamer {version}",
        "photograph": coded(PHOTOGRAPH.read_bytes()),
        "engine": coded(gzip.compress((engine / "engine.wasm").read_bytes(), 9, mtime=0)),
        "worker": script(engine / "engine.js", HERE / "page" / "worker.js"),
        "drawing": script(HERE / "page" / "drawing.js"),
        "script": script(HERE / "page" / "page.js"),
    }
    text = (HERE / "page" / "page.html").read_text(encoding="utf-8")
    return re.sub(r"\{\{(\w+)\}\}", lambda match: parts[match[1]], text)


def main():
    engine, target = map(Path, sys.argv[1:])
    target.write_text(page(engine), encoding="utf-8")
    print(f"{target}: {target.stat().st_size:,} bytes")


if __name__ == "__main__":
    main()
