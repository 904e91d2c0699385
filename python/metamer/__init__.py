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
    Uplift,
    correlated_colour_temperature,
    delta_e_2000,
    lab,
    response,
    spectral_similarity_index,
    tristimulus,
    uplift_methods,
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
    "Uplift",
    "__version__",
    "correlated_colour_temperature",
    "delta_e_2000",
    "lab",
    "response",
    "spectral_similarity_index",
    "tristimulus",
    "uplift_methods",
]
