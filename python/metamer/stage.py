# SPDX-License-Identifier: Apache-2.0
"""LED stages: an RGB wall's matrices, drives of fixtures with several emitters, and what they are measured with."""

from ._core import (
    CaptureFault,
    EmitterMatch,
    WallCapture,
    WallIntervals,
    WallSolution,
    calibration_square_beta,
    led_model,
    match_charts,
    non_negative_least_squares,
    phosphor_model,
)
from ._core import capture_faults as faults
from ._core import match_emitters as match
from ._core import panel_linearity as linearity
from ._core import solve_wall as solve
from ._core import wall_intervals as intervals

__all__ = [
    "CaptureFault",
    "EmitterMatch",
    "WallCapture",
    "WallIntervals",
    "WallSolution",
    "calibration_square_beta",
    "faults",
    "intervals",
    "led_model",
    "linearity",
    "match",
    "match_charts",
    "non_negative_least_squares",
    "phosphor_model",
    "solve",
]
