# SPDX-License-Identifier: Apache-2.0
"""Shows every look of metamer.ocio on the demo photograph: docs/images/configs_*.jpg, and docs/configs.md's tables.

The looks are applied by the newest OpenColorIO's Python package, from the config as it lies there.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import PyOpenColorIO as ocio
from PIL import Image, ImageDraw, ImageFont

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "demo"), str(ROOT / "configs")]

import generate  # noqa: E402
import pictures  # noqa: E402

SIDE = 124  # of one picture
GAP = 6
LABEL = 20
LEFT = 92


def photograph() -> np.ndarray:
    """The astronaut, head and shoulders, scene-linear ACEScg, SIDE x SIDE."""
    whole = pictures.photograph("astronaut.png")[0:372, 60:432]
    edges = np.linspace(0, whole.shape[0], SIDE + 1).astype(int)
    rows = np.add.reduceat(whole, edges[:-1], axis=0) / np.diff(edges)[:, None, None]
    return np.add.reduceat(rows, edges[:-1], axis=1) / np.diff(edges)[None, :, None]


class Sheet:
    """A table of small pictures with labels at the left and above."""

    def __init__(self, rows: list[str], columns: list[str]):
        import matplotlib

        size = (LEFT + len(columns) * (SIDE + GAP) + GAP, LABEL + len(rows) * (SIDE + GAP) + GAP)
        self.image = Image.new("RGB", size, (38, 38, 38))
        self.draw = ImageDraw.Draw(self.image)
        self.font = ImageFont.truetype(str(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"), 12)
        for column, text in enumerate(columns):
            self.draw.text((LEFT + GAP + column * (SIDE + GAP), 4), text, font=self.font, fill=(235, 235, 235))
        for row, text in enumerate(rows):
            self.draw.text((GAP, LABEL + GAP + row * (SIDE + GAP)), text, font=self.font, fill=(235, 235, 235))

    def put(self, row: int, column: int, acescg: np.ndarray) -> None:
        place = (LEFT + GAP + column * (SIDE + GAP), LABEL + GAP + row * (SIDE + GAP))
        self.image.paste(Image.fromarray(pictures.view(acescg)), place)

    def save(self, name: str) -> None:
        self.image.save(ROOT / "docs" / "images" / f"configs_{name}.jpg", quality=82, optimize=True)


class Looks:
    def __init__(self):
        self.config = ocio.Config.CreateFromFile(str(ROOT / "configs" / "metamer.ocio"))
        self.before = photograph().astype(np.float32)

    def shown(self, name: str) -> np.ndarray:
        look = ocio.LookTransform(src="ACEScg", dst="ACEScg", looks=name)
        pixels = np.ascontiguousarray(self.before.reshape(-1, 3)).copy()
        self.config.getProcessor(look).getDefaultCPUProcessor().applyRGB(pixels)
        return pixels.reshape(self.before.shape)


def adaptation_rows() -> list[str]:
    return [f"adaptation {adaptation:g}" for adaptation in generate.ADAPTATIONS]


def light_sheets(looks: Looks) -> None:
    for key in generate.LIGHTS:
        others = {other: light for other, light in generate.LIGHTS.items() if other != key}
        sheet = Sheet(adaptation_rows(), ["as shot", *others.values()])
        for row, adaptation in enumerate(generate.ADAPTATIONS):
            sheet.put(row, 0, looks.before)
            for column, other in enumerate(others):
                sheet.put(row, column + 1, looks.shown(f"{key}_to_{other}_{round(100 * adaptation):03}"))
        sheet.save(f"from_{key}")


def filter_sheet(looks: Looks) -> None:
    names = [f"{kind}_{size}" for kind in ("cto", "ctb") for size in ("full", "half", "quarter")] + ["didymium", "bandpass"]
    sheet = Sheet([*adaptation_rows(), "kept exposure"], [name.replace("_", " ") for name in names])
    for column, name in enumerate(names):
        for row, adaptation in enumerate(generate.ADAPTATIONS):
            sheet.put(row, column, looks.shown(f"{name}_{round(100 * adaptation):03}"))
    for column, name in enumerate(("nd_03", "nd_06", "nd_09")):
        sheet.put(3, column, looks.shown(name))
        sheet.draw.text((LEFT + GAP + column * (SIDE + GAP) + 4, LABEL + GAP + 3 * (SIDE + GAP) + SIDE - 16),
                        name.replace("_0", " 0."), font=sheet.font, fill=(235, 235, 235))
    sheet.save("filters")


def night_sheet(looks: Looks) -> None:
    sheet = Sheet(["day for night"], ["as shot", *adaptation_rows()])
    sheet.put(0, 0, looks.before)
    for column, adaptation in enumerate(generate.ADAPTATIONS):
        sheet.put(0, column + 1, looks.shown(f"day_for_night_{round(100 * adaptation):03}"))
    sheet.save("day_for_night")


def camera_sheet(looks: Looks) -> None:
    sheet = Sheet([key.replace("_", " ") for key in generate.CAMERAS],
                  [f"as {key.replace('_', ' ')}" for key in generate.CAMERAS])
    for row, key in enumerate(generate.CAMERAS):
        for column, other in enumerate(generate.CAMERAS):
            sheet.put(row, column, looks.before if key == other else looks.shown(f"{key}_as_{other}"))
    sheet.save("cameras")


def figure(name: str) -> str:
    certificate = json.loads((ROOT / "configs" / "luts" / f"{name}.json").read_text(encoding="utf-8"))
    error, transform = certificate["error"], certificate["transform"]
    held = {"matrix": "matrix", "identity": "nothing"}.get(transform["representation"], f"{transform.get('size')}³")
    return f"{error['mean']:.2f} / {error['p99']:.1f} ({held})"


def tables() -> str:
    """What the page says of each look, from the certificates."""
    lines = ["| shot under | " + " | ".join(generate.LIGHTS.values()) + " |", "| --- " * (len(generate.LIGHTS) + 1) + "|"]
    for key, light in generate.LIGHTS.items():
        cells = ["" if key == other else figure(f"{key}_to_{other}_050") for other in generate.LIGHTS]
        lines.append(f"| **{light}** | " + " | ".join(cells) + " |")
    lines += ["", "| filter | adaptation 0 | 0.5 | 1 |", "| --- | --- | --- | --- |"]
    for name in ("cto_full", "cto_half", "cto_quarter", "ctb_full", "ctb_half", "ctb_quarter", "didymium", "bandpass", "day_for_night"):
        lines.append(f"| {name} | " + " | ".join(figure(f"{name}_{n}") for n in ("000", "050", "100")) + " |")
    lines += ["| nd_03, nd_06, nd_09 | | | " + figure("nd_03") + " |", ""]
    lines += ["| shot with | " + " | ".join(f"as {key}" for key in generate.CAMERAS) + " |", "| --- " * (len(generate.CAMERAS) + 1) + "|"]
    for key in generate.CAMERAS:
        cells = ["" if key == other else figure(f"{key}_as_{other}") for other in generate.CAMERAS]
        lines.append(f"| **{key}** | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def update_page() -> None:
    page = ROOT / "docs" / "configs.md"
    begin, end = "<!-- figures: configs/pictures.py -->\n", "<!-- end of figures -->\n"
    text = page.read_text(encoding="utf-8")
    head, rest = text.split(begin)
    page.write_text(head + begin + "\n" + tables() + "\n" + end + rest.split(end)[1], encoding="utf-8")


def main() -> int:
    looks = Looks()
    light_sheets(looks)
    filter_sheet(looks)
    night_sheet(looks)
    camera_sheet(looks)
    update_page()
    return 0


if __name__ == "__main__":
    sys.exit(main())
