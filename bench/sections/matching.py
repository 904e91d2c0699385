# SPDX-License-Identifier: Apache-2.0
"""The experiment of section 5.4: shots under four lights matched to 5600 K, by every kind of reference scene.

Error on spectra that the data set was not given (the natural scene and the skins hold them); folds and gain tell how robust the transform is for all the other colours.
"""

import csv
import os
from pathlib import Path

import numpy as np

from door import Engine

TARGET = "daylight 5600 K"
LIGHTS = ("2800 K", "daylight 10000 K", "LED-B3", "LED-RGB1")
SET = "colorchecker"  # what the dataset is given
HELD_OUT = "tm30"
SCENES = (("smooth", ""), ("natural", ""), ("skin", ""), ("dataset", SET))


def held_out():
    """Wavelengths and reflectances on the engine's domain."""
    file = Path(os.environ["METAMER_DATA"]) / "reflectances" / f"{HELD_OUT}.csv"
    with file.open(encoding="utf-8") as text:
        rows = [row for row in csv.reader(line for line in text if not line.startswith("#"))][1:]
    table = np.array(rows, float)
    domain = np.arange(380, 781)
    return np.array([np.interp(domain, table[:, 0], column) for column in table[:, 1:].T])


def run(context):
    door, rows = context.door, []
    handle = door.open("D65", "A")  # for probes and CIEDE2000 in ACEScg
    probes = door.probes(handle)
    probes = probes[probes.min(axis=1) >= 0]
    spectra = held_out()
    for light in LIGHTS:
        engine = Engine(door, light, TARGET, 251)
        given, wanted = engine.known(spectra)
        for name, surfaces in SCENES:
            engine = Engine(door, light, TARGET, 251, name, surfaces)
            result, _ = engine.apply(given)
            errors = door.delta_e(handle, wanted, result)
            rows.append({"light": light, "scene": name, "mean": float(errors.mean()),
                         "p95": float(np.quantile(errors, 0.95)), "folds": engine.folds(probes),
                         "gain": engine.largest_gain(probes)})
    door.close(handle)
    return rows


def markdown(results):
    lines = [f"Shots under four lights to {TARGET}. The data set has the 24 patches of {SET}; CIEDE2000 is over the 99 spectra of "
             f"{HELD_OUT}, which natural and skin know, seen by CIE 1931. Folds: share of the protocol's colours inside ACEScg where the map of "
             "chromaticities turns over. Gain: largest stretching of a small difference, over that of the linear branch.", "",
             "| light | scene | mean | p95 | folds | gain |", "| --- | --- | --- | --- | --- | --- |"]
    return lines + [f"| {r['light']} | {r['scene']} | {r['mean']:.2f} | {r['p95']:.2f} | {r['folds']:.1%} | {r['gain']:.1f} |"
                    for r in results]
