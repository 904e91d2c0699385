# SPDX-License-Identifier: Apache-2.0
"""LED stages: an RGB wall's matrices, drives of fixtures with several emitters, and what they are measured with."""

from ._core import (
    EmitterMatch,
    WallCapture,
    WallSolution,
    calibration_square_beta,
    led_model,
    match_charts,
    non_negative_least_squares,
    phosphor_model,
)
from ._core import match_emitters as match
from ._core import panel_linearity as linearity
from ._core import solve_wall as solve

__all__ = [
    "EmitterMatch",
    "WallCapture",
    "WallSolution",
    "calibration_square_beta",
    "led_model",
    "linearity",
    "match",
    "match_charts",
    "non_negative_least_squares",
    "phosphor_model",
    "solve",
]
