# SPDX-License-Identifier: Apache-2.0
"""Files that are not what they say, and folders that take none."""

import resource
import signal
import subprocess
import time

import numpy as np
import OpenEXR

MALFORMED = 12
SCENE = """metamer_scene: 1
film: {width: 64, height: 48}
camera: {origin: [0, 0, 9], target: [0, 0, 0], up: [0, 1, 0], fov_x: 12}
integrator: {max_depth: 4, wavelengths: 4}
spectra: {lamp: {illuminant: A, scale: 12}}
shapes:
  - rectangle: {center: [0, 0, 0], half_u: [1, 0, 0], half_v: [0, 1, 0]}
    diffuse: 0.5
  - rectangle: {center: [-3, 4, 6], half_u: [1, 0, 0], half_v: [0, 0, 1]}
    emission: lamp
"""
SPDX = """<?xml version="1.0" encoding="UTF-8"?>
<IESTM2714 xmlns="http://www.ies.org/iestm2714" version="1.0"><Header><Description>lamp</Description></Header>
<SpectralDistribution><SpectralQuantity>flux</SpectralQuantity>
{}</SpectralDistribution></IESTM2714>
"""


def _seeds(b):
    """A good file of each kind, and the call that reads it."""
    wavelengths = range(380, 781, 10)
    (b.folder / "good.csv").write_text("wavelength_nm,power\n" + "".join(f"{w},{w / 500:.4f}\n" for w in wavelengths))
    (b.folder / "good.spdx").write_text(SPDX.format("".join(
        f'<SpectralData wavelength="{w}">{w / 500:.4f}</SpectralData>\n' for w in wavelengths)))
    rows = ", ".join(f'"{w}": [{w / 900:.3f}, {1 - abs(w - 540) / 300:.3f}, {(780 - w) / 500:.3f}]' for w in wavelengths)
    (b.folder / "good.json").write_text('{"header": {"schema_version": "1.0.0", "manufacturer": "a", "model": "b"}, '
                                        f'"spectral_data": {{"units": "relative", "index": {{"main": ["R", "G", "B"]}}, '
                                        f'"data": {{"main": {{{rows}}}}}}}}}')
    b.recipe("D65", "A")
    (b.folder / "hard.yaml").rename(b.folder / "good.yaml")
    OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage},
                 {"RGB": np.random.default_rng(6).random((8, 9, 3)).astype(np.float32)}).write(str(b.folder / "good.exr"))
    (b.folder / "good.cube").write_text("LUT_3D_SIZE 2\n" + "".join(
        f"{i & 1} {i >> 1 & 1} {i >> 2 & 1}\n" for i in range(8)))
    b.recipe("D65", "A")
    small = ("-o", "out.cube", "--size", "3", "--sampled")
    return {"csv": lambda f: ("bake", "--illuminant-in", f, "--illuminant-out", "A", *small),
            "spdx": lambda f: ("bake", "--illuminant-in", f, "--illuminant-out", "A", *small),
            "json": lambda f: ("bake", "--illuminant-in", "D65", "--illuminant-out", "A", "--observer-in", f, *small),
            "yaml": lambda f: ("bake", f, *small),
            "exr": lambda f: ("apply", "hard.yaml", f, "out.exr"),
            "cube": lambda f: ("apply", f, "good.exr", "out.exr")}


def _spoilt(data, generator):
    """Cut off, with bytes changed, doubled or taken out."""
    data = bytearray(data)
    at = int(generator.integers(len(data)))
    kind = generator.integers(4)
    if kind == 0:
        return bytes(data[:at])
    if kind == 1:
        for place in generator.integers(len(data), size=8):
            data[place] = generator.integers(256)
    elif kind == 2:
        data[at:at] = data[at:at + 40] * 3
    else:
        del data[at:at + 20]
    return bytes(data)


def malformed(b):
    """Every kind of file that is read, spoilt: an answer in one line, never a crash. The fuzzers do the same for hours."""
    generator, outcomes, failed = np.random.default_rng(8), [], 0
    for extension, call in _seeds(b).items():
        code, message = b.run(*call(f"./good.{extension}"))
        if code != 0:
            return 1, f"the good .{extension} is refused: {message}"
        seed = (b.folder / f"good.{extension}").read_bytes()
        refused = accepted = 0
        for _ in range(MALFORMED):
            (b.folder / f"bad.{extension}").write_bytes(_spoilt(seed, generator))
            code, message = b.run(*call(f"./bad.{extension}"))
            refused += code == 1 and message.startswith("lutgen: ") and "\n" not in message
            accepted += code == 0
        failed += MALFORMED - refused - accepted
        outcomes.append(f".{extension}: {refused} refused in a line, {accepted} still good")
    return failed, "; ".join(outcomes) + f"; {failed} otherwise"


def _full_disk():
    """Files end at 2 KiB, as if nothing more fitted."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2048, 2048))


def full_disk(b):
    (b.folder / "scene.yaml").write_text(SCENE)
    recipe = b.recipe("D65", "A")
    OpenEXR.File({"compression": OpenEXR.NO_COMPRESSION, "type": OpenEXR.scanlineimage},
                 {"RGB": np.random.default_rng(6).random((48, 64, 3)).astype(np.float32)}).write(str(b.folder / "in.exr"))
    before = {path.name for path in b.folder.iterdir()}
    outcomes, failed = [], 0
    for program, arguments in (("lutgen", ("bake", recipe, "-o", "full.ctf", "--size", "9")),
                               ("lutgen", ("bake", recipe, "-o", "full.cube", "--size", "9")),
                               ("lutgen", ("apply", recipe, "in.exr", "full.exr")),
                               ("spectral_ref", ("render", "scene.yaml", "-o", "full.exr", "--spp", "1"))):
        code, message = b.run(*arguments, program=program, preexec_fn=_full_disk)
        left = sorted({path.name for path in b.folder.iterdir()} - before)
        good = code == 1 and "\n" not in message and not left
        failed += not good
        outcomes.append(f"{message}" if good else f"{program} {arguments[0]}: exit {code}, left {left}, {message}")
    return failed, "; ".join(outcomes) + "; nothing is left behind"


def read_only_folder(b):
    code, message = b.run("bake", "--illuminant-in", "D65", "--illuminant-out", "A", "-o", "/proc/none/x.clf")
    return int(code != 1), message


def killed_render(b):
    """Killed, then resumed: the same bytes as never interrupted."""
    (b.folder / "scene.yaml").write_text(SCENE.replace("width: 64, height: 48", "width: 120, height: 90"))
    render = ("render", "scene.yaml", "--spp", "600", "-o")
    code, message = b.run(*render, "whole.exr", program="spectral_ref")
    if code != 0:
        return code, message
    process = subprocess.Popen([b.bin_folder / "spectral_ref", *render, "cut.exr", "--checkpoint", "0"], cwd=b.folder,
                               stderr=subprocess.DEVNULL)
    checkpoint = b.folder / "cut.exr.checkpoint"
    while not checkpoint.exists() and process.poll() is None:
        time.sleep(0.01)
    process.kill()
    process.wait()
    killed = not (b.folder / "cut.exr").exists()
    code, message = b.run(*render, "cut.exr", "--resume", program="spectral_ref")
    if code != 0:
        return code, message
    same = (b.folder / "cut.exr").read_bytes() == (b.folder / "whole.exr").read_bytes()
    return int(not (killed and same)), f"killed before its end: {killed}; resumed: bytes equal: {same}"
