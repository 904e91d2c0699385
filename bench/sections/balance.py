# SPDX-License-Identifier: Apache-2.0
"""Charts shot under a lamp, balanced as cameras and colourists do it, made daylight with each setting of `balanced`.

The pictures are made here from the tables of data/; the truth is the chart in D65 as CIE 1931 sees it; beside every setting
stands the picture that nothing was done to.
"""

import csv
import os
from pathlib import Path

import numpy as np

from door import RecipeEngine

LIGHTS = {"A": "cie_standard", "FL2": "cie_fl", "HP1": "cie_hp", "LED-RGB1": "cie_led"}
CAMERAS = {"Canon EOS 5D Mark II": "canon_eos_5d_mark_ii", "Nikon D5100": "nikon_d5100", "ACES RICD": "aces_ricd",
           "Canon 1D MkIII (fit)": "canon_1d_mkiii_fit", "Canon 5D MkII (fit)": "canon_5d_mkii_fit",
           "Red Mysterium X (fit)": "red_mysterium_x_fit", "Sigma SDMerrill": "sigma_sdmerrill"}
SETS = {"charts": ("colorchecker", "tm30"), "skins": ("model_skins",)}
TRAINING = "rawtoaces_190"  # what the makers of matrices use here
SETTINGS = ("bradford", "cat02", "cat16", "vonkries", "rgb", "camera", "none")
BANDS = 81
BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])
CAT02 = np.array([[0.7328, 0.4296, -0.1624], [-0.7036, 1.6975, 0.0061], [0.0030, 0.0136, 0.9834]])
VON_KRIES = np.array([[0.40024, 0.70760, -0.08081], [-0.22630, 1.16532, 0.04570], [0.0, 0.0, 0.91822]])
ACESCG = ((0.713, 0.293), (0.165, 0.830), (0.128, 0.044)), (0.32168, 0.33767)
REC709 = ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06)), (0.3127, 0.3290)


def table(file, outside=None):
    """{column: values at 380, 381, ... 780 nm}"""
    with (Path(os.environ["METAMER_DATA"]) / file).open(encoding="utf-8") as text:
        header, *rows = [row for row in csv.reader(line for line in text if not line.startswith("#"))]
    result = {}
    for k, name in enumerate(header[1:], 1):
        x, y = np.array([(float(row[0]), float(row[k])) for row in rows if k < len(row) and row[k]]).T
        result[name] = np.interp(np.arange(380, 781), x, y, left=outside, right=outside)
    return result


def reflectances(name):
    return np.array(list(table(f"reflectances/{name}.csv").values()))


def xyz_from_rgb(space):
    primaries, white = space
    columns = np.array([[x, y, 1 - x - y] for x, y in primaries]).T
    white = np.array([white[0] / white[1], 1, (1 - sum(white)) / white[1]])
    return columns * np.linalg.solve(columns, white), white


def gains(space, source, destination):
    """Adaptation by gains in a space whose rows are `space`."""
    return np.linalg.solve(space, ((space @ destination) / (space @ source))[:, None] * space)


class Light:
    """What the eye and cameras get of reflectances under a light; cameras over their white."""

    def __init__(self, name):
        self.power = table(f"illuminants/{LIGHTS.get(name, 'cie_standard')}.csv", 0.0)[name]
        self.eye = np.array(list(table("observers/cie_1931_2.csv", 0.0).values()))
        self.white = self.eye @ self.power / (self.eye[1] @ self.power)

    def xyz(self, spectra):
        return (spectra * self.power) @ self.eye.T / (self.eye[1] @ self.power)

    def camera(self, curves, spectra):
        return (spectra * self.power) @ curves.T / (curves @ self.power)


def fitted(responses, tristimuli, white):
    """Least squares that sends (1, 1, 1) to white."""
    rest = np.linalg.lstsq(responses[:, :2] - responses[:, 2:], tristimuli - np.outer(responses[:, 2], white), rcond=None)[0].T
    return np.column_stack([rest, white - rest.sum(axis=1)])


def pictures(light, daylight, spectra, training):
    """[(workflow, camera or None, XYZ of the working space)]"""
    acescg, white = xyz_from_rgb(ACESCG)
    xyz, found = light.xyz(spectra), []
    for name, file in CAMERAS.items():
        curves = np.array(list(table(f"observers/{file}.csv", 0.0).values()))
        raw = light.camera(curves, spectra)

        def matrix(shot, cat):
            return fitted(shot.camera(curves, training), shot.xyz(training) @ gains(cat, shot.white, white).T, white)

        found.append(("camera, matrix for daylight", name, raw @ matrix(daylight, BRADFORD).T))
        found.append(("camera, matrix for the light", name, raw @ matrix(light, BRADFORD).T))
        found.append(("ACES IDT", name, raw @ matrix(light, CAT02).T))
        # As developed for daylight, then adapted.
        gain = (curves @ light.power) / (curves @ daylight.power)
        develop = fitted(daylight.camera(curves, training), daylight.xyz(training), daylight.white)
        found += [(f"developed, then {cat}", name, (raw * gain) @ (gains(space, develop @ gain, white) @ develop).T)
                  for cat, space in (("CAT02", CAT02), ("Bradford", BRADFORD))]
    rec709 = xyz_from_rgb(REC709)[0]
    for name, space in (("eye, CAT02", CAT02), ("eye, Bradford", BRADFORD), ("eye, von Kries", VON_KRIES),
                        ("grey card, ACEScg", np.linalg.inv(acescg)), ("grey card, Rec.709", np.linalg.inv(rec709))):
        if (space @ light.white).min() > 0:
            found.append((name, None, xyz @ gains(space, light.white, white).T))
    return found + [("none", None, xyz)]


