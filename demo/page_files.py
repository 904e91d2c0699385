# SPDX-License-Identifier: Apache-2.0
"""The files that the lines of README.md and docs/ name, demo/files: small pictures, a wall's captures, a chart under its LEDs, a
fluorescent paint.

    build/venv/bin/python demo/page_files.py [FOLDER]    (demo/files by default)

Recipes, scenes and configs in demo/files are written by hand.
"""

import csv
import sys
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image

from pictures import opened

ROOT = Path(__file__).resolve().parent.parent
WAVELENGTHS = np.arange(380.0, 781.0)
LEDS = {"red": (628, 14), "green": (525, 24), "blue": (460, 16)}
# A small patch's view of a 1 m x 1 m square 1 m before it, of all it sees: the square's form factor.
FORM_FACTOR = 0.2394


def table(file, hold=False):
    """Columns of a measured table by name, at WAVELENGTHS."""
    with open(ROOT / "data" / file, encoding="utf-8", newline="") as stream:
        rows = list(csv.reader(stream))
    numbers = np.array([[float(cell or 0) for cell in row] for row in rows[1:]])
    ends = {} if hold else {"left": 0, "right": 0}
    return {name: np.interp(WAVELENGTHS, numbers[:, 0], numbers[:, k], **ends) for k, name in enumerate(rows[0]) if k}


def led(peak, width):
    """Ohno (2005)."""
    bell = np.exp(-(((WAVELENGTHS - peak) / width) ** 2))
    return (bell + 2 * bell**5) / 3


def dye_band(nm, peak, width, skew):
    """Asymmetric band of a dye, 1 at its peak: Siano and Metzler (1969), log-normal."""
    place = 1 + (nm - peak) * (skew * skew - 1) / (width * skew)
    return np.exp(-np.log(2) * (np.log(np.maximum(place, 1e-12)) / np.log(skew)) ** 2)


def fluorescent_paint(folder):
    """Re-radiation of an orange day-glo paint, MADE of two dyes' formulae and not measured: factors by bands of 10 nm."""
    nm = np.arange(300.0, 781.0, 10.0)
    ground = 0.88 - 0.6 * np.exp(-np.maximum(nm - 340, 0) / 25)
    factors = np.diag(ground)
    for share, excitation, emission, quantum_yield in ((0.82, (500, 110, 0.7), (603, 48, 1.5), 0.85),
                                                       (0.12, (440, 70, 0.8), (512, 40, 1.6), 0.7)):
        taken = ground * share * dye_band(nm, *excitation)
        photons = dye_band(nm, *emission)
        energy = np.outer(photons / photons.sum() / nm, quantum_yield * taken * nm)
        factors += np.tril(energy, -1) - np.diag(taken)
    write_csv(folder / "dayglo.csv", ["emission_nm/excitation_nm", *(f"{one:g}" for one in nm)],
              [[to, *row] for to, row in zip(nm, np.where(factors > 1e-7, factors, 0))])


