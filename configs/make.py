# SPDX-License-Identifier: Apache-2.0
"""Makes the ready-made looks: recipes, tables, certificates and the config, from nothing but itself and data/.

    script/configs                  # into build/release/configs and the install tree; compared with configs/manifest.json
    script/configs --update         # and makes the checked-in recipes, config, manifest and page those of this build
    script/configs --sample         # a few looks of each kind alone, in seconds
    script/configs --size 65 --out FOLDER
                                    # the same looks from tables of up to 65 nodes: 0.4 GB

A look is made again only where its recipe, the data or the program that bakes it changed. The same sources give the same
bytes.
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import looks  # noqa: E402
import manifest  # noqa: E402
import page  # noqa: E402
import parts  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent
CHECKED_IN = ROOT / "configs"
MANIFEST = CHECKED_IN / "manifest.json"
BUILD = ROOT / "build" / "release"

# Two tables of one core and three adaptations, a matrix, one out of a light with lines, one with keep_exposure, a camera.
SAMPLE = ("3200k_to_a", "d50_to_d65", "fl11_to_a", "nd_06", "day_for_night", "canon_5d2_as_ricd")


def make(arguments: argparse.Namespace) -> tuple[int, int]:
    """Fills arguments.out; how many looks there are, and how many parts were baked anew."""
    out = arguments.out
    recipes = parts.of(looks.all_sets(), arguments.size, arguments.tolerance)
    if arguments.sample:
        recipes = [part for part in recipes if part.name in SAMPLE]
    looks.write_recipes(out / "recipes", looks.all_sets())
    baked = parts.bake(recipes, out, arguments.lutgen, arguments.jobs)
    parts.assemble(recipes, out)
    return sum(len(part.looks) for part in recipes), baked


def update(out: Path, made: dict) -> None:
    """What is checked in becomes what was made."""
    shutil.rmtree(CHECKED_IN / "recipes", ignore_errors=True)
    shutil.copytree(out / "recipes", CHECKED_IN / "recipes")
    shutil.copyfile(out / "metamer.ocio", CHECKED_IN / "metamer.ocio")
    MANIFEST.write_text(manifest.text(made), encoding="utf-8")
    page.PAGE.write_text(page.with_tables(page.PAGE.read_text(encoding="utf-8"), made["looks"]), encoding="utf-8")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lutgen", type=Path, default=BUILD / "bin" / "lutgen")
    parser.add_argument("--out", type=Path, help="folder to fill (default: build/release/configs, or configs-sample there)")
    parser.add_argument("--size", type=int, help="the most nodes along a side, in place of those of each set")
    parser.add_argument("--tolerance", type=float, default=looks.TOLERANCE, help=f"CIEDE2000 (default: {looks.TOLERANCE:g})")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="looks baked at once (default: a core each)")
    parser.add_argument("--sample", action="store_true", help="a few looks alone")
    parser.add_argument("--update", action="store_true", help="check in what was made")
    arguments = parser.parse_args()
    others = arguments.size is not None or arguments.tolerance != looks.TOLERANCE
    if arguments.update and (arguments.sample or others):
        parser.error("--update takes the looks as they are: without --sample, --size and --tolerance")
    arguments.out = arguments.out or BUILD / ("configs-sample" if arguments.sample else "configs")
    arguments.out.mkdir(parents=True, exist_ok=True)
    begun = time.monotonic()
    try:
        count, baked = make(arguments)
    except parts.BakeError as error:
        print(f"script/configs: {error}", file=sys.stderr)
        return 1
    made = manifest.of(arguments.out)
    size = sum(file.stat().st_size for file in arguments.out.rglob("*") if file.is_file() and ".parts" not in file.parts)
    print(f"{count} looks, {size / 1e6:.1f} MB in {arguments.out}: {baked} baked anew in {time.monotonic() - begun:.0f} s")
    if arguments.update:
        update(arguments.out, made)
        print(f"checked in: {MANIFEST.relative_to(ROOT)}, metamer.ocio and recipes/ beside it, docs/configs.md")
        return 0
    if others:
        return 0
    differences = manifest.differences(manifest.read(MANIFEST), made, whole=not arguments.sample)
    differences += parts.config_differences(CHECKED_IN / "metamer.ocio", arguments.out / "metamer.ocio", whole=not arguments.sample)
    for difference in differences:
        print(difference)
    if differences:
        print("Where that is meant: script/configs --update, and say in the commit which figures moved.")
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
