# SPDX-License-Identifier: Apache-2.0
"""A photograph under tungsten, balanced by the camera and not, shown in daylight with the eye adapted 0 and 100 %.

The shots are made from the daylight photograph by the engine itself: under A with the eye on daylight is what an unbalanced
camera records, with the eye adapted what a balanced one hands over. Writes one JPEG.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import contact_sheet
import pictures
from run_demo import ROOT, call

SHOTS = (("vonkries", "1", "Tungsten, balanced"), ("none", "0", "Tungsten, not balanced"))  # balanced, adaptation
TITLES = {"0": "daylight, adaptation 0", "1": "daylight, adaptation 1"}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lutgen", type=Path, default=ROOT / "build" / "install" / "bin" / "lutgen")
    parser.add_argument("--photograph", default="astronaut.png", help="of scikit-image (default: astronaut.png)")
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "images" / "balanced.jpg")
    arguments = parser.parse_args()
    lutgen = str(arguments.lutgen.resolve())
    rows = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        day = folder / "day.exr"
        pictures.write_exr(day, pictures.scene(pictures.scikit_image(arguments.photograph)))

        def relit(before: Path, name: str, light_in: str, light_out: str, balanced: str, adaptation: str) -> Path:
            after = folder / f"{name}.exr"
            call([lutgen, "apply", str(ROOT / "demo" / "recipes" / "day_to_tungsten_000.yaml"), str(before), str(after),
                  "--illuminant-in", light_in, "--illuminant-out", light_out, "--balanced", balanced,
                  "--adaptation", adaptation, "--engine", "map"])
            return after

        for balanced, taken, title in SHOTS:
            shot = relit(day, f"shot_{balanced}", "D65", "A", "vonkries", taken)
            row = [(title, pictures.view(pictures.read_exr(shot)))]
            for adaptation, label in TITLES.items():
                after = relit(shot, f"{balanced}_{adaptation}", "A", "D65", balanced, adaptation)
                row.append((label, pictures.view(pictures.read_exr(after))))
            rows.append(row)
    contact_sheet.sheet(rows, 300).save(arguments.out, quality=88)
    return 0


if __name__ == "__main__":
    sys.exit(main())
