# SPDX-License-Identifier: Apache-2.0
"""docs/configs.md's tables, from the manifest's figures."""

from __future__ import annotations

from pathlib import Path

import looks

PAGE = Path(__file__).resolve().parent.parent / "docs" / "configs.md"
BEGIN, END = "<!-- figures: script/configs --update -->\n", "<!-- end of figures -->\n"


def figure(look: dict) -> str:
    held = {"matrix": "matrix", "identity": "nothing"}.get(look["representation"], f"{look.get('size')}³")
    return f"{look['mean']:.2f} / {look['p99']:.1f} ({held})"


def tables(figures: dict) -> str:
    """What the page says of each look. figures: the manifest's, by name."""

    def cell(name: str) -> str:
        return figure(figures[name])

    lines = ["| shot under | " + " | ".join(looks.LIGHTS.values()) + " |", "| --- " * (len(looks.LIGHTS) + 1) + "|"]
    for key, light in looks.LIGHTS.items():
        cells = ["" if key == other else cell(f"{key}_to_{other}_050") for other in looks.LIGHTS]
        lines.append(f"| **{light}** | " + " | ".join(cells) + " |")
    lines += ["", "| filter | adaptation 0 | 0.5 | 1 |", "| --- | --- | --- | --- |"]
    for name in ("cto_full", "cto_half", "cto_quarter", "ctb_full", "ctb_half", "ctb_quarter", "didymium", "bandpass", "day_for_night"):
        lines.append(f"| {name} | " + " | ".join(cell(f"{name}_{n}") for n in ("000", "050", "100")) + " |")
    lines += ["| nd_03, nd_06, nd_09 | | | " + cell("nd_03") + " |", ""]
    lines += ["| shot with | " + " | ".join(f"as {key}" for key in looks.CAMERAS) + " |", "| --- " * (len(looks.CAMERAS) + 1) + "|"]
    for key in looks.CAMERAS:
        cells = ["" if key == other else cell(f"{key}_as_{other}") for other in looks.CAMERAS]
        lines.append(f"| **{key}** | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def with_tables(page: str, figures: dict) -> str:
    """The page's text with the tables of these figures."""
    head, rest = page.split(BEGIN)
    return head + BEGIN + "\n" + tables(figures) + "\n" + END + rest.split(END)[1]
