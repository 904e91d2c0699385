# SPDX-License-Identifier: Apache-2.0
"""Skin: what it is made of to its spectrum, and back from its colour.

    from metamer import skin

    estimator = skin.Estimator("D65")
    maps = estimator.estimate(albedo)              # height x width x 9
    flushed = estimator.colour(skin.flush(maps, 0.5))
"""

from ._core import SkinEstimator as Estimator
from ._core import SkinNetwork as Network
from ._core import bleach_skin as bleach
from ._core import flush_skin as flush
from ._core import multiply_skin as multiply
from ._core import oxygenate_skin as oxygenate
from ._core import sample_skins as sample
from ._core import set_skin as set_quantity
from ._core import skin_absorption as absorption
from ._core import skin_albedo as albedo
from ._core import skin_albedo_at as albedo_at
from ._core import smooth_skin as smooth
from ._core import tan_skin as tan
from ._core import thicken_skin as thicken
from ._core import virtual_skins

__all__ = [
    "Estimator",
    "Network",
    "absorption",
    "albedo",
    "albedo_at",
    "bleach",
    "flush",
    "multiply",
    "oxygenate",
    "sample",
    "set_quantity",
    "smooth",
    "tan",
    "thicken",
    "virtual_skins",
]
