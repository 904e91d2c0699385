# SPDX-License-Identifier: Apache-2.0
"""The LED-wall box of bench/render_scenes.py in Mitsuba: same geometry, spectra, camera and units.

Its textures hold no mixtures of given spectra, so each pixel of the wall is an area light with a spectrum of its own,
chosen in proportion to its luminance.

mitsuba_wall.py PICTURE.exr WIDTH HEIGHT SAMPLES VARIANT DEPTH OUTPUT.npz
"""

import sys

import numpy as np
from mitsuba_chart import chart
from mitsuba_scene import DOMAIN, picture_film, rectangle, sampled, spectrum, table, timed_render, use_newest_llvm

EMITTERS = ("LED-B1", "LED-V1", "LED-RGB1")
SCALE = 0.02


def wall(mi, drives):
    """Lights that face down, by name. @param drives  rows x columns x emitters"""
    emitters = np.array([sampled("illuminants/cie_led.csv", name, False) for name in EMITTERS])
    luminance = np.interp(DOMAIN, *table("observers/cie_1931_2.csv", "Y"))
    center, half_u, half_v = np.array([0, 3.2, 0.5]), np.array([1.8, 0, 0]), np.array([0, 0, 1.4])
    rows, columns, _ = drives.shape
    lights = {}
    for row in range(rows):
        for column in range(columns):
            radiance = SCALE * np.maximum(drives[row, column], 0) @ emitters
            u, v = (2 * column + 1) / columns - 1, 1 - (2 * row + 1) / rows
            lights[f"light{row}_{column}"] = rectangle(
                mi, center + half_u * u + half_v * v, half_u / columns, half_v / rows,
                emitter={"type": "area", "radiance": spectrum(radiance),
                         "sampling_weight": float(max(radiance @ luminance, 1e-6))})
    return lights


def render(picture, size, count, variant, depth=2, seed=0):
    """Y (1 for a radiance of 1, as in metamer's films); processor and wall seconds of the render alone."""
    import OpenEXR

    use_newest_llvm()
    import mitsuba as mi

    mi.set_variant(variant)
    grey = {"type": "diffuse", "reflectance": spectrum(np.full(DOMAIN.size, 0.5))}
    drives = OpenEXR.File(str(picture)).channels()["RGB"].pixels.astype(float)
    scene = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": depth, "rr_depth": 1000},
        "sensor": {
            "type": "perspective",
            "fov": 40,
            "fov_axis": "x",
            "to_world": mi.ScalarTransform4f().look_at(origin=[0, 1.2, 7], target=[0, 1.2, 0], up=[0, 1, 0]),
            "sampler": {"type": "independent", "sample_count": count, "seed": seed},
            "film": picture_film(size),
        },
        "floor": rectangle(mi, [0, 0, 1], [2, 0, 0], [0, 0, -2], bsdf=grey),
        "back": rectangle(mi, [0, 1.5, -1], [2, 0, 0], [0, 1.5, 0], bsdf=grey),
        "ball": {"type": "sphere", "center": [-0.8, 0.5, 1.2], "radius": 0.5, "bsdf": grey},
        **chart(mi, [0.6, 1.2, 0], [0.9, 0, 0], [0, 0.6, 0]),
        **wall(mi, drives),
    }
    return timed_render(mi, scene, variant, count, seed)


if __name__ == "__main__":
    _file, _width, _height, _count, _variant, _depth, _output = sys.argv[1:]
    _picture, _processor, _wall = render(_file, (int(_width), int(_height)), int(_count), _variant, int(_depth))
    np.savez(_output, picture=_picture, processor=_processor, wall=_wall)