def run(context):
    door, rows = context.door, []
    handle = door.open("D65", "A")  # for CIEDE2000 in ACEScg
    acescg, white = xyz_from_rgb(ACESCG)
    to_rgb = np.linalg.inv(acescg).T
    daylight, training = Light("D65"), reflectances(TRAINING)
    spectra = {name: np.vstack([reflectances(one) for one in sets]) for name, sets in SETS.items()}
    every, parts = np.vstack(list(spectra.values())), {}
    for name, some in spectra.items():
        start = sum(len(spectra[before]) for before in parts)
        parts[name] = slice(start, start + len(some))
    truth = daylight.xyz(every) @ gains(BRADFORD, daylight.white, white).T @ to_rgb
    rec709, daylight_white = xyz_from_rgb(REC709)
    engines = {}

    def engine(lamp, setting, observer, space):
        key = (lamp, setting, observer, space)
        if key not in engines:
            # What was not balanced keeps the light's colour: the new one's.
            engines[key] = RecipeEngine(
                door, f"metamer: 1\nspace: {space}\ninput: {{illuminant: {lamp}, observer: {observer}}}\nbalanced: {setting}\n"
                f"output: {{illuminant: D65, adaptation: {0 if setting == 'none' else 1}}}\n", BANDS)
        return engines[key]

    for lamp in LIGHTS:
        light = Light(lamp)
        for workflow, camera, picture in pictures(light, daylight, every, training):
            raw = workflow == "none"
            results = {"nothing": picture @ (gains(BRADFORD, light.white, white).T if raw else np.eye(3)) @ to_rgb}
            for setting in SETTINGS:
                if setting == "rgb" and workflow == "grey card, Rec.709":  # in the space that it was done in
                    one = engine(lamp, setting, "CIE 1931 2", "Rec.709")
                    to_space = np.linalg.inv(rec709)
                    result = one.apply(picture @ to_space.T / (to_space @ white))[0] @ rec709.T
                    results[setting] = result @ gains(BRADFORD, daylight_white, white).T @ to_rgb
                    continue
                one = engine(lamp, setting, camera if camera and setting == "camera" else "CIE 1931 2", "ACEScg")
                results[setting] = one.apply(picture @ to_rgb)[0]
                if raw:
                    shown = one.apply(light.white[None] @ to_rgb)[0] @ acescg.T
                    results[setting] = results[setting] @ acescg.T @ gains(BRADFORD, shown[0], white).T @ to_rgb
            errors = {setting: door.delta_e(handle, truth, result) for setting, result in results.items()}
            rows.append({"light": lamp, "workflow": workflow, "camera": camera, "error": {
                setting: {part: float(found[where].mean()) for part, where in parts.items()}
                for setting, found in errors.items()}})
    door.close(handle)
    return rows


def means(rows):
    """{(light, workflow): {setting: [mean of charts, mean of skins]}}, cameras together"""
    groups = {}
    for row in rows:
        groups.setdefault((row["light"], row["workflow"]), []).append(row["error"])
    return {key: {setting: [float(np.mean([error[setting][part] for error in errors])) for part in SETS]
                  for setting in errors[0]} for key, errors in groups.items()}


def worse(rows, setting):
    """[(light, workflow)] where a setting is worse than nothing on charts or skins."""
    return [key for key, errors in means(rows).items()
            if any(done > nothing for done, nothing in zip(errors[setting], errors["nothing"]))]


def markdown(results):
    lines = [f"Charts ({', '.join(SETS['charts'])}) and model skins shot under a lamp and balanced as each workflow does it, then made "
             "daylight with each setting of the recipe's `balanced`; mean CIEDE2000 of charts / skins against the chart in D65. "
             f"Workflows of cameras are means over {len(CAMERAS)}. The setting `camera` has the camera as its observer where there is one. "
             "Unbalanced shots are balanced after the transform (and after nothing).", ""]
    lines += [f"Worse than doing nothing with `{setting}`: " +
              ("; ".join(f"{workflow} under {light}" for light, workflow in worse(results, setting)) or "none") + "."
              for setting in ("bradford", "cat02")]
    columns = ("nothing", *SETTINGS)
    lines += ["", "| light | workflow | " + " | ".join(columns) + " |", "| --- | --- |" + " --- |" * len(columns)]
    for (light, workflow), errors in means(results).items():
        cells = ["{:.2f} / {:.2f}".format(*errors[c]) if c in errors else "" for c in columns]
        lines.append(f"| {light} | {workflow} | " + " | ".join(cells) + " |")
    return lines
