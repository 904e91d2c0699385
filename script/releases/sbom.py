#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""sbom.py VERSION SECONDS: a release's parts as CycloneDX 1.5, to stdout: libraries as docs/dependencies.md lists them, in the
versions that are installed or pinned; what compilers of other systems leave in a program; the measured tables as
data/manifest.json lists them."""

import json
import re
import subprocess
import sys
import time
import uuid
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PINS = ("opencolorio", "openimageio")


def linked_packages():
    """(Debian package, licence) of each row of the table of what is linked."""
    page = (ROOT / "docs" / "dependencies.md").read_text(encoding="utf-8")
    table = re.search(r"^## Linked into metamer\n(.*?)^## ", page, re.MULTILINE | re.DOTALL)[1]
    for row in re.findall(r"^\| (lib[\w.+-]+|nlohmann-json3-dev)[^|]*\|[^|]*\|.*\| ([^|]+) \|$", table, re.MULTILINE):
        yield row


def installed(package, *without):
    """The version of a package; where it is not installed, what is given for that."""
    run = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", package], capture_output=True, text=True, check=False)
    if run.returncode == 0:
        return run.stdout
    if without:
        return without[0]
    raise SystemExit(f"sbom.py: package '{package}': not installed; run script/bootstrap")


def library(name, version, kind, licence):
    return {"type": "library", "name": name, "version": version, "purl": f"pkg:{kind}/{name}@{version}".replace("+", "%2B"),
            "licenses": [{"license": {"name": licence}}]}


def runtimes():
    """The C++ libraries that come with a compiler: of bundles that script/cross builds, of the playground's page."""
    pins = (ROOT / "script" / "releases" / "zig.txt").read_text(encoding="utf-8")
    version = re.search(r"^ziglang==([\w.]+)", pins, re.MULTILINE)[1]
    yield {**library("ziglang", version, "pypi", "MIT; Apache-2.0 WITH LLVM-exception; ZPL-2.1"),
           "description": "libc++, libc++abi and compiler-rt in the plug-in for macOS; with libunwind in that for Windows, with MinGW-w64's "
                          "start-up code, and in that for older Linux"}
    if version := installed("emscripten", None):
        yield {**library("emscripten", version, "deb/debian", "MIT or NCSA; Apache-2.0 WITH LLVM-exception"),
               "description": "musl and libc++ in the playground's page"}


def components():
    for package, licence in linked_packages():
        yield library(package, installed(package), "deb/debian", licence)
    for name in PINS:
        pins = (ROOT / "script" / "releases" / f"{name}.txt").read_text(encoding="utf-8")
        package, version = re.search(r"^(\w+)==([\w.]+)", pins, re.MULTILINE).groups()
        yield library(package.lower(), version, "pypi", "BSD-3-Clause" if name == "opencolorio" else "Apache-2.0")
    yield from runtimes()
    for table in json.loads((ROOT / "data" / "manifest.json").read_text(encoding="utf-8"))["tables"]:
        yield {"type": "data", "name": f"data/{table['file']}", "description": table["source"],
               "hashes": [{"alg": "SHA-256", "content": table["sha256"]}], "licenses": [{"license": {"name": table["licence"]}}]}


def document(version, seconds):
    parts = sorted(components(), key=lambda part: (part["type"], part["name"]))
    return {
        "bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1,
        # The same parts give the same number.
        "serialNumber": f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_OID, json.dumps([version, parts]))}",
        "metadata": {
            "timestamp": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(seconds)),
            "component": {"type": "application", "name": "metamer", "version": version,
                          "licenses": [{"license": {"id": "Apache-2.0"}}]}},
        "components": parts,
    }


if __name__ == "__main__":
    json.dump(document(sys.argv[1], int(sys.argv[2])), sys.stdout, indent=1, ensure_ascii=False)
    print()
