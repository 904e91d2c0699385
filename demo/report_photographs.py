# SPDX-License-Identifier: Apache-2.0
"""The photographs that `lutgen report` shows where it is given none: scikit-image's own, small enough for a page.

    build/venv/bin/python demo/report_photographs.py
"""

from importlib.util import find_spec
from pathlib import Path

from PIL import Image

FOLDER = Path(__file__).resolve().parent.parent / "lutgen" / "pictures" / "report" / "page"
WIDTHS = {"astronaut": 440, "coffee": 540}


def main():
    source = Path(find_spec("skimage").origin).parent / "data"
    for name, width in WIDTHS.items():
        with Image.open(source / f"{name}.png") as picture:
            height = round(width * picture.height / picture.width)
            small = picture.convert("RGB").resize((width, height), Image.Resampling.LANCZOS)
        small.save(FOLDER / f"{name}.jpg", quality=85, optimize=True)
        print(name, small.size, (FOLDER / f"{name}.jpg").stat().st_size, "bytes")


if __name__ == "__main__":
    main()
