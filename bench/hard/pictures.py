# SPDX-License-Identifier: Apache-2.0
"""Pictures of shapes that are easily got wrong: through lutgen, the kernel and the OFX plug-in."""

import ctypes

import imageio.v3 as imageio
import numpy as np
import OpenEXR

from door import Engine, Map

HEIGHT, WIDTH = 6, 7


def odd_sizes(b):
    recipe = b.recipe("D65", "A")
    outcomes, failed = [], 0
    for name, shape in (("1x1", (1, 1)), ("8640 wide", (3, 8640)), ("1 wide", (2000, 1))):
        imageio.imwrite(b.folder / "in.tif", np.full((*shape, 3), 0.2, np.float32))
        code, message = b.run("apply", recipe, "in.tif", "out.exr")
        if code == 0:
            pixels = OpenEXR.File(str(b.folder / "out.exr")).channels()["RGB"].pixels
            code = int(pixels.shape[:2] != shape or (pixels != pixels[0, 0]).any())
        failed |= code
        outcomes.append(f"{name}: {'done, every pixel alike' if code == 0 else message or 'wrong'}")
    return failed, "; ".join(outcomes)


def moved_origin(b):
    """A data window that begins elsewhere, in a display window that is larger."""
    pixels = np.random.default_rng(3).random((HEIGHT, WIDTH, 3)).astype(np.float32)
    window = (np.array([10, -3], np.int32), np.array([10 + WIDTH - 1, -3 + HEIGHT - 1], np.int32))
    results = []
    for name, header in (("here", {}), ("moved", {"dataWindow": window})):
        OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, **header},
                     {"RGB": pixels}).write(str(b.folder / f"{name}.exr"))
        code, message = b.run("apply", b.recipe("D65", "A"), f"{name}.exr", "out.exr")
        if code != 0:
            return code, message
        file = OpenEXR.File(str(b.folder / "out.exr"))
        results.append((file.channels()["RGB"].pixels.copy(), file.header()["dataWindow"]))
    same = bool((results[0][0] == results[1][0]).all())
    kept = bool((np.array(results[1][1]) == np.array(window)).all())
    return int(not (same and kept)), f"pixels as at the usual origin: {same}; window kept: {kept}"


def nothing_and_itself(b):
    """The kernel on no pixel, and on a picture that is its own result."""
    table = Map(Engine(b.door, "D65", "HP1", 251), 0.09)
    source = np.random.default_rng(4).random((1001, 4)).astype(np.float32)
    output = np.empty_like(source)
    table.run(source, output)
    nothing = np.empty((0, 4), np.float32)
    table.run(nothing, nothing)
    in_place = source.copy()
    table.run(in_place, in_place)
    same = bool((in_place == output).all())
    return int(not same), f"no pixel: done; in place: same bits: {same}"


class _Effect:
    """Spectral Transfer in a bare host, with pictures of any shape in memory."""

    def __init__(self, library):
        self.library = ctypes.CDLL(str(library))
        self.library.ofxOpen.restype = ctypes.c_void_p
        self.handle = ctypes.c_void_p(self.library.ofxOpen(2))
        self.library.ofxSetText(self.handle, b"outputIlluminant", b"HP1")

    def __del__(self):
        self.library.ofxClose(self.handle)

    def render(self, source, destination, origin=(0, 0)):
        """Rows as the arrays stride; the host's status."""
        height, width = source.shape[:2]
        self.library.ofxConnectStrided(
            self.handle, ctypes.c_void_p(source.ctypes.data), source.strides[0], ctypes.c_void_p(destination.ctypes.data),
            destination.strides[0], *origin, origin[0] + width, origin[1] + height)
        return self.library.ofxRender(self.handle, ctypes.c_double(0))


def memory_shapes(b):
    """The plug-in on rows upside down, padded, moved, overlapping, and on nothing."""
    library = b.bin_folder.parent / "lib" / "libmetamer_ofx_bench_door.so"
    if not library.exists():
        return 1, "the OFX plug-in is not built"
    effect = _Effect(library)
    source = np.random.default_rng(5).random((HEIGHT, WIDTH, 4)).astype(np.float32)
    expected = np.empty_like(source)
    failed = effect.render(source, expected)
    padded = np.zeros((HEIGHT, WIDTH + 3, 4), np.float32)
    padded[:, :WIDTH] = source
    shapes = {
        "negative stride": (np.ascontiguousarray(source[::-1])[::-1], np.empty_like(source)[::-1], (0, 0)),
        "padded rows": (padded[:, :WIDTH], np.empty_like(padded)[:, :WIDTH], (0, 0)),
        "moved origin": (source.copy(), np.empty_like(source), (-5, 1000)),
    }
    memory = np.empty((HEIGHT + 1, WIDTH, 4), np.float32)
    memory[1:] = source
    shapes["overlapping by all but a row"] = (memory[1:], memory[:-1], (0, 0))
    outcomes = {}
    for name, (before, after, origin) in shapes.items():
        status = effect.render(before, after, origin)
        outcomes[name] = status == 0 and bool((after == expected).all())
    outcomes["empty"] = effect.render(source[:0], np.empty_like(source)[:0]) == 0
    good = failed == 0 and all(outcomes.values())
    return int(not good), "same bits as a plain picture: " + ", ".join(f"{k}: {v}" for k, v in outcomes.items())
