# SPDX-License-Identifier: Apache-2.0
"""Two photographs shot in daylight, relit as tungsten, sodium and RGB LEDs, with the eye adapted 0, 50, 100 %.

Writes transforms with their certificates, EXRs, a contact sheet and two plots into out/.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RECIPES = ROOT / "demo" / "recipes"
PHOTOGRAPHS = ("astronaut", "coffee")
ADAPTATIONS = (0, 50, 100)  # per cent
FORMATS = ("clf", "ctf", "cube")


@contextmanager
def step(what: str) -> Iterator[None]:
    """Times one step and says so."""
    begun = time.perf_counter()
    yield
    print(f"{time.perf_counter() - begun:7.1f} s  {what}", flush=True)


def call(command: list[str]) -> None:
    """Runs lutgen; its own message is the error."""
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise SystemExit(f"{' '.join(command)}\nexit {result.returncode}: {result.stderr.strip()}")


def in_parallel(commands: list[list[str]]) -> None:
    with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        for _ in pool.map(call, commands):
            pass


def print_certificates(folder: Path) -> None:
    """What each file promises: CIEDE2000 against the converged engine."""
    print(f"\n{'transform':32}{'mean':>9}{'p99':>9}{'max':>9}   CIEDE2000 against the converged engine")
    for path in sorted(folder.glob("*.json")):
        error = json.loads(path.read_text(encoding="utf-8"))["error"]
        print(f"{path.stem:32}{error['mean']:9.3f}{error['p99']:9.3f}{error['max']:9.3f}")
    print()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lutgen", type=Path, default=ROOT / "build" / "install" / "bin" / "lutgen")
    parser.add_argument("--out", type=Path, default=ROOT / "out", help="folder to write (default: out)")
    parser.add_argument("--update-docs", action="store_true", help="also renew docs/images/demo.jpg, the README's picture")
    arguments = parser.parse_args()
    lutgen, out = str(arguments.lutgen.resolve()), arguments.out
    transforms, images = out / "transforms", out / "pictures"
    transforms.mkdir(parents=True, exist_ok=True)
    images.mkdir(parents=True, exist_ok=True)
    begun = time.perf_counter()

    with step("Python's libraries"):
        import contact_sheet
        import pictures
        import plots

    names = [f"day_to_{light.key}_{percent:03d}" for light in plots.LIGHTS for percent in ADAPTATIONS]

    with step(f"{len(PHOTOGRAPHS)} photographs to scene-linear ACEScg"):
        before = {name: pictures.scene(pictures.scikit_image(f"{name}.png")) for name in PHOTOGRAPHS}
        for name, pixels in before.items():
            pictures.write_exr(images / f"{name}.exr", pixels)

    with step(f"lutgen bake: {len(names)} recipes, each as {', '.join(FORMATS)}, with certificates"):
        in_parallel([
            [lutgen, "bake", str(RECIPES / f"{name}.yaml"), "-o", str(transforms / f"{name}.{extension}")]
            for name in names for extension in FORMATS
        ])

    with step(f"lutgen apply: {len(names)} recipes on {len(PHOTOGRAPHS)} pictures"):
        in_parallel([
            [lutgen, "apply", "--engine", "map", str(RECIPES / f"{name}.yaml"), str(images / f"{picture}.exr"),
             str(images / f"{picture}_{name}.exr")]
            for picture in PHOTOGRAPHS for name in names
        ])

    with step("contact sheet"):
        rows = []
        for picture in PHOTOGRAPHS:
            for light in plots.LIGHTS:
                row = [("Daylight, as shot", pictures.view(before[picture]))]
                for percent in ADAPTATIONS:
                    after = pictures.read_exr(images / f"{picture}_day_to_{light.key}_{percent:03d}.exr")
                    row.append((f"{light.title}, eye adapted {percent} %", pictures.view(after)))
                rows.append(row)
        heading = f"Shot in daylight (D65), shown under other lights. View: {pictures.VIEW_NAME}."
        contact_sheet.sheet(rows, 420, heading).save(out / "contact_sheet.png")
        # The README's picture: the first photograph under every light, not adapted and fully adapted.
        shown = [[rows[0][0], *(row[column] for row in rows[: len(plots.LIGHTS)])] for column in (1, len(ADAPTATIONS))]
        contact_sheet.sheet(shown, 300).save(out / "demo.jpg", quality=88)

    with step("plot of the spectra"):
        plots.plot_spectra(out / "spectra.png")

    with step("plot of the chromaticity vector field"):
        probes = plots.probe_colours()
        pictures.write_exr(out / "probes.exr", probes[None])
        fields = {(light.key, percent): out / f"probes_{light.key}_{percent:03d}.exr"
                  for light in plots.LIGHTS for percent in (0, 100)}
        in_parallel([[lutgen, "apply", str(RECIPES / f"day_to_{key}_{percent:03d}.yaml"),
                      str(out / "probes.exr"), str(path)] for (key, percent), path in fields.items()])
        plots.plot_vector_field(
            out / "chromaticities.png", probes, {key: pictures.read_exr(path)[0] for key, path in fields.items()})
        for path in (out / "probes.exr", *fields.values()):
            path.unlink()

    if arguments.update_docs:
        (ROOT / "docs" / "images").mkdir(exist_ok=True)
        shutil.copyfile(out / "demo.jpg", ROOT / "docs" / "images" / "demo.jpg")

    print(f"{time.perf_counter() - begun:7.1f} s  in all")
    print_certificates(transforms)
    print(f"Look at {out / 'contact_sheet.png'}, {out / 'spectra.png'} and {out / 'chromaticities.png'}.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
