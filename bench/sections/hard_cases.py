# SPDX-License-Identifier: Apache-2.0
"""Cases that break colour tools, each run through the programs, with what came out."""

import json
import subprocess
import tempfile
from pathlib import Path

import imageio.v3 as imageio
import numpy as np
import PyOpenColorIO as ocio

import peers
from door import Engine, Map

RECIPE = "metamer: 1\nname: hard\nspace: ACEScg\ninput: {{illuminant: {}{}}}\noutput: {{illuminant: {}{}}}\n"


class Bench:
    """A folder, and lutgen in it."""

    def __init__(self, context, folder):
        self.door, self.lutgen, self.folder = context.door, context.bin_folder / "lutgen", Path(folder)

    def run(self, *arguments):
        done = subprocess.run([self.lutgen, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              check=False)
        return done.returncode, done.stderr.strip()

    def spectrum(self, name, rows, quantity="power"):
        (self.folder / name).write_text(f"wavelength_nm,{quantity}\n" + "".join(f"{w},{v}\n" for w, v in rows))
        return name

    def bake(self, light_in, light_out, filter_in="", filter_out=""):
        def filters(name):
            return f", filters: [{{file: {name}}}]" if name else ""

        recipe = self.folder / "hard.yaml"
        recipe.write_text(RECIPE.format(light_in, filters(filter_in), light_out, filters(filter_out)))
        code, message = self.run("bake", "hard.yaml", "-o", "hard.clf")
        if code != 0:
            return code, f"refused: {message}"
        error = json.loads((self.folder / "hard.clf.json").read_text())["error"]
        return code, f"baked; p99 {error['p99']:.2f}, max {error['max']:.1f}"


def line(nm):
    return [(380, 0), (nm - 1, 0), (nm, 1), (nm + 1, 0), (780, 0)]


def band(low, high):
    return [(380, 0), (low - 1, 0), (low, 1), (high, 1), (high + 1, 0), (780, 0)]


def laser(b):
    return b.bake(b.spectrum("laser.csv", line(532)), "D65")


def one_led(b):
    rows = [(w, float(np.exp(-0.5 * ((w - 630) / 10) ** 2))) for w in range(380, 781, 2)]
    return b.bake(b.spectrum("led.csv", rows), "D65")


def low_pressure_sodium(b):
    return b.bake("LPS", "D65")


def no_overlap(b):
    return b.bake(b.spectrum("blue.csv", band(400, 450)), b.spectrum("red.csv", band(650, 700)))


def zero_filter(b):
    return b.bake("D65", "D65", filter_in=b.spectrum("zero.csv", [(380, 0), (780, 0)], "transmittance"))


def no_power(b):
    return b.bake(b.spectrum("dark.csv", [(380, 0), (780, 0)]), "D65")


PIXELS = {"black": (0, 0, 0), "negative": (-0.1, 0.2, 0.3), "all negative": (-1, -2, -3), "denormal": (1e-40, 2e-40, 1e-41),
          "largest half": (65504, 65504, 65504), "1e30": (1e30, 2e29, 1e29), "1e-30": (1e-30, 2e-31, 1e-31),
          "beyond the locus": (1, -0.5, -0.5), "NaN": (np.nan, 0.2, 0.3), "infinity": (np.inf, 0.2, 0.3),
          "-infinity": (0.1, -np.inf, 0.3)}


def pixels(b):
    engine = Engine(b.door, "D65", "HP1", 251)
    table = Map(engine, 0.09)
    source = np.ones((3 * len(PIXELS), 4), np.float32)
    source[:, :3] = 0.18
    source[1::3, :3] = list(PIXELS.values())  # ordinary neighbours on both sides
    output = np.empty_like(source)
    table.run(source, output)
    alone = np.full((1, 4), 0.18, np.float32)
    alone[0, 3] = 1
    expected = np.empty_like(alone)
    table.run(alone, expected)
    neighbours = np.delete(output, np.s_[1::3], axis=0)
    untouched = all(np.array_equal(output[3 * i + 1], source[3 * i + 1], equal_nan=True)
                    for i, rgb in enumerate(PIXELS.values()) if not np.isfinite(rgb).all())
    finite = all(np.isfinite(output[3 * i + 1]).all() for i, rgb in enumerate(PIXELS.values()) if np.isfinite(rgb).all())
    same = bool((neighbours == expected).all())
    return int(not (untouched and finite and same)), (
        f"{', '.join(PIXELS)}: finite in, finite out: {finite}; NaN and infinities come back as they are: {untouched}; "
        f"neighbours unchanged: {same}")


def twice_and_back(b):
    code, _ = b.run("bake", "--illuminant-in", "D65", "--illuminant-out", "A", "-o", "look.ctf")
    picture = peers.photograph("coffee")[::8, ::8].copy()
    worst = {}
    for name, directions in (("once and its inverse", (0, 1)), ("twice", (0, 0))):
        group = ocio.GroupTransform()
        for inverse in directions:
            group.appendTransform(ocio.FileTransform(
                str(b.folder / "look.ctf"), interpolation=ocio.INTERP_TETRAHEDRAL,
                direction=ocio.TRANSFORM_DIR_INVERSE if inverse else ocio.TRANSFORM_DIR_FORWARD))
        try:
            output = np.empty_like(picture)
            peers.run_ocio(peers.cpu_processor(group), picture, output)
            worst[name] = (f"largest change {np.abs(output - picture).max():.3f}" if 1 in directions
                           else f"finite: {bool(np.isfinite(output).all())}")
        except ocio.Exception as error:
            worst[name] = f"OCIO refuses: {str(error).splitlines()[0]}"
    return code, "; ".join(f"{k}: {v}" for k, v in worst.items())


def pictures(b):
    (b.folder / "t.yaml").write_text(RECIPE.format("D65", "", "A", ""))
    outcomes, failed = [], 0
    for name, shape in (("1x1", (1, 1)), ("8640 wide", (3, 8640)), ("1 wide", (2000, 1))):
        imageio.imwrite(b.folder / "in.tif", np.full((*shape, 3), 0.2, np.float32))
        code, message = b.run("apply", "t.yaml", "in.tif", "out.exr")
        failed |= code
        outcomes.append(f"{name}: {'done' if code == 0 else message}")
    return failed, "; ".join(outcomes)


def read_only_folder(b):
    code, message = b.run("bake", "--illuminant-in", "D65", "--illuminant-out", "A", "-o", "/proc/none/x.clf")
    return int(code != 1), message


# Name, case, exit code that is right (None: the case itself says 0 where all is well).
CASES = [("input light: a 532 nm laser", laser, 0), ("input light: one LED at 630 nm", one_led, 0),
         ("input light: low-pressure sodium", low_pressure_sodium, 0),
         ("two pipelines with no overlap", no_overlap, 0), ("a filter that is zero everywhere", zero_filter, 1),
         ("a light without power", no_power, 1), ("hard pixels between ordinary ones", pixels, 0),
         ("a look and its inverse, and twice", twice_and_back, 0), ("pictures of odd sizes", pictures, 0),
         ("a folder that cannot be written", read_only_folder, 0)]


def run(context):
    rows = []
    for name, case, expected in CASES:
        with tempfile.TemporaryDirectory() as folder:
            code, outcome = case(Bench(context, folder))
        rows.append({"case": name, "as_it_should": code == expected, "outcome": outcome.replace(str(folder), "…")})
    return rows


def markdown(results):
    lines = ["| case | outcome | as it should be |", "| --- | --- | --- |"]
    return lines + [f"| {r['case']} | {r['outcome'].replace('|', '/')} | {'yes' if r['as_it_should'] else '**no**'} |"
                    for r in results]
