# SPDX-License-Identifier: Apache-2.0
"""Lights that tell little apart, or are hard to integrate."""

import numpy as np

from door import Engine

# Just noticeable.
VISIBLE = 1.0
# What the engine's own number of bands may cost against 401.
CONVERGED = 401
SPIKY_AND_SMOOTH = (("FL11", "D65"), ("D65", "FL11"), ("HP1", "A"), ("A", "HP1"), ("LED-RGB1", "D65"), ("FL11", "HP1"))
BANDS = (16, 41, 81, 161, 251)


def line(nm):
    return [(380, 0), (nm - 1, 0), (nm, 1), (nm + 1, 0), (780, 0)]


def band(low, high):
    return [(380, 0), (low - 1, 0), (low, 1), (high, 1), (high + 1, 0), (780, 0)]


def laser(b):
    return b.bake(b.spectrum("laser.csv", line(532)), "D65")


def one_led(b):
    rows = [(w, float(np.exp(-0.5 * ((w - 630) / 10) ** 2))) for w in range(380, 781, 2)]
    return b.bake(b.spectrum("led.csv", rows), "D65")


def low_pressure_sodium(b):
    return b.bake("LPS", "D65")


def no_overlap(b):
    return b.bake(b.spectrum("blue.csv", band(400, 450)), b.spectrum("red.csv", band(650, 700)))


def zero_filter(b):
    return b.bake("D65", "D65", filter_in=b.spectrum("zero.csv", [(380, 0), (780, 0)], "transmittance"))


def no_power(b):
    return b.bake(b.spectrum("dark.csv", [(380, 0), (780, 0)]), "D65")


def _error(b, handle, probes, pair, bands):
    converged, _ = Engine(b.door, *pair, CONVERGED).apply(probes)
    result, _ = Engine(b.door, *pair, bands).apply(probes)
    errors = b.door.delta_e(handle, converged, result)
    return float(np.quantile(errors, 0.99)), bool(np.isfinite(result).all())


def spiky_against_smooth(b):
    """The default number of bands, lines against continua both ways."""
    handle = b.door.open("D65", "A")
    probes = b.door.probes(handle)[::4]
    rows = {"->".join(pair): _error(b, handle, probes, pair, 251) for pair in SPIKY_AND_SMOOTH}
    b.door.close(handle)
    good = all(finite and p99 <= VISIBLE for p99, finite in rows.values())
    return int(not good), "p99 of 251 bands against 401: " + ", ".join(f"{k} {p99:.3f}" for k, (p99, _) in rows.items())


def few_and_many_bands(b):
    """Lines of a lamp are integrated at a nanometre whatever the bands: 16 bands are coarse, not wrong."""
    handle = b.door.open("D65", "FL11")
    probes = b.door.probes(handle)[::4]
    rows = {bands: _error(b, handle, probes, ("D65", "FL11"), bands) for bands in BANDS}
    b.door.close(handle)
    p99 = [row[0] for row in rows.values()]
    good = all(finite for _, finite in rows.values()) and p99 == sorted(p99, reverse=True) and p99[0] <= 10 * VISIBLE
    return int(not good), "D65->FL11, p99 against 401 bands: " + ", ".join(f"{k}: {v:.3f}" for k, (v, _) in rows.items())
