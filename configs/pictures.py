# SPDX-License-Identifier: Apache-2.0
"""Shows every look of metamer.ocio on the demo photograph: docs/images/configs_*.jpg.

script/configs must have made them. The looks are applied by the newest OpenColorIO's Python package, from the config as it lies there.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import PyOpenColorIO as ocio
from PIL import Image, ImageDraw, ImageFont

ROOT = Path(__file__).resolve().parent.parent
MADE = ROOT / "build" / "release" / "configs"  # by script/configs
sys.path[:0] = [str(ROOT / "demo"), str(ROOT / "configs")]

import looks as ready_made  # noqa: E402
import pictures  # noqa: E402

SIDE = 124  # of one picture
GAP = 6
LABEL = 20
LEFT = 92
ENLARGED = 8  # differences between cameras


def photograph() -> np.ndarray:
    """The astronaut, head and shoulders, scene-linear ACEScg, SIDE x SIDE."""
    whole = pictures.scene(pictures.scikit_image("astronaut.png"))[0:372, 60:432]
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
        self.paste(row, column, pictures.view(acescg))

    def put_difference(self, row: int, column: int, before: np.ndarray, after: np.ndarray) -> None:
        """What changes on the screen, ENLARGED times, from grey."""
        change = pictures.view(after).astype(int) - pictures.view(before)
        self.paste(row, column, np.clip(118 + ENLARGED * change, 0, 255).astype(np.uint8))

    def paste(self, row: int, column: int, codes: np.ndarray) -> None:
        place = (LEFT + GAP + column * (SIDE + GAP), LABEL + GAP + row * (SIDE + GAP))
        self.image.paste(Image.fromarray(codes), place)

    def save(self, name: str) -> None:
        self.image.save(ROOT / "docs" / "images" / f"configs_{name}.jpg", quality=82, optimize=True)


class Looks:
    def __init__(self):
        self.config = ocio.Config.CreateFromFile(str(MADE / "metamer.ocio"))
        self.before = photograph().astype(np.float32)

    def shown(self, name: str) -> np.ndarray:
        look = ocio.LookTransform(src="ACEScg", dst="ACEScg", looks=name)
        pixels = np.ascontiguousarray(self.before.reshape(-1, 3)).copy()
        self.config.getProcessor(look).getDefaultCPUProcessor().applyRGB(pixels)
        return pixels.reshape(self.before.shape)


def adaptation_rows() -> list[str]:
    return [f"adaptation {adaptation:g}" for adaptation in ready_made.ADAPTATIONS]


def light_sheets(looks: Looks) -> None:
    for key in ready_made.LIGHTS:
        others = {other: light for other, light in ready_made.LIGHTS.items() if other != key}
        sheet = Sheet(adaptation_rows(), ["as shot", *others.values()])
        for row, adaptation in enumerate(ready_made.ADAPTATIONS):
            sheet.put(row, 0, looks.before)
            for column, other in enumerate(others):
                sheet.put(row, column + 1, looks.shown(f"{key}_to_{other}_{round(100 * adaptation):03}"))
        sheet.save(f"from_{key}")


def filter_sheet(looks: Looks) -> None:
    names = [f"{kind}_{size}" for kind in ("cto", "ctb") for size in ("full", "half", "quarter")] + ["didymium", "bandpass"]
    sheet = Sheet([*adaptation_rows(), "kept exposure"], [name.replace("_", " ") for name in names])
    for column, name in enumerate(names):
        for row, adaptation in enumerate(ready_made.ADAPTATIONS):
            sheet.put(row, column, looks.shown(f"{name}_{round(100 * adaptation):03}"))
    for column, name in enumerate(("nd_03", "nd_06", "nd_09")):
        sheet.put(3, column, looks.shown(name))
        sheet.draw.text((LEFT + GAP + column * (SIDE + GAP) + 4, LABEL + GAP + 3 * (SIDE + GAP) + SIDE - 16),
                        name.replace("_0", " 0."), font=sheet.font, fill=(235, 235, 235))
    sheet.save("filters")


def night_sheet(looks: Looks) -> None:
    sheet = Sheet(["day for night"], ["as shot", *adaptation_rows()])
    sheet.put(0, 0, looks.before)
    for column, adaptation in enumerate(ready_made.ADAPTATIONS):
        sheet.put(0, column + 1, looks.shown(f"day_for_night_{round(100 * adaptation):03}"))
    sheet.save("day_for_night")


def camera_sheet(looks: Looks) -> None:
    sheet = Sheet([key.replace("_", " ") for key in ready_made.CAMERAS],
                  [f"as {key.replace('_', ' ')}" for key in ready_made.CAMERAS])
    for row, key in enumerate(ready_made.CAMERAS):
        for column, other in enumerate(ready_made.CAMERAS):
            if key == other:
                sheet.put(row, column, looks.before)
            else:
                sheet.put_difference(row, column, looks.before, looks.shown(f"{key}_as_{other}"))
    sheet.save("cameras")


def main() -> int:
    looks = Looks()
    light_sheets(looks)
    filter_sheet(looks)
    night_sheet(looks)
    camera_sheet(looks)
    return 0


if __name__ == "__main__":
    sys.exit(main())
