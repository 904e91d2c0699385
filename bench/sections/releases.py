# SPDX-License-Identifier: Apache-2.0
"""A .clf of a log and 33^3 nodes through the OpenColorIO that metamer links and through an older one, in turn, one core."""

import subprocess
import tempfile
from pathlib import Path

import numpy as np
import PyOpenColorIO as ocio

import peers
from timing import interleaved, spread

SIZE = 33
LOG_AND_TABLE, BAKED = f"log + {SIZE}³", f"lutgen's: log, curve, {SIZE}³, antilog"


def bake(context, pair, folder):
    file = Path(folder) / f"{pair[0]}_{pair[1]}.clf"
    subprocess.run([context.bin_folder / "lutgen", "bake", "--illuminant-in", pair[0], "--illuminant-out", pair[1],
                    "--size", str(SIZE), "-o", file], check=True, stdout=subprocess.DEVNULL)
    return file


def log_and_table(file):
    """Of a file that lutgen baked, the first log and the table alone: a lattice as most programs write it."""
    group = ocio.Config.CreateRaw().getProcessor(ocio.FileTransform(src=str(file))).createGroupTransform()
    operators = list(group)
    kept = [operators[0], *(one for one in operators if isinstance(one, ocio.Lut3DTransform))]
    assert isinstance(kept[0], ocio.LogCameraTransform) and len(kept) == 2, [type(one) for one in operators]
    written = file.with_name(f"{file.stem}_log_and_table.clf")
    ocio.GroupTransform(kept).write("Academy/ASC Common LUT Format", str(written), ocio.Config.CreateRaw())
    return written


def compared(context, pair, kind, file, picture, exact):
    calls = {"linked": context.linked_ocio.file(file, False, exact), "older": context.older_ocio.file(file, False, exact)}
    results = {name: np.empty_like(picture) for name in calls}
    times = interleaved({name: (lambda n=name: calls[n](picture, results[n])) for name in calls}, context.rounds)
    size = np.abs(results["older"]).max(axis=-1, keepdims=True)
    return {"pair": "->".join(pair), "file": kind, "logarithm": "exact" if exact else "fast",
            "nanoseconds_per_pixel": {name: float(np.median(s)) / (picture.size / 4) * 1e9 for name, s in times.items()},
            "noise": {name: spread(s) for name, s in times.items()},
            "linked_is_faster_by": float(np.median(times["older"] / times["linked"])),
            "differ_by": float((np.abs(results["linked"] - results["older"]) / size).max())}


def run(context):
    rows = []
    picture = peers.photograph("astronaut")
    with tempfile.TemporaryDirectory() as folder:
        for pair in peers.PAIRS[:3]:
            baked = bake(context, pair, folder)
            for kind, file in ((LOG_AND_TABLE, log_and_table(baked)), (BAKED, baked)):
                rows += [compared(context, pair, kind, file, picture, exact) for exact in (False, True)]
    return {"linked": context.linked_ocio.version, "older": context.older_ocio.version, "rows": rows}


def markdown(results):
    linked, older = results["linked"], results["older"]
    lines = [f"A `.clf` on linear ACEScg through OpenColorIO {linked}, which metamer links, and through {older}. Fast logarithms are "
             "OpenColorIO's default; metamer asks for exact ones. Differences are the largest of a pixel's own size.", "",
             f"| | file | logarithm | {linked}, ns/pixel | noise | {older}, ns/pixel | noise | times as fast | differ by |",
             "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    for row in results["rows"]:
        time, noise = row["nanoseconds_per_pixel"], row["noise"]
        lines.append(f"| {row['pair']} | {row['file']} | {row['logarithm']} | {time['linked']:.1f} | ±{noise['linked']:.0%} | {time['older']:.1f} "
                     f"| ±{noise['older']:.0%} | {row['linked_is_faster_by']:.1f} | {row['differ_by']:.1e} |")
    return lines
