# SPDX-License-Identifier: Apache-2.0
"""Scenes of pairs: error at the pairs, and what 24 of them do for colours that they are not."""

import csv
import os
from pathlib import Path

import numpy as np

from door import RecipeEngine

LIGHTS = {"A": "cie_standard", "FL11": "cie_fl", "HP1": "cie_hp", "LED-RGB1": "cie_led"}  # and their tables
SCENES = {
    "smooth": "{kind: smooth}",
    "dataset": "{kind: dataset, set: colorchecker}",
    "pairs over smooth": "{kind: pairs, set: colorchecker, over: smooth}",
    "natural": "{kind: natural}",
    "pairs over natural": "{kind: pairs, set: colorchecker}",
}
PAIRS, HELD_OUT = "colorchecker", "tm30"


XYZ_FROM_RGB = np.array([[0.6624541811, 0.1340042065, 0.1561876870], [0.2722287168, 0.6740817658, 0.0536895174],
                         [-0.0055746495, 0.0040607335, 1.0103391003]])  # ACEScg
CONES_FROM_XYZ = np.array([[0.40024, 0.70760, -0.08081], [-0.22630, 1.16532, 0.04570], [0.0, 0.0, 0.91822]])  # vonkries


def table(kind, name):
    """A table on the engine's domain: {column: values}."""
    file = Path(os.environ["METAMER_DATA"]) / kind / f"{name}.csv"
    with file.open(encoding="utf-8") as text:
        names, *rows = [row for row in csv.reader(line for line in text if not line.startswith("#"))]
    values = np.array([[float(cell) if cell else 0.0 for cell in row] for row in rows])
    return {column: np.interp(np.arange(380, 781), values[:, 0], values[:, k]) for k, column in enumerate(names) if k > 0}


def beside_own_white(rgb, light):
    """The colours of a result whose neutrals were kept as they lie beside the lamp's own white, which is what the eye
    under it has: RGB whose CIELAB in ACEScg is that."""
    white = XYZ_FROM_RGB @ np.ones(3)
    lamp = np.array([curve @ table("illuminants", LIGHTS[light])[light] for curve in table("observers", "cie_1931_2").values()])
    lamp /= lamp[1]
    gain = np.diag((CONES_FROM_XYZ @ lamp) / (CONES_FROM_XYZ @ white))
    under = np.diag(white / lamp) @ np.linalg.inv(CONES_FROM_XYZ) @ gain @ CONES_FROM_XYZ @ XYZ_FROM_RGB
    return rgb @ (np.linalg.inv(XYZ_FROM_RGB) @ under).T


def run(context):
    door, rows = context.door, []
    handle = door.open("D65", "A")  # for CIEDE2000 in ACEScg
    for light in LIGHTS:
        for scene, text in SCENES.items():
            engine = RecipeEngine(door, "metamer: 1\ninput: {illuminant: D65}\n"
                                        f"output: {{illuminant: {light}, adaptation: 1}}\nscene: {text}\n", 401)
            engine.lights = (b"D65", light.encode())
            row = {"light": light, "scene": scene}
            for name, of in (("pairs", PAIRS), ("held_out", HELD_OUT)):
                given, wanted = engine.known(list(table("reflectances", of).values()))
                errors = door.delta_e(handle, beside_own_white(wanted, light), beside_own_white(engine.apply(given)[0], light))
                row[name] = {"mean": float(errors.mean()), "max": float(errors.max())}
            rows.append(row)
    door.close(handle)
    return rows


def markdown(results):
    lines = [f"D65 to four lights, CIEDE2000 beside each light's own white; the pairs are the 24 patches of {PAIRS}. The 99 colours of "
             f"{HELD_OUT} are none of them, but natural knows them. ([How pairs work](pairs.md).)", "",
             "| light | scene | at the pairs, largest | held out, mean | held out, largest |", "| --- | --- | --- | --- | --- |"]
    return lines + [f"| {r['light']} | {r['scene']} | {r['pairs']['max']:.2g} | {r['held_out']['mean']:.2f} | {r['held_out']['max']:.1f} |"
                    for r in results]
