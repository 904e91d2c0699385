# SPDX-License-Identifier: Apache-2.0
"""Stages made from spectra with numpy alone, and their solutions: what lutgen is judged against."""

import csv
import os
from pathlib import Path

import numpy as np

DATA = Path(os.environ.get("METAMER_DATA", Path(__file__).resolve().parents[2] / "data"))
WAVELENGTHS = np.arange(380, 781)


def table(file):
    with open(DATA / file, encoding="utf-8", newline="") as stream:
        rows = list(csv.reader(stream))
    values = np.array([[float(cell) if cell else np.nan for cell in row] for row in rows[1:]])
    return rows[0], values


def spectra(file, hold=False):
    """Name to values on the 1 nm domain; outside a table 0, or its end values."""
    names, values = table(file)
    result = {}
    for column, name in enumerate(names[1:], 1):
        known = ~np.isnan(values[:, column])
        ends = {} if hold else {"left": 0.0, "right": 0.0}
        result[name] = np.interp(WAVELENGTHS, values[known, 0], values[known, column], **ends)
    return result


def led(peak, width):
    """Ohno (2005)."""
    g = np.exp(-(((WAVELENGTHS - peak) / width) ** 2))
    return (g + 2 * g**5) / 3


def phosphor(pump, pump_width, peak, width, share):
    gaussian = np.exp(-4 * np.log(2) * ((WAVELENGTHS - peak) / width) ** 2)
    return share * led(pump, pump_width) + gaussian


def camera(file="observers/canon_eos_5d_mark_ii.csv"):
    """401 x 3."""
    return np.stack(list(spectra(file).values())[:3], axis=1)


def chart():
    """Names, and 24 x 401."""
    samples = spectra("reflectances/colorchecker.csv", hold=True)
    return list(samples), np.stack(list(samples.values()))


LIGHTS = {
    "A": ("illuminants/cie_standard.csv", "A"),
    "D65": ("illuminants/cie_standard.csv", "D65"),
    "FL2": ("illuminants/cie_fl.csv", "FL2"),
    "FL11": ("illuminants/cie_fl.csv", "FL11"),
    "LED-B1": ("illuminants/cie_led.csv", "LED-B1"),
    "HP1": ("illuminants/cie_hp.csv", "HP1"),
    "LED-RGB1": ("illuminants/cie_led.csv", "LED-RGB1"),
}


def light(name):
    file, column = LIGHTS[name]
    return spectra(file)[column]


RGB_LEDS = ["led:628:14", "led:525:24", "led:460:16"]


def model(text):
    kind, *numbers = text.split(":")
    return (led if kind == "led" else phosphor)(*map(float, numbers))


def form_factor(width, height, distance):
    """A small patch before the middle of a parallel rectangle, by the contour integral's closed form."""
    a, b = width / 2 / distance, height / 2 / distance
    quarter = (a / np.hypot(1, a) * np.arctan(b / np.hypot(1, a)) + b / np.hypot(1, b) * np.arctan(a / np.hypot(1, b)))
    return 4 * quarter / (2 * np.pi)


class Stage:
    """A synthetic capture of an RGB wall of model LEDs, as the camera would see it."""

    def __init__(self, target="A", emitters=None, square=(1, 1, 1), black=(0, 0, 0)):
        sensitivities = camera()
        self.names, reflectances = chart()
        self.square = square
        self.black = np.array(black, dtype=float)
        leds = np.stack([model(text) for text in emitters or RGB_LEDS])
        self.primaries = sensitivities.T @ leds.T
        wall = self.primaries[1].sum()
        self.primaries /= wall
        self.factor = form_factor(*square)
        self.charts = [reflectances * one @ sensitivities / wall * self.factor for one in leds]
        power = light(target) if isinstance(target, str) else target
        self.white = sensitivities.T @ power
        self.target = reflectances * power @ sensitivities / self.white[1]
        self.white = self.white / self.white[1]

    def solution(self):
        """The chapter's formulas, by numpy."""
        m = np.linalg.inv(self.primaries)
        drives = np.maximum(m @ self.white, 0)
        predicted = sum(one * drive for one, drive in zip(self.charts, drives)) / self.factor
        q = np.linalg.lstsq(predicted, self.target, rcond=None)[0].T
        return {"M": m, "Q": q, "N": m @ np.linalg.inv(q), "beta": 1 / self.factor, "offset": -m @ self.black,
                "predicted": predicted}

    def write(self, folder, name="stage.yaml", extra="", white=True):
        """The stage file and its four charts."""
        for key, rgb in zip(("r", "g", "b", "t"), [*self.charts, self.target]):
            write_chart(folder / f"{key}.csv", self.names, rgb)
        red, green, blue = (numbers(self.primaries[:, k]) for k in range(3))
        width, height, distance = self.square
        text = f"""metamer_stage: 1
primaries: {{red: {red}, green: {green}, blue: {blue}}}
charts: {{red: r.csv, green: g.csv, blue: b.csv, target: t.csv}}
calibration_square: {{width_m: {width}, height_m: {height}, distance_m: {distance}}}
black_level: {numbers(self.black)}
"""
        if white:
            text += f"environment: {{white: {numbers(self.white)}}}\n"
        (folder / name).write_text(text + extra)
        return folder / name


def numbers(values):
    return "[" + ", ".join(repr(float(value)) for value in values) + "]"


def write_chart(file, names, rgb):
    with open(file, "w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(["patch", "R", "G", "B"])
        for name, row in zip(names, rgb):
            writer.writerow([name, *(repr(float(value)) for value in row)])


def write_spectrum(file, values, name="emitter"):
    with open(file, "w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(["wavelength_nm", name])
        writer.writerows(zip(WAVELENGTHS.tolist(), (repr(float(value)) for value in values)))
