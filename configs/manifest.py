# SPDX-License-Identifier: Apache-2.0
"""The manifest of what script/configs makes: a hash a file, and of each look the figures of its certificate."""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path

# The tool's version stands in every file; a new one alone changes nothing.
VERSION = re.compile(rb'(metamer |"name": "metamer",\s*"version": "|metamer-v)\d+\.\d+\.\d+')


def without_version(text: bytes) -> bytes:
    return VERSION.sub(rb"\1", text)


def digest(path: Path) -> str:
    """SHA-256 of a file less the tool's version."""
    return hashlib.sha256(without_version(path.read_bytes())).hexdigest()


def figures(certificate: Path) -> dict:
    """What a certificate says of its look."""
    content = json.loads(certificate.read_text(encoding="utf-8"))
    transform, error = content["transform"], content["error"]
    held = {"representation": transform["representation"]}
    if "size" in transform:
        held["size"] = transform["size"]
    return held | {name: error[name] for name in ("mean", "p99", "max")}


def of(folder: Path) -> dict:
    """The manifest of a folder that script/configs filled."""
    luts = folder / "luts"
    return {
        "files": {path.name: digest(path) for path in sorted(luts.iterdir())},
        "looks": {path.stem: figures(path) for path in sorted(luts.glob("*.json"))},
    }


def text(manifest: dict) -> str:
    """One line an entry, so that a change shows as what it is."""
    sections = []
    for section, entries in manifest.items():
        lines = ",\n".join(f"  {json.dumps(name)}: {json.dumps(value)}" for name, value in sorted(entries.items()))
        sections.append(f" {json.dumps(section)}: {{\n{lines}\n }}")
    return "{\n" + ",\n".join(sections) + "\n}\n"


def read(path: Path) -> dict:
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {"files": {}, "looks": {}}


def differences(expected: dict, made: dict, whole: bool) -> list[str]:
    """A line for each entry of `made` that is not as expected. whole: nothing expected may be lacking either."""
    lines = []
    for section in ("looks", "files"):
        wanted, got = expected[section], made[section]
        for name in sorted(got.keys() | (wanted.keys() if whole else set())):
            if wanted.get(name) != got.get(name):
                lines.append(f"{name}: {wanted.get(name, 'nothing')} in the manifest, {got.get(name, 'nothing')} made")
    return lines
