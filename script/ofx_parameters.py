#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the parameter tables of docs/ofx.md from what the built plug-in declares to hosts.

    script/ofx_parameters.py           writes them
    script/ofx_parameters.py --check   exit 1 where the page says something else
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
PAGE = REPOSITORY / "docs" / "ofx.md"
BEGIN, END = "<!-- parameters: written by script/ofx_parameters.py -->", "<!-- end of parameters -->"
MOST_OPTIONS = 6


def number(value):
    return f"{value:g}"


def value_text(parameter):
    """Default and range, or options."""
    kind = parameter["type"]
    if kind == "OfxParamTypeDouble":
        return f"{number(parameter['default'])} ({number(parameter['range'][0])} … {number(parameter['range'][1])})"
    if kind == "OfxParamTypeBoolean":
        return "on" if parameter["default"] else "off"
    if kind == "OfxParamTypeChoice":
        options = parameter["options"]
        # Long lists grow with the tables: their number would be out of date sooner than the page.
        others = ", ".join(o for o in options if o != parameter["default"]) if len(options) <= MOST_OPTIONS else "…"
        return f"**{parameter['default']}**" + (f", {others}" if others else "")
    return "none"


def table(effect):
    lines = [f"### {effect['label']}", "", f"`{effect['identifier']}`. {effect['description']}", "",
             "<details>", f"<summary>Parameters of {effect['label']}</summary>", "",
             "| parameter | name | default | animates | what it does |", "| --- | --- | --- | --- | --- |"]
    for parameter in effect["parameters"]:
        if parameter["secret"]:
            continue
        if parameter["type"] == "OfxParamTypeGroup":
            lines.append(f"| **{parameter['label']}** | `{parameter['name']}` | | | |")
            continue
        lines.append(f"| {parameter['label']} | `{parameter['name']}` | {value_text(parameter)} "
                     f"| {'yes' if parameter['animates'] else ''} | {parameter['hint']} |")
    return [*lines, "", "</details>"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing; exit 1 where the page is out of date")
    arguments = parser.parse_args()
    bin_folder = Path(os.environ.get("METAMER_BIN", REPOSITORY / "build/release/bin"))
    run = subprocess.run([bin_folder / "metamer_ofx_parameters"], capture_output=True, text=True, check=True)
    lines = [BEGIN, ""]
    for effect in json.loads(run.stdout):
        lines += table(effect) + [""]
    page = PAGE.read_text(encoding="utf-8")
    before, rest = page.split(BEGIN)
    after = rest.split(END)[1]
    wanted = before + "\n".join(lines) + END + after
    if arguments.check:
        if page != wanted:
            print("docs/ofx.md is out of date: run script/ofx_parameters.py", file=sys.stderr)
            return 1
        return 0
    PAGE.write_text(wanted, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
