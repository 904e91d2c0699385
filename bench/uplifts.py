#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Time of each uplift, one core, beside colour-science's in the same run. Needs the bench libraries of a release build, in
METAMER_LIB (default: build/release/lib), and colour-science."""

import ctypes
import os
import time
import warnings
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Name, wanted nanoseconds, colours, rounds: all random in Rec.709's cube.
METHODS = (("smits", 100, 20_000, 20), ("mallett", 30, 20_000, 20), ("otsu", 100, 20_000, 20),
           ("jakob", 5000, 4_000, 5), ("jakob table", None, 20_000, 20), ("meng", None, 200, 3))


def main():
    os.environ.setdefault("METAMER_DATA", str(ROOT / "data"))
    folder = Path(os.environ.get("METAMER_LIB", ROOT / "build" / "release" / "lib"))
    door = ctypes.CDLL(str(folder / "libmetamer_uplift_door.so"))
    for function in (door.metamerUpliftTime, door.metamerUpliftLookupTime):
        function.restype = ctypes.c_double
    rgb = np.ascontiguousarray(np.random.default_rng(1).uniform(size=(200_000, 3)))
    pointer = rgb.ctypes.data_as(ctypes.c_void_p)
    warnings.simplefilter("ignore")
    import colour

    recovery = colour.recovery
    cmfs = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(colour.SpectralShape(380, 780, 5))
    light = colour.SDS_ILLUMINANTS["D65"].copy().align(cmfs.shape)
    xyz = colour.RGB_to_XYZ(rgb[:200], "sRGB")
    peers = {
        "smits": (50, lambda i: recovery.RGB_to_sd_Smits1999(rgb[i])),
        "mallett": (50, lambda i: recovery.RGB_to_sd_Mallett2019(rgb[i])),
        "otsu": (20, lambda i: recovery.XYZ_to_sd_Otsu2018(xyz[i])),
        "jakob": (5, lambda i: recovery.XYZ_to_sd_Jakob2019(xyz[i], cmfs, light)),
        "meng": (2, lambda i: recovery.XYZ_to_sd_Meng2015(xyz[i], cmfs, light)),
    }
    print(f"{'ns a colour, one core':28} {'metamer':>10} {'asked':>8} {'colour-science':>15}")

    def line(name, ours, asked, theirs):
        print(f"{name:28} {ours:10.0f} {asked or '':>8} {theirs:15.0f}" if theirs else f"{name:28} {ours:10.0f} {asked or '':>8}",
              flush=True)

    for name, asked, colours, rounds in METHODS:
        ours = door.metamerUpliftTime(name.encode(), pointer, ctypes.c_size_t(colours), rounds)
        theirs = None
        if name in peers:
            count, call = peers[name]
            start = time.perf_counter()
            for i in range(count):
                call(i)
            theirs = (time.perf_counter() - start) / count * 1e9
        line(name, ours, asked, theirs)
    seconds = ctypes.c_double()
    ours = door.metamerUpliftLookupTime(pointer, ctypes.c_size_t(200_000), 10, ctypes.byref(seconds))
    line("jakob table, coefficients", ours, 60, None)
    print(f"the table's own build: {seconds.value:.1f} s")


if __name__ == "__main__":
    main()
