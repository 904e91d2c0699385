# SPDX-License-Identifier: Apache-2.0
"""The chart scene of bench/render_scenes.py in Mitsuba: same geometry, spectra, camera and units."""

import csv
import os
import resource
import sys
from pathlib import Path

import numpy as np

DATA = Path(os.environ.get("METAMER_DATA", Path(__file__).resolve().parent.parent.parent / "data"))


def table(file, column):
    """Wavelengths and values of one column of a measured table."""
    with open(DATA / file, newline="") as stream:
        rows = [row for row in csv.reader(stream) if row and not row[0].startswith("#")]
    index = rows[0].index(column)
    values = [(float(row[0]), float(row[index])) for row in rows[1:] if row[index]]
    return np.array(values).T


def samples():
    with open(DATA / "reflectances/colorchecker.csv", newline="") as stream:
        return next(row for row in csv.reader(stream) if not row[0].startswith("#"))[1:]


LAMPS = {"A": "illuminants/cie_standard.csv", "D65": "illuminants/cie_standard.csv", "FL11": "illuminants/cie_fl.csv"}
# Its constant of normalisation is typed, 106.750, where its own table of the observer sums to 106.857.
CONSTANT = 106.750 / 106.857
DOMAIN = np.arange(380.0, 781.0)


def _spectrum(values):
    return {"type": "irregular", "wavelengths": ", ".join(f"{nm:g}" for nm in DOMAIN),
            "values": ", ".join(f"{value:.9g}" for value in values)}


def _sampled(file, column, holds_ends):
    nm, values = table(file, column)
    outside = None if holds_ends else 0.0
    return np.interp(DOMAIN, nm, values, left=outside, right=outside)


def _rectangle(mi, center, half_u, half_v, **children):
    u, v = np.array(half_u, float), np.array(half_v, float)
    n = np.cross(u, v)
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = u, v, n / np.linalg.norm(n), center
    return {"type": "rectangle", "to_world": mi.ScalarTransform4f(matrix), **children}


def render(lamp, size, count, variant, depth=2, seed=0):
    """Y (1 for a radiance of 1, as in metamer's films) and user CPU seconds of the render alone."""
    import mitsuba as mi

    mi.set_variant(variant)
    width, height = size
    scene = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": depth, "rr_depth": 1000},
        "sensor": {
            "type": "perspective",
            "fov": 34,
            "fov_axis": "x",
            "to_world": mi.ScalarTransform4f().look_at(origin=[0, 0, 10], target=[0, 0, 0], up=[0, 1, 0]),
            "sampler": {"type": "independent", "sample_count": count, "seed": seed},
            "film": {"type": "hdrfilm", "width": width, "height": height, "pixel_format": "xyz",
                     "rfilter": {"type": "box"}, "component_format": "float32"},
        },
        "lamp": _rectangle(mi, [-3, 4, 6], [0.3, 0, 0], [0, 0, 0.3],
                           emitter={"type": "area", "radiance": _spectrum(0.5 * _sampled(LAMPS[lamp], lamp, False))}),
    }
    for i, name in enumerate(samples()):
        u, v = (2 * (i % 6) + 1) / 6 - 1, 1 - (2 * (i // 6) + 1) / 4
        scene[f"patch{i}"] = _rectangle(
            mi, [3 * u, 2 * v, 0], [3 * 0.9 / 6, 0, 0], [0, 2 * 0.9 / 4, 0],
            bsdf={"type": "diffuse",
                  "reflectance": _spectrum(_sampled("reflectances/colorchecker.csv", name, True))})
    loaded = mi.load_dict(scene)
    if "llvm" in variant:
        np.array(mi.render(loaded, spp=1, seed=seed))  # what is compiled once does not count
    before = resource.getrusage(resource.RUSAGE_SELF).ru_utime
    picture = np.array(mi.render(loaded, spp=count, seed=seed + 1))
    seconds = resource.getrusage(resource.RUSAGE_SELF).ru_utime - before
    return picture[..., 1].astype(float) * CONSTANT, seconds


if __name__ == "__main__":
    _lamp, _width, _height, _count, _variant, _output = sys.argv[1:]
    _picture, _seconds = render(_lamp, (int(_width), int(_height)), int(_count), _variant)
    np.savez(_output, picture=_picture, seconds=_seconds)
