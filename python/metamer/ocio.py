# SPDX-License-Identifier: Apache-2.0
"""LUT files: baked with their certificates, and compared. Needs the package opencolorio (docs/python.md).

    from metamer import ocio

    certificate = ocio.bake(recipe, "day_to_sodium.cube")
    ocio.compare(recipe, "day_to_sodium.cube").p99
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy
from numpy.typing import NDArray

from ._core import Library, Recipe
from ._types import File, RecipeLike

# Brings the library that _ocio is linked with, where it is linked with that package's.
with contextlib.suppress(ImportError):
    import PyOpenColorIO  # type: ignore[import-untyped, import-not-found, unused-ignore]  # noqa: F401

try:
    from . import _ocio
except ImportError as error:
    raise ImportError(
        "metamer.ocio needs the package opencolorio, of the release that metamer was built for, and a metamer built with it: "
        f"docs/python.md, LUT files ({error})"
    ) from error

__all__ = ["Comparison", "bake", "bake_text", "compare", "formats", "opencolorio_version"]

opencolorio_version: str = _ocio.opencolorio_version


@dataclass(frozen=True)
class Comparison:
    """CIEDE2000 between two transforms over the error protocol's probes and stops."""

    mean: float
    p99: float
    max: float
    space: str  #: linear, of the colours
    probes: Sequence[str]  #: name of each probe
    rgb: NDArray[numpy.float64]  #: what went in, a row each
    delta_e: NDArray[numpy.float64]  #: infinite where one result is not finite and the other is


def formats() -> dict[str, str]:
    """Names of the formats that can be written, and what each is for."""
    return dict(_ocio.formats())


def bake(
    recipe: RecipeLike,
    file: File,
    *,
    format: str = "",
    size: int = 0,
    sampled: bool = False,
    shaper: str | None = None,
    tolerance: float | None = None,
    stops: tuple[int, int] | None = None,
    shaper_size: int = 0,
    config: File | None = None,
    library: Library | None = None,
) -> dict[str, Any]:
    """Writes `file` and its certificate, FILE.json, as lutgen bake does; returns the certificate.

    `format` is a name of formats(), by the extension where it is empty; `size` the nodes along a side; `tolerance` the
    99th percentile of CIEDE2000 to hold with the cheapest that does; `stops` the exposures to judge by, round 18 %
    grey; `config` (a file, an archive, ocio://NAME) where spaces that are not built in are looked up, $OCIO where it is
    None.
    """
    arguments = _arguments(size, sampled, shaper, tolerance, stops, shaper_size, config)
    text = _ocio.bake_file(_text(recipe), library or Library(), os.fspath(file), format, arguments)
    return _certificate(text)


def bake_text(
    recipe: RecipeLike,
    format: str,
    *,
    size: int = 0,
    sampled: bool = False,
    shaper: str | None = None,
    tolerance: float | None = None,
    stops: tuple[int, int] | None = None,
    shaper_size: int = 0,
    config: File | None = None,
    library: Library | None = None,
) -> tuple[str, dict[str, Any]]:
    """The text of a file in a format, and its certificate, without any file."""
    arguments = _arguments(size, sampled, shaper, tolerance, stops, shaper_size, config)
    text, certificate = _ocio.bake_text(_text(recipe), library or Library(), format, arguments)
    return text, _certificate(certificate)


def compare(
    a: RecipeLike,
    b: RecipeLike,
    *,
    space: str | None = None,
    shaper: str = "",
    config: File | None = None,
    library: Library | None = None,
) -> Comparison:
    """How far two transforms are apart: each a Recipe, a recipe's file (.yaml), a LUT file, or CONFIG.ocio:LOOK.

    `space` and `shaper` say what the pixels of a LUT file are that has no certificate beside it; the other's space and
    ACEScct where they are not given.
    """
    tables = library or Library()
    recipes = [given if isinstance(given, Recipe) else Recipe.read(given) if _is_recipe(given) else None for given in (a, b)]
    for given, other in zip((a, b), reversed(recipes)):
        if other is None and not isinstance(given, Recipe) and os.fspath(given).lower().endswith(".ocio"):
            raise ValueError(f"{os.fspath(given)}: look: name one: {os.fspath(given)}:LOOK")
    pixels = space or next((recipe.space for recipe in recipes if recipe is not None), "ACEScg")

    def compared(index: int) -> Any:
        recipe, other = recipes[index], recipes[1 - index]
        if recipe is not None:
            return _ocio.compared_recipe(_text(recipe), tables, _name(config))
        name = os.fspath((a, b)[index])  # type: ignore[arg-type]
        file, mark, look = name.partition(".ocio:")
        if mark or name.lower().endswith(".ocio"):
            return _ocio.compared_look(file + ".ocio" if mark else name, look or (other.name if other else ""), tables)
        return _ocio.compared_file(name, pixels, shaper, tables, _name(config))

    used, (mean, p99, largest), names, colours = _ocio.compare(compared(0), compared(1), tables)
    table = numpy.array(colours, numpy.float64).reshape(-1, 4)
    return Comparison(mean, p99, largest, used, names, table[:, :3].copy(), table[:, 3].copy())


def _name(config: File | None) -> str | None:
    return None if config is None else os.fspath(config)


def _is_recipe(name: File) -> bool:
    return os.fspath(name).lower().endswith((".yaml", ".yml"))


def _text(given: RecipeLike) -> tuple[str, str, str]:
    recipe = given if isinstance(given, Recipe) else Recipe.read(given)
    if not recipe.is_named:
        raise ValueError(
            f"recipe '{recipe.name}': has spectra in place of names, which a certificate cannot name; save them as CSV "
            "and give the files"
        )
    return recipe.yaml(), recipe.where, recipe.folder


def _arguments(size: int, sampled: bool, shaper: str | None, tolerance: float | None, stops: tuple[int, int] | None,
               shaper_size: int, config: File | None) -> Any:
    arguments = _ocio.BakeArguments()
    arguments.size, arguments.sampled, arguments.shaper, arguments.tolerance = size, sampled, shaper, tolerance
    arguments.stops, arguments.shaper_size, arguments.config = stops, shaper_size, _name(config)
    return arguments


def _certificate(text: str) -> dict[str, Any]:
    certificate: dict[str, Any] = json.loads(text)
    return certificate
