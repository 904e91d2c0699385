# SPDX-License-Identifier: Apache-2.0
"""What looks there are: their recipes and the filters these name. configs/make.py bakes them (script/configs)."""

from __future__ import annotations

import math
import shutil
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

ADAPTATIONS = (0.0, 0.5, 1.0)

# Key in names, name in a recipe.
LIGHTS = {
    "d65": "D65", "d50": "D50", "a": "A", "3200k": "3200 K", "fl11": "FL11", "hp1": "HP1", "rgb_led": "LED-RGB1",
    "candle": "1900 K",
}
# Lights with lines: what they show of a scene is so little that going back from them is coarse whatever the table.
SPIKY = ("fl11", "hp1", "rgb_led")
CAMERAS = {
    "ricd": "ACES RICD", "canon_1d3": "Canon 1D MkIII (fit)", "canon_5d2_fit": "Canon 5D MkII (fit)",
    "canon_5d2": "Canon EOS 5D Mark II", "nikon_d5100": "Nikon D5100", "red_mx": "Red Mysterium X (fit)",
    "sigma_sd": "Sigma SDMerrill",
}

# What a set holds, in CIEDE2000 at the 99th percentile, and the most nodes along a side it may take for it: all tables
# together are to stay below 200 MB.
TOLERANCE = 1.0
SIZE = 49
SMALL_SIZE = 33


@dataclass(frozen=True)
class Set:
    """Recipes that are baked with one limit of size."""

    size: int
    recipes: dict[str, str] = field(default_factory=dict)  # name to YAML


def recipe(name: str, comment: str, given: str, wanted: str, adaptation: float | None, more: str = "") -> str:
    """One recipe. given, wanted: the inside of its input and output."""
    seen = "" if adaptation is None else f", adaptation: {adaptation:g}"
    return (f"# {comment}\nmetamer: 1\nname: {name}\nspace: ACEScg\ninput:  {{{given}}}\n"
            f"output: {{{wanted}{seen}}}\n{more}")


def in_words(adaptation: float) -> str:
    return {0.0: "the eye stays", 0.5: "the eye follows half-way", 1.0: "the eye adapts"}[adaptation]


def lights() -> tuple[Set, Set]:
    """Every light to every other, by the kind of the light it starts from."""
    sets = {False: Set(SIZE), True: Set(SMALL_SIZE)}
    for key, light in LIGHTS.items():
        for other, target in LIGHTS.items():
            for adaptation in ADAPTATIONS:
                name = f"{key}_to_{other}_{round(100 * adaptation):03}"
                if key != other:
                    sets[key in SPIKY].recipes[name] = recipe(
                        name, f"Shot under {light}, shown under {target}; {in_words(adaptation)}.",
                        f"illuminant: {light}", f"illuminant: {target}", adaptation)
    return sets[False], sets[True]


def planck(nm: float, kelvin: float) -> float:
    """A blackbody's spectral power, relative."""
    return nm**-5 / math.expm1(1.438776877e7 / (nm * kelvin))


def blackbody_ratio(to: float, given: float) -> Callable[[float], float]:
    """A filter that turns a blackbody of `given` kelvin into one of `to`, as light as it can be within 400 to 700 nm."""
    brightest = max(planck(nm, to) / planck(nm, given) for nm in range(400, 701))
    return lambda nm: min(1.0, planck(nm, to) / planck(nm, given) / brightest)


def didymium(nm: float) -> float:
    """Glass with neodymium and praseodymium, idealised: the deep notch at 585 nm, a shallow one at 527 nm."""
    notch = 0.94 * math.exp(-((nm - 585) / 13) ** 2)
    shallow = 0.35 * math.exp(-((nm - 527) / 8) ** 2)
    return 0.92 * (1 - notch) * (1 - shallow)


