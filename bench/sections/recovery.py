# SPDX-License-Identifier: Apache-2.0
"""Other recoveries as the reference scene of the same pipeline: CIEDE2000 on a measured chart under five lights.

The chart's tristimuli under D65 get a spectrum from each method; that spectrum and the measured one are lit by the new
light and compared, relative to D65's white (the eye stays with daylight).
"""

import time

import numpy as np

from door import Engine

LIGHTS = ("A", "HP1", "FL11", "LED-RGB1", "D50")
CHART = "BabelColor Average"
# The data sets do not hold this chart; the natural scene holds charts of the same paints.
OURS = (("metamer smooth", "smooth", ""), ("metamer natural", "natural", ""),
        ("metamer dataset, 190 surfaces", "dataset", "rawtoaces 190"), ("metamer dataset, TM-30", "dataset", "tm30"))


def run(context):
    import warnings

    import colour

    warnings.simplefilter("ignore")
    shape = colour.SpectralShape(380, 780, 5)
    cmfs = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(shape)
    lights = {name: colour.SDS_ILLUMINANTS[name].copy().align(shape) for name in ("D65", *LIGHTS)}
    chart = [sd.copy().align(shape) for sd in colour.SDS_COLOURCHECKERS[CHART].values()]

    def xyz(spectrum, light):
        weights = cmfs.values * lights[light].values[:, None]
        return spectrum @ weights / weights[:, 1].sum()

    white = xyz(np.ones(len(shape.wavelengths)), "D65")
    white_xy = white[:2] / white.sum()

    def lab(values):
        return colour.XYZ_to_Lab(values, white_xy)

    given = np.array([xyz(sd.values, "D65") for sd in chart])
    truth = {light: np.array([xyz(sd.values, light) for sd in chart]) for light in LIGHTS}
    srgb = np.clip(colour.XYZ_to_RGB(given, "sRGB", apply_cctf_encoding=False), 0, 1)
    methods = {
        "Smits 1999": lambda i: colour.recovery.RGB_to_sd_Smits1999(srgb[i]),
        "Mallett 2019": lambda i: colour.recovery.RGB_to_sd_Mallett2019(srgb[i]),
        "Jakob 2019": lambda i: colour.recovery.XYZ_to_sd_Jakob2019(given[i], cmfs=cmfs, illuminant=lights["D65"]),
        "Otsu 2018": lambda i: colour.recovery.XYZ_to_sd_Otsu2018(given[i], cmfs=cmfs, illuminant=lights["D65"]),
        "Meng 2015": lambda i: colour.recovery.XYZ_to_sd_Meng2015(given[i], cmfs=cmfs, illuminant=lights["D65"]),
    }
    rows = []
    for name, recover in methods.items():
        start = time.perf_counter()
        spectra = [recover(i) for i in range(len(chart))]
        microseconds = (time.perf_counter() - start) / len(chart) * 1e6
        recovered = [sd.copy().align(shape).values for sd in spectra]
        row = {"method": name, "microseconds": microseconds, "lights": {}}
        for light in LIGHTS:
            errors = colour.delta_E(lab(truth[light]), lab(np.array([xyz(r, light) for r in recovered])),
                                    method="CIE 2000")
            row["lights"][light] = {"mean": float(errors.mean()), "max": float(errors.max())}
        rows.append(row)
    # Ours: the same chart through the transform itself, ACEScg in and out, eye with daylight.
    acescg = colour.RGB_COLOURSPACES["ACEScg"]
    bradford = {"chromatic_adaptation_transform": "Von Kries"}
    rgb = colour.XYZ_to_RGB(given, acescg, illuminant=white_xy, **bradford)
    for name, scene, surfaces in OURS:
        row = {"method": name, "lights": {}}
        seconds = []
        for light in LIGHTS:
            engine = Engine(context.door, "D65", light, 251, scene, surfaces)
            result, elapsed = engine.apply(rgb)
            seconds.append(elapsed / len(rgb))
            ours = colour.RGB_to_XYZ(result, acescg, illuminant=white_xy, **bradford)
            errors = colour.delta_E(lab(truth[light]), lab(ours), method="CIE 2000")
            row["lights"][light] = {"mean": float(errors.mean()), "max": float(errors.max())}
        row["microseconds"] = min(seconds) * 1e6
        rows.append(row)
    return rows


def markdown(results):
    lines = [f"{CHART}: 24 measured patches seen under D65, shown under another light; mean and (largest) CIEDE2000.", "",
             "| method | µs per colour | " + " | ".join(LIGHTS) + " |", "| --- | --- |" + " --- |" * len(LIGHTS)]
    for row in results:
        cells = [f"{row['lights'][light]['mean']:.2f} ({row['lights'][light]['max']:.1f})" for light in LIGHTS]
        lines.append(f"| {row['method']} | {row['microseconds']:,.1f} | " + " | ".join(cells) + " |")
    return lines
