# SPDX-License-Identifier: Apache-2.0
"""The ready-made config in parts: looks that share a table are baked together, each part apart from the others, and the
config is put together from what `lutgen config` wrote for each."""

from __future__ import annotations

import concurrent.futures
import hashlib
import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import looks

ROOT = Path(__file__).resolve().parent.parent
# name, then version of the tool and of the profile.
NAME = "metamer-v{version}_ocio-v2.1"
DESCRIPTION = """Looks and named transforms that show a scene under another light, through a filter or by another camera.
Made with metamer (script/configs); the ACES 1 views are OpenColorIO's own."""
SECTIONS = ("looks", "named_transforms")


class BakeError(Exception):
    """lutgen's message, with the part it is about."""


@dataclass(frozen=True)
class Part:
    """Recipes that differ in adaptation alone."""

    name: str
    size: int
    tolerance: float
    looks: dict[str, str]  # name to YAML


def of(sets: list[looks.Set], size: int | None, tolerance: float) -> list[Part]:
    """Every look, in parts; `size` in place of each set's own."""
    found: dict[str, Part] = {}
    for one in sets:
        for name, text in one.recipes.items():
            stem = re.sub(r"_(000|050|100)$", "", name)
            found.setdefault(stem, Part(stem, size or one.size, tolerance, {})).looks[name] = text
    return list(found.values())


def version() -> str:
    return re.search(r"project\(metamer VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]


def engine_digest(lutgen: Path) -> str:
    """Of all that decides what a recipe becomes but the recipe: the program, the OpenColorIO it runs with, the data."""
    digest = hashlib.sha256(lutgen.read_bytes())
    linked = subprocess.run(["ldd", lutgen], capture_output=True, text=True, check=False).stdout
    for library in re.findall(r"=> (\S*libOpenColorIO\S*)", linked):
        digest.update(Path(library).read_bytes())
    for path in sorted((ROOT / "data").rglob("*")):
        if path.is_file():
            digest.update(str(path.relative_to(ROOT)).encode() + path.read_bytes())
    return digest.hexdigest()


def key(part: Part, engine: str) -> str:
    texts = [engine, DESCRIPTION, str(part.size), repr(part.tolerance), *part.looks.values(), *map(looks.filter_text, looks.FILTERS)]
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()


@dataclass(frozen=True)
class Store:
    """Where a part lies: its files in out/luts, what the config says of it and the key it was made by in out/.parts."""

    out: Path

    def folder(self, part: Part) -> Path:
        return self.out / ".parts" / part.name

    def files(self, part: Part) -> list[str]:
        """Names in out/luts; none where the part was never made whole."""
        stamp = self.folder(part) / "files"
        return stamp.read_text().split("\n")[1:] if stamp.exists() else []

    def is_made(self, part: Part, wanted_key: str) -> bool:
        stamp, files = self.folder(part) / "files", self.files(part)
        return bool(files) and stamp.read_text().startswith(wanted_key + "\n") and all(
            (self.out / "luts" / name).exists() for name in files)

    def bake(self, part: Part, wanted_key: str, lutgen: Path) -> None:
        folder, luts = self.folder(part), self.out / "luts"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        recipes = [self.out / "recipes" / f"{name}.yaml" for name in part.looks]
        command = [lutgen, "config", "-o", folder / "metamer.ocio", "--name", NAME.format(version=version()),
                   "--description", DESCRIPTION, "--tolerance", f"{part.tolerance:g}", "--size", part.size, *recipes]
        run = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
        if run.returncode != 0:
            raise BakeError(f"{part.name}: {run.stderr.strip()}")
        files = sorted((folder / "luts").iterdir())
        for file in files:
            file.replace(luts / file.name)
        (folder / "files").write_text("\n".join([wanted_key, *(file.name for file in files)]))


def bake(wanted: list[Part], out: Path, lutgen: Path, jobs: int) -> int:
    """Makes every part that does not lie in `out` as this program would make it; how many were."""
    if not lutgen.exists():
        raise BakeError(f"{lutgen}: no such program: build it (cmake --build --preset release --target lutgen), or name another by --lutgen")
    store, engine = Store(out), engine_digest(lutgen)
    (out / "luts").mkdir(exist_ok=True)
    keys = {part.name: key(part, engine) for part in wanted}
    stale = [part for part in wanted if not store.is_made(part, keys[part.name])]
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        futures = [pool.submit(store.bake, part, keys[part.name], lutgen) for part in stale]
        try:
            for future in concurrent.futures.as_completed(futures):
                future.result()
        except BakeError:
            # What is running is let end, the rest is not begun.
            pool.shutdown(cancel_futures=True)
            raise
    return len(stale)


def split(config: str) -> tuple[str, dict[str, list[str]]]:
    """What stands before the looks, and the entries of each section."""
    head, rest = config.split("\nlooks:\n")
    first, second = rest.split("\nnamed_transforms:\n")
    return head, {section: re.split(r"\n\n(?=  - !<)", text.strip("\n"))
                  for section, text in zip(SECTIONS, (first, second), strict=True)}


def assemble(wanted: list[Part], out: Path) -> None:
    """out/metamer.ocio from its parts; what belongs to none of them leaves out/luts."""
    store = Store(out)
    kept = {name for part in wanted for name in store.files(part)}
    for file in (out / "luts").iterdir():
        if file.name not in kept:
            file.unlink()
    entries: dict[str, list[str]] = {section: [] for section in SECTIONS}
    head = ""
    for part in wanted:
        head, sections = split((store.folder(part) / "metamer.ocio").read_text(encoding="utf-8"))
        for section in SECTIONS:
            entries[section] += sections[section]
    text = head + "".join(f"\n{section}:\n" + "\n\n".join(entries[section]) + "\n" for section in SECTIONS)
    (out / "metamer.ocio").write_text(text, encoding="utf-8")


def config_differences(checked_in: Path, made: Path, whole: bool) -> list[str]:
    """The names of entries of the config that was made that are not in the checked-in one. whole: nor the other way round."""
    import manifest

    (old_head, old), (new_head, new) = (
        split(manifest.without_version(path.read_bytes()).decode()) for path in (checked_in, made))
    lines = [] if old_head == new_head else ["metamer.ocio: another head"]
    for section in SECTIONS:
        if whole and old[section] == new[section]:
            continue
        different = set(new[section]) - set(old[section]) | (set(old[section]) - set(new[section]) if whole else set())
        names = sorted({entry.split("name: ")[1].split("\n")[0] for entry in different})
        lines += [f"metamer.ocio, {section}: {name} is another" for name in names]
        if whole and not names:
            lines.append(f"metamer.ocio, {section}: another order")
    return lines
