# SPDX-License-Identifier: Apache-2.0
"""Where the renderer puts its wavelengths: guided against uniform at equal time, what is learnt, numbers of lanes."""

import csv
import json
import math
import os
from pathlib import Path

import numpy as np

import render_scenes as scenes
from render_scenes import Runs, price

VARIANTS = {"uniform": ("--guiding", "off"), "guided": ("--guiding", "on")}
CASES = [("FL11", "FL11", "", "≥ 2"), ("HP1", "HP1", "", "≥ 2"), ("A through a red gel", "A", scenes.GEL, "> 1"),
         ("A", "A", "", "≥ 0.95"), ("D65", "D65", "", "≥ 0.95")]
SAMPLES = (16, 64, 256)
TRUTH_SAMPLES = 2048
# Curves for the plot alone.
RAW = ("histogram/optimum", "histogram/luminance_optimum", "histogram/density")
LANES = (1, 4, 8, 16)
# Within the patch, of the picture's width and height.
PATCH, PATCH_PLACE = "red", (0.43, 0.63)


def guiding(runs):
    rows = []
    for label, lamp, extra, wanted in CASES:
        scene = scenes.chart(lamp, extra=extra)
        truth = runs.render(scene, TRUTH_SAMPLES, "--guiding", "on", seed=777)[0]
        for samples in SAMPLES:
            scale = math.isqrt(max(SAMPLES) // samples)  # of the picture that is timed: the same work at each count
            large = scenes.chart(lamp, width=scale * scenes.WIDTH, height=scale * scenes.HEIGHT, extra=extra)
            costs = runs.costs(scene, truth, samples, VARIANTS, seeds=5, large=large, pictures=scale * scale)
            uniform, guided = costs["uniform"], costs["guided"]
            rows.append({"light": label, "wanted": wanted, "samples": samples, **costs,
                         "seconds_ratio": guided["seconds"] / uniform["seconds"],
                         "equal_time": [price(uniform, c) / price(guided, c) for c in range(3)],
                         "equal_samples": [u / g for u, g in zip(uniform["mse"], guided["mse"])]})
    return rows


def column(file, name):
    """A column of a table of data/ at 380, 381, ... 780 nm."""
    with open(Path(os.environ["METAMER_DATA"]) / file, newline="", encoding="utf-8") as stream:
        rows = [row for row in csv.reader(stream) if row and not row[0].startswith("#")]
    index = rows[0].index(name)
    table = np.array([(float(row[0]), float(row[index])) for row in rows[1:] if row[index]]).T
    return np.interp(np.arange(380, 781), *table)


def histogram(runs):
    """The density that makes the estimate of a patch free of noise, beside what a pixel of it has learnt (fig. 4.4)."""
    dump = runs.folder / "guide.json"
    runs.render(scenes.chart("FL11"), 1, "--guiding", "on", "--guide-dump", str(dump),
                "--guide-pixel", f"{int(PATCH_PLACE[0] * scenes.WIDTH)},{int(PATCH_PLACE[1] * scenes.HEIGHT)}")
    learnt = json.loads(dump.read_text())["pixels"][0]
    x, y, z = (column("observers/cie_1931_2.csv", name) for name in "XYZ")
    light = column("illuminants/cie_fl.csv", "FL11") * column("reflectances/colorchecker.csv", PATCH)
    optimum = (x + 2 * y + z) * light
    luminance = y * light
    edges = [20 * i for i in range(20)] + [401]
    optimum, luminance = optimum / optimum.sum(), luminance / luminance.sum()
    shares = [float(optimum[a:b].sum()) for a, b in zip(edges, edges[1:])]
    return {"patch": PATCH, "optimum": optimum.tolist(), "luminance_optimum": luminance.tolist(), "optimum_bins": shares,
            "histogram": learnt["histogram"], "density": learnt["density"],
            "difference": 0.5 * float(np.abs(np.array(shares) - learnt["histogram"]).sum())}


def lanes(runs):
    rows = []
    for label, make in (("prism", scenes.prism), ("chart under A", lambda n: scenes.chart("A", n)),
                        ("chart under FL11", lambda n: scenes.chart("FL11", n))):
        truth = runs.render(make(16), 2048, "--guiding", "on", seed=777)[0]
        for count in LANES:
            cost = runs.costs(make(count), truth, 64, {"uniform": ()})["uniform"]
            rows.append({"scene": label, "lanes": count, **cost})
    return rows


def run(context):
    runs = Runs(context.bin_folder)
    return {"size": [scenes.WIDTH, scenes.HEIGHT], "truth_samples": TRUTH_SAMPLES, "guiding": guiding(runs),
            "histogram": histogram(runs), "lanes": lanes(runs)}


def markdown(results):
    width, height = results["size"]
    lines = [f"Guided against uniform wavelengths on a chart, {width} × {height}, direct light, four lanes: how many times lower "
             "time × MSE is. Seconds are user CPU, learning included; the MSE is against "
             f"{results['truth_samples']:,} samples per pixel. Below {max(SAMPLES)} samples a larger picture is timed. Where "
             "guiding finds the light even it leaves wavelengths uniform, and what it then costs is a path in four pixels to "
             "learn from.", "",
             "| light | samples | time, guided/uniform | Y, equal samples | Y, equal time | goal | X, equal time | Z, equal time |",
             "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    for r in results["guiding"]:
        x, y, z = r["equal_time"]
        lines.append(f"| {r['light']} | {r['samples']} | {r['seconds_ratio']:.2f} | {r['equal_samples'][1]:.2f} | {y:.2f} "
                     f"| {r['wanted']} | {x:.2f} | {z:.2f} |")
    h = results["histogram"]
    lines += ["", f"What a pixel of the {h['patch']} patch under FL11 has learnt from one sample per pixel, and the optimum (4.12): "
                  f"{h['difference']:.1%} of the histogram lies in other bins.", "",
              "Hero lanes, 64 samples, wavelengths uniform. X, Y and Z: root mean square error × 10⁴ of a radiance of 1:", "",
              "| scene | lanes | s | X | Y | Z | time × MSE of Y, one lane = 1 |", "| --- | --- | --- | --- | --- | --- | --- |"]
    one = {r["scene"]: price(r) for r in results["lanes"] if r["lanes"] == 1}
    for r in results["lanes"]:
        x, y, z = (np.sqrt(v) * 1e4 for v in r["mse"])
        lines.append(f"| {r['scene']} | {r['lanes']} | {r['seconds']:.2f} | {x:.3g} | {y:.3g} | {z:.3g} "
                     f"| {price(r) / one[r['scene']]:.2g} |")
    return lines


def plot(results, path):
    from plotting import figure, save

    h = results["histogram"]
    drawing, axes = figure("probability per nm", "wavelength, nm")
    nm = np.arange(380, 781)
    edges = [379.5 + 20 * i for i in range(20)] + [780.5]
    widths = np.diff(edges)
    axes.plot(nm, h["optimum"], color="0.6", lw=1, label="optimum by 1 nm")
    axes.plot(nm, h["density"], color="tab:blue", lw=1, label="density drawn from (the picture's)")
    axes.stairs(np.array(h["optimum_bins"]) / widths, edges, color="black", lw=1.5, label="optimum, 20 bins")
    axes.stairs(np.array(h["histogram"]) / widths, edges, color="tab:red", lw=1.5, label="learnt histogram of the pixel")
    axes.set_yscale("log")
    axes.set_ylim(1e-5, 0.3)
    axes.set_title(f"{h['patch'].capitalize()} patch under FL11", fontsize=10)
    save(drawing, axes, path)
