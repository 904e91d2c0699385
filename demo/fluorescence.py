# SPDX-License-Identifier: Apache-2.0
"""docs/images/fluorescence.jpg: day-glo paint beside a reflectance that looks the same in daylight, under five lights.

    build/venv/bin/python demo/fluorescence.py PREFIX OUT.jpg    (PREFIX: where metamer is installed)

The paint is demo/files/dayglo.csv, made of formulae. Each panel is adapted to its light's white, but for the last: of
black light (365 nm) nothing is seen but what the paint makes of it. All are seen through the film-like view of pictures.py.
"""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import OpenEXR

from contact_sheet import sheet
from pictures import BRADFORD, acescg_from_srgb, view

ROOT = Path(__file__).resolve().parent.parent
WIDTH, HEIGHT, SAMPLES = 216, 144, 384
BLACK_LIGHT = "black light, 365 nm"
LIGHTS = {"daylight, D65": "{illuminant: D65}", "light bulb, A": "{illuminant: A}", "fluorescent, FL11": "{illuminant: FL11}",
          "sodium, HP1": "{illuminant: HP1}", BLACK_LIGHT: "{wavelengths: [355, 365, 375], values: [0, 700, 0]}"}
SRGB = np.array([[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]])
D65 = np.array([0.95047, 1.0, 1.08883])


def daylight_match():
    """What a spectrophotometer reads of the paint under D65, cut at 1."""
    matrix = np.loadtxt(ROOT / "demo/files/dayglo.csv", delimiter=",", skiprows=1)
    with open(ROOT / "data/illuminants/cie_standard.csv", encoding="utf-8") as stream:
        rows = list(csv.reader(stream))
    column = rows[0].index("D65")
    light = np.interp(matrix[:, 0], [float(row[0]) for row in rows[1:]], [float(row[column]) for row in rows[1:]])
    return matrix[:, 0], np.minimum((matrix[:, 1:] @ light) / light, 1.0)


def scene(light, nm, match):
    return f"""metamer_scene: 1
film: {{width: {WIDTH}, height: {HEIGHT}, space: XYZ}}
camera: {{origin: [0, 1.3, 6], target: [0, 0.55, 0], up: [0, 1, 0], fov_x: 34}}
spectra:
  lamp: {light[:-1]}, scale: 0.2}}
  sky: {light[:-1]}, scale: 0.004}}
  match: {{wavelengths: {[float(one) for one in nm]}, values: {[round(float(one), 5) for one in match]}}}
shapes:
  - sphere: {{center: [-0.85, 0.75, 0], radius: 0.75}}
    fluorescent: {{file: {ROOT}/demo/files/dayglo.csv}}
  - sphere: {{center: [0.85, 0.75, 0], radius: 0.75}}
    diffuse: match
  - rectangle: {{center: [0, 0, 0], half_u: [0, 0, 6], half_v: [6, 0, 0]}}
    diffuse: 0.45
  - rectangle: {{center: [-3, 5, 4], half_u: [0.8, 0, 0], half_v: [0, 0, 0.8]}}
    emission: lamp
lights: [{{environment: {{emission: sky}}}}]
"""


def rendered(folder, prefix, light, nm, match):
    (folder / "scene.yaml").write_text(scene(light, nm, match), encoding="utf-8")
    subprocess.run([prefix / "bin/spectral_ref", "render", folder / "scene.yaml", "-o", folder / "scene.exr", "--spp",
                    str(SAMPLES), "--guiding", "on"], check=True, stdout=subprocess.DEVNULL)
    channels = OpenEXR.File(str(folder / "scene.exr"), separate_channels=True).channels()
    return np.stack([channels[name].pixels for name in "RGB"], axis=-1).astype(float)


def main():
    prefix, out = Path(sys.argv[1]), Path(sys.argv[2])
    nm, match = daylight_match()
    panels = []
    with tempfile.TemporaryDirectory() as folder:
        for name, light in LIGHTS.items():
            xyz = rendered(Path(folder), prefix, light, nm, match)
            floor = xyz[-12:].mean(axis=(0, 1))
            if name != BLACK_LIGHT:
                gain = (BRADFORD @ D65) / (BRADFORD @ (floor / floor[1]))
                xyz = xyz @ (np.linalg.inv(BRADFORD) @ np.diag(gain) @ BRADFORD).T * (0.55 / floor[1])
            else:
                xyz = xyz * (0.9 / np.percentile(xyz[..., 1], 99))
            panels.append((name, view(xyz @ SRGB.T @ acescg_from_srgb().T)))
            print(name, "floor", floor)
    sheet([panels], WIDTH).save(out, quality=93, subsampling=0)


if __name__ == "__main__":
    main()
