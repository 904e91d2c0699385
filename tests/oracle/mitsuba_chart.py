# SPDX-License-Identifier: Apache-2.0
"""The chart scene of bench/render_scenes.py in Mitsuba: same geometry, spectra, camera and units.

mitsuba_chart.py LAMP WIDTH HEIGHT SAMPLES VARIANT DEPTH OUTPUT.npz
"""

import csv
import sys

import numpy as np
from mitsuba_scene import DATA, picture_film, rectangle, sampled, spectrum, timed_render, use_newest_llvm

LAMPS = {"A": "illuminants/cie_standard.csv", "D65": "illuminants/cie_standard.csv", "FL11": "illuminants/cie_fl.csv"}


def chart(mi, center, half_u, half_v):
    """The 24 patches of a chart with gaps of a tenth, by name."""
    with open(DATA / "reflectances/colorchecker.csv", newline="") as stream:
        names = next(row for row in csv.reader(stream) if not row[0].startswith("#"))[1:]
    center, half_u, half_v = (np.array(vector, float) for vector in (center, half_u, half_v))
    patches = {}
    for i, name in enumerate(names):
        u, v = (2 * (i % 6) + 1) / 6 - 1, 1 - (2 * (i // 6) + 1) / 4
        patches[f"patch{i}"] = rectangle(
            mi, center + half_u * u + half_v * v, half_u * 0.9 / 6, half_v * 0.9 / 4,
            bsdf={"type": "diffuse", "reflectance": spectrum(sampled("reflectances/colorchecker.csv", name, True))})
    return patches


def render(lamp, size, count, variant, depth=2, seed=0):
    """Y (1 for a radiance of 1, as in metamer's films); processor and wall seconds of the render alone."""
    use_newest_llvm()
    import mitsuba as mi

    mi.set_variant(variant)
    scene = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": depth, "rr_depth": 1000},
        "sensor": {
            "type": "perspective",
            "fov": 34,
            "fov_axis": "x",
            "to_world": mi.ScalarTransform4f().look_at(origin=[0, 0, 10], target=[0, 0, 0], up=[0, 1, 0]),
            "sampler": {"type": "independent", "sample_count": count, "seed": seed},
            "film": picture_film(size),
        },
        "lamp": rectangle(mi, [-3, 4, 6], [0.3, 0, 0], [0, 0, 0.3],
                          emitter={"type": "area", "radiance": spectrum(0.5 * sampled(LAMPS[lamp], lamp, False))}),
        **chart(mi, [0, 0, 0], [3, 0, 0], [0, 2, 0]),
    }
    return timed_render(mi, scene, variant, count, seed)


if __name__ == "__main__":
    _lamp, _width, _height, _count, _variant, _depth, _output = sys.argv[1:]
    _picture, _processor, _wall = render(_lamp, (int(_width), int(_height)), int(_count), _variant, int(_depth))
    np.savez(_output, picture=_picture, processor=_processor, wall=_wall)
