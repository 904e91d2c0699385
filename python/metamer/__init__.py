# SPDX-License-Identifier: Apache-2.0
"""Colour transforms from spectra.

    import metamer

    recipe = metamer.Recipe("D65", "HP1", adaptation=0.5)
    relit = metamer.Transform(recipe)(pixels)

LED stages are in `metamer.stage`, skin is in `metamer.skin`.
"""

from ._core import (
    Comparison,
    ErrorProtocol,
    Library,
    Map,
    Observer,
    Recipe,
    Report,
    Spectrum,
    Transform,
    correlated_colour_temperature,
    delta_e_2000,
    lab,
    response,
    spectral_similarity_index,
    tristimulus,
)
from ._core import version as __version__

__all__ = [
    "Comparison",
    "ErrorProtocol",
    "Library",
    "Map",
    "Observer",
    "Recipe",
    "Report",
    "Spectrum",
    "Transform",
    "__version__",
    "correlated_colour_temperature",
    "delta_e_2000",
    "lab",
    "response",
    "spectral_similarity_index",
    "tristimulus",
]
