# SPDX-License-Identifier: Apache-2.0
"""What comparisons with Mitsuba share: metamer's tables as its spectra, rectangles, and a timed render."""

import csv
import os
import re
import resource
import time
from pathlib import Path

import numpy as np

DATA = Path(os.environ.get("METAMER_DATA", Path(__file__).resolve().parent.parent.parent / "data"))


def use_newest_llvm():
    """Dr.Jit takes the first LLVM it finds, and older ones take the program down on processors they do not know."""
    libraries = Path("/usr/lib").glob("*-linux-gnu/libLLVM*.so*")
    versions = [([int(number) for number in re.findall(r"\d+", path.name)], str(path)) for path in libraries]
    if versions and "DRJIT_LIBLLVM_PATH" not in os.environ:
        os.environ["DRJIT_LIBLLVM_PATH"] = max(versions)[1]


def table(file, column):
    """Wavelengths and values of one column of a measured table."""
    with open(DATA / file, newline="") as stream:
        rows = [row for row in csv.reader(stream) if row and not row[0].startswith("#")]
    index = rows[0].index(column)
    values = [(float(row[0]), float(row[index])) for row in rows[1:] if row[index]]
    return np.array(values).T


# Its constant of normalisation is typed, 106.750, where its own table of the observer sums to 106.857.
CONSTANT = 106.750 / 106.857
DOMAIN = np.arange(380.0, 781.0)


def spectrum(values):
    return {"type": "irregular", "wavelengths": ", ".join(f"{nm:g}" for nm in DOMAIN),
            "values": ", ".join(f"{value:.9g}" for value in values)}


def sampled(file, column, holds_ends):
    nm, values = table(file, column)
    outside = None if holds_ends else 0.0
    return np.interp(DOMAIN, nm, values, left=outside, right=outside)


def rectangle(mi, center, half_u, half_v, **children):
    u, v = np.array(half_u, float), np.array(half_v, float)
    n = np.cross(u, v)
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = u, v, n / np.linalg.norm(n), center
    return {"type": "rectangle", "to_world": mi.ScalarTransform4f(matrix), **children}


def picture_film(size):
    return {"type": "hdrfilm", "width": size[0], "height": size[1], "pixel_format": "xyz", "rfilter": {"type": "box"},
            "component_format": "float32"}


def processor_seconds():
    """Of this process so far, user and system."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def timed_render(mi, scene, variant, count, seed):
    """Y (1 for a radiance of 1, as in metamer's films); processor and wall seconds of the render alone."""
    loaded = mi.load_dict(scene)
    if "llvm" in variant:
        np.array(mi.render(loaded, spp=count, seed=seed))  # what is compiled once does not count
    before, start = processor_seconds(), time.perf_counter()
    picture = np.array(mi.render(loaded, spp=count, seed=seed + 1))
    wall = time.perf_counter() - start
    return picture[..., 1].astype(float) * CONSTANT, processor_seconds() - before, wall
