# SPDX-License-Identifier: Apache-2.0
"""A still through the OFX plug-in, in the test host on OpenFX's HostSupport: a picture in, a picture out.

    METAMER_BIN=build/release/bin build/venv/bin/python demo/ofx_still.py IN.png OUT.png --set outputIlluminant=HP1

IN is any 8-bit sRGB picture that Pillow reads, or the name of one of scikit-image's photographs (astronaut.png). Linear ACEScg
goes to the plug-in: the light that the demo's view shows as that picture; its result comes through the view again. What the effect says goes to stderr.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

import pictures

TRANSFER = "org.metamer.SpectralTransfer"


def rendered(rgb, settings, plugin=TRANSFER, bundles=None, options=()):
    """Linear RGB through an effect; `settings` by parameter. @raise subprocess.CalledProcessError"""
    programs = Path(os.environ["METAMER_BIN"])
    height, width = rgb.shape[:2]
    with tempfile.TemporaryDirectory() as folder:
        source, result = Path(folder) / "in", Path(folder) / "out"
        np.ascontiguousarray(np.dstack([rgb, np.ones((height, width), np.float32)])[::-1]).tofile(source)
        words = [programs / "metamer_ofx_render", bundles or programs.parent / "OFX", plugin, width, height, source,
                 result, "--threads", 2, *options]
        for name, value in settings.items():
            words += ["--set", f"{name}={value}"]
        subprocess.run([str(word) for word in words], check=True)
        return np.fromfile(result, np.float32).reshape(height, width, 4)[::-1, :, :3]


def main():
    parser = argparse.ArgumentParser(description="A still through the OFX plug-in.")
    parser.add_argument("input")
    parser.add_argument("output")
    parser.add_argument("--bundles", help="folder that holds metamer.ofx.bundle; the build's by default")
    parser.add_argument("--plugin", default=TRANSFER)
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="a parameter (docs/ofx.md)")
    parser.add_argument("--save", help="file to keep the parameters in")
    parser.add_argument("--load", help="file that --save wrote")
    given = parser.parse_args()
    options = [word for key in ("save", "load") if getattr(given, key) for word in (f"--{key}", getattr(given, key))]
    source = pictures.scene(given.input if Path(given.input).exists() else pictures.scikit_image(given.input))
    try:
        settings = dict(setting.split("=", 1) for setting in given.set)
    except ValueError:
        parser.error("--set takes NAME=VALUE")
    try:
        result = rendered(source, settings, given.plugin, given.bundles, options)
    except subprocess.CalledProcessError as error:
        return error.returncode
    Image.fromarray(pictures.view(result)).save(given.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