def write_csv(file, header, rows):
    with open(file, "w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(header)
        for row in rows:
            writer.writerow([cell if isinstance(cell, str) else f"{cell:.6g}" for cell in row])


def captures(folder):
    """What a Canon EOS 5D Mark II sees of a chart under a wall's LEDs, one at a time, and under daylight; ramps; the LEDs."""
    camera = np.stack(list(table("observers/canon_eos_5d_mark_ii.csv").values())[:3], axis=1)
    chart = table("reflectances/colorchecker.csv", hold=True)
    white = table("illuminants/cie_standard.csv")["D65"]
    unit = sum((led(*one) for one in LEDS.values())) @ camera[:, 1]
    target = white / (white @ camera[:, 1])
    for name, one in LEDS.items():
        light = led(*one) / unit
        write_csv(folder / f"{name}_chart.csv", ["patch", "R", "G", "B"],
                  [[patch, *(FORM_FACTOR * (values * light) @ camera)] for patch, values in chart.items()])
        drives = np.linspace(0, 1, 9)
        write_csv(folder / f"{name}_ramp.csv", ["patch", "R", "G", "B"],
                  [[f"{drive:g}", *(drive**2.2 * light @ camera)] for drive in drives])
        write_csv(folder / f"{name}.csv", ["wavelength_nm", name], zip(WAVELENGTHS[::2], led(*one)[::2]))
        print(name, "primary:", (light @ camera).round(5).tolist())
    lamp = table("illuminants/cie_standard.csv")["A"]
    for name, light in (("place", target), ("left", lamp / (lamp @ camera[:, 1]))):
        write_csv(folder / f"{name}_chart.csv", ["patch", "R", "G", "B"],
                  [[patch, *((values * light) @ camera)] for patch, values in chart.items()])
    write_csv(folder / "white.csv", ["wavelength_nm", "white"],
              zip(WAVELENGTHS[::2], (0.5 * led(450, 20) + np.exp(-(((WAVELENGTHS - 570) / 70) ** 2)))[::2]))
    write_csv(folder / "gel.csv", ["wavelength_nm", "transmittance"],
              [[wavelength, float(np.clip((wavelength - 420) / 300, 0.05, 0.9))] for wavelength in WAVELENGTHS[::20]])
    write_csv(folder / "sand.csv", ["wavelength_nm", "sand"],
              [[wavelength, float(0.1 + 0.3 * (wavelength - 380) / 400)] for wavelength in WAVELENGTHS[::20]])
    print("white:", (target @ camera).round(5).tolist())


def write_exr(file, channels, half=True):
    kind = np.float16 if half else np.float32
    channels = {name: np.ascontiguousarray(values, kind) for name, values in channels.items()}
    OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, channels).write(str(file))


def pictures(folder):
    """From docs/images/demo.jpg's photograph in daylight: a shot, frames, passes, a still; a sky with a
    lamp in it; a face with a matte."""
    width, height = 60, 40
    with Image.open(ROOT / "docs/images/demo.jpg") as sheet:
        size = sheet.height // 2
        small = sheet.crop((0, 0, size, size)).resize((width, height), Image.Resampling.BOX)
    small.save(folder / "still.png")
    light = opened(folder / "still.png")
    write_exr(folder / "shot.exr", {"RGB": light})
    for frame in (1001, 1002, 1003):
        write_exr(folder / f"shot.{frame}.exr", {"RGB": light * (frame - 1000) / 2})
    write_exr(folder / "render_a.exr", {"RGB": light})
    write_exr(folder / "render_b.exr", {"RGB": light * np.array([1.02, 1, 0.99])})
    passes = {"diffuse": 0.7, "specular": 0.3}
    layers = {f"{name}.{c}": share * light[..., k] for name, share in passes.items() for k, c in enumerate("RGB")}
    layers |= {f"beauty.{c}": light[..., k] for k, c in enumerate(("red", "green", "blue"))}
    write_exr(folder / "render.exr", layers)
    x, y = np.meshgrid(np.linspace(0, 1, width), np.linspace(0, 1, height))
    tone = 0.25 + 0.5 * x
    write_exr(folder / "face.exr", {"RGB": tone[..., None] * np.array([0.75, 0.55, 0.42])}, half=False)
    sky = np.array([0.4, 1.0, 0.73]) * np.linspace(1.5, 0.2, 16)[:, None, None] * np.ones((1, 32, 1))
    sky[6:9, 24:27] = [20.0, 14.0, 4.0]
    write_exr(folder / "place.exr", {"RGB": sky})
    write_exr(folder / "cheeks.exr", {"Y": np.exp(-20 * ((x - 0.5) ** 2 + (y - 0.5) ** 2))})


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "demo/files")
    folder.mkdir(parents=True, exist_ok=True)
    captures(folder)
    fluorescent_paint(folder)
    pictures(folder)


if __name__ == "__main__":
    main()
