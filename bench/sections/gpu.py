# SPDX-License-Identifier: Apache-2.0
"""What there is for graphics cards, as far as a machine without one tells: the plug-in's OpenCL kernel on a driver for
processors beside the processor's own kernel, what shader files and OpenColorIO's shader are off, what the bundle weighs."""

import ctypes
import json
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import peers
from timing import interleaved, spread

from sections.ofx import THREADS, Effect

REPOSITORY = Path(__file__).resolve().parent.parent.parent
RECIPE = REPOSITORY / "demo/recipes/day_to_sodium_000.yaml"
FILES = ("cl", "dctl", "ctf", "clf", "cube")
PROCESSOR, DEVICE = "the processor's kernel", "the OpenCL kernel"


class OnDevice:
    """Spectral Transfer where its host's pictures lie in OpenCL buffers."""

    def __init__(self, folder, picture):
        self.library = ctypes.CDLL(str(folder / "libmetamer_ofx_bench_door.so"))
        self.library.ofxOpenDevice.restype = ctypes.c_void_p
        height, self.width = picture.shape[:2]
        self.shape = picture.shape
        pixels = np.ascontiguousarray(picture, np.float32)
        self.handle = ctypes.c_void_p(self.library.ofxOpenDevice(pixels.ctypes.data_as(ctypes.c_void_p), self.width, height))

    def is_there(self):
        return bool(self.handle.value)

    def close(self):
        self.library.ofxCloseDevice(self.handle)

    def set(self, name, value):
        self.library.ofxSetTextOnDevice(self.handle, name.encode(), value.encode())

    def render(self):
        if self.library.ofxRenderOnDevice(self.handle) != 0:
            raise RuntimeError("the plug-in failed to render")

    def result(self):
        pixels = np.empty(self.shape, np.float32)
        self.library.ofxBringFromDevice(self.handle, pixels.ctypes.data_as(ctypes.c_void_p))
        return pixels


def kernels(context):
    """Frames a second of an HD picture, and whether the bits are the same; nothing where there is no driver."""
    folder = context.bin_folder.parent / "lib"
    picture = peers.photograph("astronaut")
    device = OnDevice(folder, picture)
    if not device.is_there():
        return None
    effect = Effect(folder)
    destination = np.empty_like(picture)
    effect.connect(picture, destination)
    effect.set(outputIlluminant="HP1")
    device.set("outputIlluminant", "HP1")
    times = interleaved({PROCESSOR: effect.render, DEVICE: device.render}, context.rounds)
    same = device.result().tobytes() == destination.tobytes()
    device.close()
    return {"size": list(picture.shape[1::-1]), "threads": THREADS, "same_bits": same,
            "frames_per_second": {name: 1 / float(np.median(each)) for name, each in times.items()},
            "noise": spread(times[DEVICE])}


def files(bin_folder):
    """The certificates of one recipe's files."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for extension in FILES:
            file = Path(folder) / f"look.{extension}"
            subprocess.run([bin_folder / "lutgen", "bake", RECIPE, "-o", file], check=True, capture_output=True)
            certificate = json.loads(file.with_name(file.name + ".json").read_text())
            cards = certificate.get("graphics_cards", {})
            rows.append({"file": f".{extension}", "kilobytes": file.stat().st_size / 1000,
                         **{key: {k: certificate["error"][k] for k in ("p99", "max")} for key in ("error",)},
                         **{key: {k: cards[key][k] for k in ("p99", "max")} for key in ("float_textures", "half_textures")
                            if key in cards}})
    return rows


def run(context):
    bundle = next((context.bin_folder.parent / "OFX").rglob("metamer.ofx"))
    texts = context.bin_folder.parent / "ofx/window_texts"
    return {"kernels": kernels(context), "files": files(context.bin_folder), "recipe": RECIPE.stem,
            "bundle_bytes": bundle.stat().st_size,
            "text_bytes": {name: (texts / f"window.{name}").stat().st_size for name in ("ptx", "cl", "metal")},
            "card": os.path.exists("/dev/nvidia0") or os.path.isdir("/dev/dri")}


def markdown(results):
    lines = []
    seen = results["kernels"]
    if seen is None:
        lines += ["No OpenCL driver: the plug-in's kernel was not run."]
    else:
        speed = seen["frames_per_second"]
        lines += [f"Spectral Transfer, map quality, {seen['size'][0]}×{seen['size'][1]} RGBA float, daylight to sodium: {speed[PROCESSOR]:.1f} "
                  f"frames/s by the processor's kernel on {seen['threads']} threads, {speed[DEVICE]:.1f} (±{seen['noise']:.0%}) by the OpenCL kernel on "
                  f"pocl, a driver for the same processor; {'the same bits' if seen['same_bits'] else 'other bits'}."]
    lines += ["", f"Files of `{results['recipe']}`, CIEDE2000 against the engine; on cards: through OpenColorIO's shader, its tables as textures:", "",
              "| file | kB | p99 | max | float textures, p99 | max | half textures, p99 | max |",
              "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    for row in results["files"]:
        figures = " | ".join(f"{row[key][k]:.3f}" if key in row else "–" for key in ("error", "float_textures", "half_textures")
                             for k in ("p99", "max"))
        lines.append(f"| `{row['file']}` | {row['kilobytes']:.0f} | {figures} |")
    weights = ", ".join(f"`window.{name}` {size / 1000:.0f} kB" for name, size in results["text_bytes"].items())
    lines += ["", f"The bundle's library: {results['bundle_bytes'] / 1e6:.2f} MB, of which kernels: {weights}.",
              "", "No graphics card was in this machine: none of this ran on one." if not results["card"] else
              "A graphics card is in this machine; nothing here ran on it."]
    return lines
