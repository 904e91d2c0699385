# SPDX-License-Identifier: Apache-2.0
"""Scenes of pairs: error at the pairs, and what 24 of them do for colours that they are not."""

import csv
import os
from pathlib import Path

import numpy as np

from door import RecipeEngine

LIGHTS = ("A", "FL11", "HP1", "LED-RGB1")
SCENES = {
    "smooth": "{kind: smooth}",
    "dataset": "{kind: dataset, set: colorchecker}",
    "pairs over smooth": "{kind: pairs, set: colorchecker, over: smooth}",
    "natural": "{kind: natural}",
    "pairs over natural": "{kind: pairs, set: colorchecker}",
}
PAIRS, HELD_OUT = "colorchecker", "tm30"


def reflectances(name):
    """A set on the engine's domain, a row a sample."""
    file = Path(os.environ["METAMER_DATA"]) / "reflectances" / f"{name}.csv"
    with file.open(encoding="utf-8") as text:
        rows = [row for row in csv.reader(line for line in text if not line.startswith("#"))][1:]
    table = np.array(rows, float)
    return np.array([np.interp(np.arange(380, 781), table[:, 0], column) for column in table[:, 1:].T])


def run(context):
    door, rows = context.door, []
    handle = door.open("D65", "A")  # for CIEDE2000 in ACEScg
    for light in LIGHTS:
        for scene, text in SCENES.items():
            engine = RecipeEngine(door, "metamer: 1\ninput: {illuminant: D65}\n"
                                        f"output: {{illuminant: {light}, adaptation: 1}}\nscene: {text}\n", 401)
            engine.lights = (b"D65", light.encode())
            row = {"light": light, "scene": scene}
            for name, spectra in (("pairs", reflectances(PAIRS)), ("held_out", reflectances(HELD_OUT))):
                given, wanted = engine.known(spectra)
                errors = door.delta_e(handle, wanted, engine.apply(given)[0])
                row[name] = {"mean": float(errors.mean()), "max": float(errors.max())}
            rows.append(row)
    door.close(handle)
    return rows


def markdown(results):
    lines = [f"D65 to four lights, neutrals kept, CIEDE2000 beside the working white; the pairs are the 24 patches of {PAIRS}. The 99 colours of "
             f"{HELD_OUT} are none of them, but natural knows them. ([How pairs work](pairs.md).)", "",
             "| light | scene | at the pairs, largest | held out, mean | held out, largest |", "| --- | --- | --- | --- | --- |"]
    return lines + [f"| {r['light']} | {r['scene']} | {r['pairs']['max']:.2g} | {r['held_out']['mean']:.2f} | {r['held_out']['max']:.1f} |"
                    for r in results]
