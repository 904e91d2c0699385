# SPDX-License-Identifier: Apache-2.0
"""Labelled pictures side by side."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import numpy as np
from PIL import Image, ImageDraw, ImageFont

Cell = tuple[str, np.ndarray]  # label, 8-bit picture


def sheet(rows: list[list[Cell]], cell_width: int, heading: str = "") -> Image.Image:
    """Rows of pictures, each `cell_width` wide, its label above it, on dark grey."""
    margin, label_height = 12, 30
    font = ImageFont.truetype(str(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"), 17)

    def height_of(picture: np.ndarray) -> int:
        return round(cell_width * picture.shape[0] / picture.shape[1])

    columns = max(len(row) for row in rows)
    top = 2 * margin + 22 if heading else margin
    total = top + sum(label_height + max(height_of(picture) for _, picture in row) + margin for row in rows)
    canvas = Image.new("RGB", (margin + columns * (cell_width + margin), total), (38, 38, 38))
    draw = ImageDraw.Draw(canvas)
    if heading:
        draw.text((margin, margin), heading, font=font, fill=(235, 235, 235))
    y = top
    for row in rows:
        for column, (label, picture) in enumerate(row):
            x = margin + column * (cell_width + margin)
            draw.text((x, y + 4), label, font=font, fill=(235, 235, 235))
            scaled = Image.fromarray(picture).resize((cell_width, height_of(picture)), Image.Resampling.LANCZOS)
            canvas.paste(scaled, (x, y + label_height))
        y += label_height + max(height_of(picture) for _, picture in row) + margin
    return canvas