FILTERS: dict[str, tuple[str, Callable[[float], float]]] = {
    "cto": ("blackbody 5500 K to 3200 K", blackbody_ratio(3200, 5500)),
    "ctb": ("blackbody 3200 K to 5500 K", blackbody_ratio(5500, 3200)),
    "nd30": ("neutral, density 0.3", lambda nm: 10**-0.3),
    "didymium": ("notch at 585 nm, shallow one at 527 nm, idealised", didymium),
    "bandpass": ("490 to 610 nm, soft edges, idealised", lambda nm: 0.9 * math.exp(-(((nm - 550) / 66) ** 8))),
}


def filter_text(name: str) -> str:
    title, transmittance = FILTERS[name]
    rows = "".join(f"{nm},{transmittance(nm):.6f}\n" for nm in range(380, 781, 2))
    return f"# {title}. Computed by script/configs.\nnm,transmittance\n{rows}"


def filters() -> Set:
    """Filters in front of a daylight scene."""
    result = Set(SIZE)

    def add(name: str, title: str, file: str, density: float, light: str, adaptations: tuple, more: str = "") -> None:
        for adaptation in adaptations:
            full = f"{name}_{round(100 * adaptation):03}" if len(adaptations) > 1 else name
            words = f"; {in_words(adaptation)}" if len(adaptations) > 1 else ""
            result.recipes[full] = recipe(
                full, f"{title}{words}.", f"illuminant: {light}",
                f"illuminant: {light}, filters: [{{file: filters/{file}.csv, density: {density:g}}}]", adaptation, more)

    for size, density in (("full", 1.0), ("half", 0.5), ("quarter", 0.25)):
        add(f"cto_{size}", f"{size.capitalize()} orange before a daylight scene", "cto", density, "D65", ADAPTATIONS)
    for size, density in (("full", 1.0), ("half", 0.5), ("quarter", 0.25)):
        add(f"ctb_{size}", f"{size.capitalize()} blue before a tungsten scene", "ctb", density, "3200 K", ADAPTATIONS)
    for stops in (1, 2, 3):
        add(f"nd_{3 * stops:02}", f"Neutral density {0.3 * stops:.1f}: {stops} stops less", "nd30", stops, "D65", (1.0,),
            "keep_exposure: true\n")
    add("didymium", "A didymium filter before a daylight scene", "didymium", 1.0, "D65", ADAPTATIONS)
    add("bandpass", "A green bandpass before a daylight scene", "bandpass", 1.0, "D65", ADAPTATIONS)
    return result


def nights() -> Set:
    """Day for night: a bluer sky through a blue gel, three stops down."""
    result = Set(SIZE)
    for adaptation in ADAPTATIONS:
        name = f"day_for_night_{round(100 * adaptation):03}"
        result.recipes[name] = recipe(
            name, f"A day shown as night: high blue light, half a moonlight gel, three stops down; {in_words(adaptation)}.",
            "illuminant: D65",
            "illuminant: daylight 12000 K, filters: [{name: Lee 183 Moonlight Blue, density: 0.5}, "
            "{file: filters/nd30.csv, density: 2}]", adaptation, "keep_exposure: true\n")
    return result


def cameras() -> Set:
    """A camera's picture as another camera would have seen the scene, both white-balanced."""
    result = Set(SMALL_SIZE)
    for key, camera in CAMERAS.items():
        for other, target in CAMERAS.items():
            if key != other:
                name = f"{key}_as_{other}"
                result.recipes[name] = recipe(
                    name, f"Shot with {camera}, as {target} would have; daylight, neutrals stay neutral.",
                    f"illuminant: D65, observer: {camera}", f"illuminant: D65, observer: {target}", 1.0)
    return result


def all_sets() -> list[Set]:
    """In the order of the config."""
    return [*lights(), filters(), nights(), cameras()]


def write_recipes(folder: Path, sets: list[Set]) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "filters").mkdir(parents=True)
    for name in FILTERS:
        (folder / "filters" / f"{name}.csv").write_text(filter_text(name), encoding="utf-8")
    for one in sets:
        for name, text in one.recipes.items():
            (folder / f"{name}.yaml").write_text(text, encoding="utf-8")
