# SPDX-License-Identifier: Apache-2.0
"""Pictures in and out: public photographs, scene-linear ACEScg EXR, and the one view through which the demo shows them."""

from __future__ import annotations

import json
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import OpenEXR
import PyOpenColorIO as ocio
from PIL import Image

# CIE 1931 xy of primaries and white. sRGB: IEC 61966-2-1. ACEScg: S-2014-004 (AP1, ACES white).
SRGB = ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06)), (0.3127, 0.3290)
ACESCG = ((0.713, 0.293), (0.165, 0.830), (0.128, 0.044)), (0.32168, 0.33767)
# From ACEScg to an sRGB screen as film would show it, as lutgen report has it: highlights roll off and lose their colour, in place of
# clipping. A photograph's white, undone by the view, is as bright as the code `brightest`, some 20; the whole of it would be 128.
FILM_VIEW = json.loads((Path(__file__).resolve().parent.parent / "lutgen/pictures/report/page/film_view.json").read_text(encoding="utf-8"))
VIEW = ("ACEScg_to_ACES2065-1", FILM_VIEW["styles"][0]["style"], FILM_VIEW["screen"])
VIEW_NAME = f"{FILM_VIEW['styles'][0]['name']}, SDR, 100 nits, Rec.709"
BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])


def xyz_of(xy: tuple[float, float]) -> np.ndarray:
    """Tristimulus with Y = 1 of a chromaticity."""
    x, y = xy
    return np.array([x / y, 1.0, (1 - x - y) / y])


def xyz_from_rgb(space: tuple) -> np.ndarray:
    """3x3 from linear RGB to XYZ; RGB (1, 1, 1) is the white at Y = 1."""
    primaries, white = space
    columns = np.stack([xyz_of(xy) for xy in primaries], axis=1)
    return columns * np.linalg.solve(columns, xyz_of(white))


def acescg_from_srgb() -> np.ndarray:
    """3x3 from linear sRGB to ACEScg, white to white (Bradford)."""
    gain = (BRADFORD @ xyz_of(ACESCG[1])) / (BRADFORD @ xyz_of(SRGB[1]))
    adapt = np.linalg.solve(BRADFORD, gain[:, None] * BRADFORD)
    return np.linalg.solve(xyz_from_rgb(ACESCG), adapt @ xyz_from_rgb(SRGB))


def opened(file: Path | str) -> np.ndarray:
    """An 8-bit sRGB picture as scene-linear ACEScg, height x width x 3, float32: its curve is undone, its white becomes
    ACEScg (1, 1, 1)."""
    with Image.open(file) as picture:
        encoded = np.asarray(picture.convert("RGB"), dtype=np.float64) / 255
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    return (linear @ acescg_from_srgb().T).astype(np.float32)


def scikit_image(name: str) -> Path:
    """A photograph of scikit-image's own data folder."""
    package = find_spec("skimage")
    if package is None or package.origin is None:
        raise FileNotFoundError("scikit-image is not installed: run script/bootstrap")
    return Path(package.origin).parent / "data" / name


def photograph(name: str) -> np.ndarray:
    """One of scikit-image's photographs, as opened() gives it."""
    return opened(scikit_image(name))


def scene(file: Path | str) -> np.ndarray:
    """The light that the view shows as this 8-bit sRGB picture, ACEScg: so what is not relit looks as it did."""
    with Image.open(file) as picture:
        codes = np.asarray(picture.convert("RGB"), dtype=np.float32) / 255
    return _through(np.minimum(codes, FILM_VIEW["brightest"]), ocio.TRANSFORM_DIR_INVERSE)


def view(acescg: np.ndarray) -> np.ndarray:
    """What a screen shows of scene-linear ACEScg: 8-bit sRGB, by VIEW."""
    return np.round(np.clip(_through(acescg, ocio.TRANSFORM_DIR_FORWARD), 0, 1) * 255).astype(np.uint8)


def swatch(acescg: np.ndarray) -> np.ndarray:
    """A colour as such, without a view: matrix, clip to 0...1, sRGB's curve, 8 bits."""
    linear = np.clip(acescg.astype(np.float64) @ np.linalg.inv(acescg_from_srgb()).T, 0, 1)
    encoded = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.round(encoded * 255).astype(np.uint8)


def _through(pixels: np.ndarray, direction: ocio.TransformDirection) -> np.ndarray:
    """VIEW, or its inverse, on height x width x 3."""
    steps = [ocio.BuiltinTransform(style=style, direction=direction) for style in VIEW]
    group = ocio.GroupTransform(steps if direction == ocio.TRANSFORM_DIR_FORWARD else steps[::-1])
    result = np.ascontiguousarray(pixels, dtype=np.float32).copy()
    ocio.Config.CreateRaw().getProcessor(group).getDefaultCPUProcessor().applyRGB(result)
    return result


def write_exr(path: Path, pixels: np.ndarray) -> None:
    """Float RGB EXR with ACEScg's chromaticities in its header."""
    primaries, white = ACESCG
    header = {
        "compression": OpenEXR.ZIP_COMPRESSION,
        "type": OpenEXR.scanlineimage,
        "chromaticities": tuple(float(value) for xy in (*primaries, white) for value in xy),
    }
    OpenEXR.File(header, {"RGB": np.ascontiguousarray(pixels, dtype=np.float32)}).write(str(path))


def read_exr(path: Path) -> np.ndarray:
    """The R, G, B channels of an EXR, height x width x 3."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = file.channels()
        return np.stack([np.asarray(channels[name].pixels, dtype=np.float32) for name in "RGB"], axis=-1)
