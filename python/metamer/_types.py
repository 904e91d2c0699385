# SPDX-License-Identifier: Apache-2.0
"""What the module's functions take, for type checkers."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeAlias, TypeVar, Union

import numpy
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ._core import Map, Observer, Recipe, Spectrum, Transform


class Sampled(Protocol):
    """An object with samples over wavelengths: colour-science's spectral distributions are."""

    @property
    def wavelengths(self) -> Any: ...

    @property
    def values(self) -> Any: ...


Float = TypeVar("Float", numpy.float32, numpy.float64)

Quantity: TypeAlias = Literal["power", "sensitivity", "reflectance", "transmittance"]
Response: TypeAlias = Literal["xyz", "lms", "camera"]
File: TypeAlias = Union[str, "os.PathLike[str]"]

SpectrumLike: TypeAlias = Union["Spectrum", Mapping[float, float], Sampled]
ObserverLike: TypeAlias = Union["Observer", Sampled]
NamedSpectrum: TypeAlias = Union[File, SpectrumLike]
NamedObserver: TypeAlias = Union[File, ObserverLike]
FilterLike: TypeAlias = Union[NamedSpectrum, tuple[NamedSpectrum, float]]
RecipeLike: TypeAlias = Union["Recipe", File]
Candidate: TypeAlias = Union["Transform", "Map", Callable[[NDArray[numpy.float32]], Union[NDArray[Any], None]]]
