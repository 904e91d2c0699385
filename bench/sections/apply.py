# SPDX-License-Identifier: Apache-2.0
"""lutgen apply on frames, HD, half, RGBA, ZIP, beside OpenImageIO copying them, two threads each.

OpenImageIO is the newest release where $METAMER_OIIO_PYTHON names a Python that has it (pip install OpenImageIO), or the
benchmark's own has; else what oiiotool on the path is.
"""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import OpenEXR

import peers
from timing import interleaved, spread

FRAMES, THREADS, ROUNDS = 50, 2, 3
RECIPE = "metamer: 1\nspace: ACEScg\ninput: {illuminant: D65}\noutput: {illuminant: HP1, adaptation: 0.5}\n"
COPY = """
import sys, OpenImageIO as oiio
oiio.attribute("threads", int(sys.argv[1]))
for frame in range(int(sys.argv[2])):
    picture = oiio.ImageBuf(f"in.{frame:04d}.exr")
    if not picture.write(f"copy.{frame:04d}.exr"):
        sys.exit(picture.geterror())
"""


def make_frames(folder):
    """A photograph with the noise of a camera, another each frame."""
    photograph = peers.photograph("coffee")[..., :3]
    random = np.random.default_rng(1)
    alpha = np.tile(np.linspace(0, 1, 1920, dtype=np.float16), (1080, 1))
    for frame in range(FRAMES):
        noise = random.standard_normal(photograph.shape, np.float32)
        pixels = photograph + noise * np.sqrt(np.maximum(0.0015 * photograph, 0) + 0.0015**2)
        rgba = np.dstack([pixels.astype(np.float16), alpha])
        OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, {"RGBA": rgba}).write(
            str(folder / f"in.{frame:04d}.exr"))


def copier():
    """(what it is, the call that copies all frames)"""
    python = os.environ.get("METAMER_OIIO_PYTHON") or (
        sys.executable if importlib.util.find_spec("OpenImageIO") is not None else None)
    if python:
        version = subprocess.run([python, "-c", "import OpenImageIO; print(OpenImageIO.VERSION_STRING)"], check=True,
                                 capture_output=True, text=True).stdout.strip()
        return f"OpenImageIO {version}", [python, "-c", COPY, str(THREADS), str(FRAMES)]
    tool = shutil.which("oiiotool")
    if tool is None:
        sys.exit("apply: nothing to copy with: install openimageio-tools, or name a Python with openimageio in METAMER_OIIO_PYTHON")
    version = re.search(r"[\d.]+", subprocess.run([tool, "--version"], check=True, capture_output=True, text=True).stdout)
    return f"oiiotool {version[0]}", [tool, "--threads", str(THREADS), "--frames", f"0-{FRAMES - 1}", "in.%04d.exr", "-o",
                                      "copy.%04d.exr"]


def run(context):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        make_frames(folder)
        (folder / "r.yaml").write_text(RECIPE, encoding="utf-8")
        peer, copy = copier()
        apply = [context.bin_folder / "lutgen", "apply", "r.yaml", "in.####.exr", "out.####.exr", "--engine", "map",
                 "--threads", str(THREADS), "--quiet"]

        def call(command):
            return lambda: subprocess.run([str(word) for word in command], cwd=folder, check=True)

        seconds = interleaved({"apply": call(apply), "copy": call(copy)}, ROUNDS)
        same = 0
        for frame in range(FRAMES):
            before, after = (OpenEXR.File(str(folder / f"{kind}.{frame:04d}.exr"), separate_channels=True).channels()
                             for kind in ("in", "out"))
            same += (before["A"].pixels.tobytes() == after["A"].pixels.tobytes()
                     and after["R"].pixels.dtype == np.float16 and not np.array_equal(before["R"].pixels, after["R"].pixels))
        return {"frames": FRAMES, "threads": THREADS, "rounds": ROUNDS, "peer": peer, "alpha_kept": same,
                "apply_seconds": float(np.median(seconds["apply"])), "copy_seconds": float(np.median(seconds["copy"])),
                "noise": max(spread(values) for values in seconds.values()),
                "of_the_copy": float(np.median(seconds["copy"] / seconds["apply"]))}


def markdown(f):
    return [f"{f['frames']} frames of 1920×1080, half, RGBA, ZIP, of a photograph with a camera's noise; {f['threads']} threads; whole "
            f"programs, the map's build among them; medians of {f['rounds']} interleaved rounds, noise ±{f['noise']:.0%}.", "",
            "| | seconds | frames a second |", "| --- | --- | --- |",
            f"| lutgen apply --engine map | {f['apply_seconds']:.1f} | {f['frames'] / f['apply_seconds']:.2f} |",
            f"| {f['peer']}, copying | {f['copy_seconds']:.1f} | {f['frames'] / f['copy_seconds']:.2f} |", "",
            f"apply runs at {f['of_the_copy']:.2f} of the speed of copying. Alpha came back bit for bit in {f['alpha_kept']} of "
            f"{f['frames']} frames."]
