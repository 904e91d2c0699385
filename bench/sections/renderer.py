# SPDX-License-Identifier: Apache-2.0
"""The renderer's noise against time, with each of its methods and beside Mitsuba, direct light alone and at six edges;
how lights are chosen; memory."""

import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

import render_scenes as scenes
from render_scenes import Runs, over_mitsuba, price, race_price

REPOSITORY = Path(__file__).resolve().parent.parent.parent
METHODS = {"uniform": (), "guided": ("--guiding", "on"), "ReSTIR, lanes": ("--restir", "lanes"),
           "guided, ReSTIR, lanes": ("--guiding", "on", "--restir", "lanes")}
# The first one is what the others are measured against.
CHOICES = {"by power": ("--lights", "power"), "by place": (), "ReSTIR, hero": ("--restir", "hero"),
           "ReSTIR, lanes": ("--restir", "lanes")}
MITSUBA = ("scalar_spectral", "llvm_ad_spectral")
SIDE = 256
DIRECT, DEEP = 2, 6  # edges at most
SAMPLES = (16, 64)
TRUTH_SAMPLES = 1024
# Pictures whose memory is looked at.
LARGE = {"memory_mib": (1920, 1080), "memory_4k_mib": (3840, 2160)}
SECONDS = {"processor": "processor, start included", "processor_beyond_start": "processor, beyond the start",
           "wall": "wall, start included", "wall_beyond_start": "wall, beyond the start"}


def noise_scenes(folder, depth):
    """Scene, and the script and first argument that make Mitsuba render the same."""
    oracle = REPOSITORY / "tests/oracle"
    size = {"depth": depth, "width": SIDE, "height": SIDE}
    return {"chart under A": (scenes.chart("A", **size), (oracle / "mitsuba_chart.py", "A")),
            "chart under FL11": (scenes.chart("FL11", **size), (oracle / "mitsuba_chart.py", "FL11")),
            "LED wall": (scenes.box(scenes.WALL, **size), (oracle / "mitsuba_wall.py", folder / "wall.exr"))}


def mitsuba(runs, script, first, truth, samples, variant, depth):
    """Its relative error of Y and its seconds; None, and a line that says so, where it does not run."""
    output = runs.folder / "mitsuba.npz"
    start = time.perf_counter()
    # Apart: LLVM may take its whole program down where it does not know the processor.
    with open(runs.folder / "mitsuba.log", "w+", encoding="utf-8") as log:
        process = subprocess.Popen([sys.executable, script, str(first), str(SIDE), str(SIDE), str(samples), variant,
                                    str(depth), output], stdout=log, stderr=log)
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        log.seek(0)
        said = log.read().strip().splitlines()
    if process.returncode != 0:
        reason = (said or [f"exit status {process.returncode}"])[-1]
        print(f"skipped: Mitsuba {variant}, {Path(script).name} {first}: {reason}", flush=True)
        return None
    result = np.load(output)
    return {"samples": samples, "error": [None, scenes.relative_error(result["picture"], truth[1]), None],
            "processor": usage.ru_utime + usage.ru_stime, "wall": wall,
            "processor_beyond_start": float(result["processor"]), "wall_beyond_start": float(result["wall"])}


def noise(runs, depth):
    rows = []
    for label, (scene, (script, first)) in noise_scenes(runs.folder, depth).items():
        truth = runs.render(scene, TRUTH_SAMPLES, *METHODS["guided, ReSTIR, lanes"], seed=777).picture
        curves = {name: [] for name in METHODS}
        for samples in SAMPLES:
            for name, point in runs.race(scene, truth, samples, METHODS).items():
                curves[name].append(point)
        for variant in MITSUBA:
            points = [mitsuba(runs, script, first, truth, samples, variant, depth) for samples in SAMPLES]
            if None not in points:
                curves[f"Mitsuba {variant}"] = points
        rows.append({"scene": label, "curves": curves})
    return rows


def choices(runs):
    """Each way to choose a light against that by power, in the same time."""
    rows = []
    for label, scene in (("LED wall, 32 × 18, direct light", scenes.box(scenes.WALL)),
                         ("100,000 emitters, direct light", scenes.box(scenes.MANY)),
                         ("a room of 100,000 emitters, six edges", scenes.room())):
        truth = runs.render(scene, TRUTH_SAMPLES, "--restir", "lanes", seed=777).picture
        costs = runs.costs(scene, truth, SAMPLES[-1], CHOICES, seeds=2)
        plain = costs.pop("by power")
        rows.append({"scene": label, "better": {name: price(plain) / price(cost) for name, cost in costs.items()}})
    return rows


def memory(runs, width, height):
    """At most, of a whole run with all that takes room; more samples take no more."""
    scene = scenes.chart("FL11", depth=4, width=width, height=height).replace(
        f"height: {height}", f"height: {height}, bins: {{from: 400, to: 775, step: 25}}")
    return round(runs.render(scene, 2, "--guiding", "on", "--restir", "lanes").mebibytes)


def run(context):
    runs = Runs(context.bin_folder)
    scenes.write_lights(runs.folder)
    return {"side": SIDE, "noise": noise(runs, DEEP), "direct": noise(runs, DIRECT), "choices": choices(runs),
            **{name: memory(runs, width, height) for name, (width, height) in LARGE.items()}}


def race_table(row):
    """Every method's figures at the most samples."""
    lines = ["| | relative MSE of X, Y, Z | " + " | ".join(f"{text}, s" for text in SECONDS.values()) + " | price |",
             "| --- |" + " --- |" * (len(SECONDS) + 2)]
    for name, points in row["curves"].items():
        errors = " ".join("–" if e is None else f"{e:.2g}" for e in points[-1]["error"])
        seconds = " | ".join(f"{points[-1][kind]:.2f}" for kind in SECONDS)
        lines.append(f"| {name} | {errors} | {seconds} | {race_price(points[-1]):.2g} |")
    return lines


def markdown(results):
    lines = [f"{results['side']} × {results['side']}, {SAMPLES[-1]} samples. The relative MSE is the mean over the pixels of the squared "
             "error over what is there (a hundredth of the picture's mean added, so that black counts); the price is that of Y times "
             "processor seconds, start included; lower is better. Mitsuba where it runs on the machine."]
    for title, rows in ((f"At most {DEEP} edges", results["noise"]), ("Direct light", results["direct"])):
        for row in rows:
            lines += ["", f"{title}, {row['scene']}:", "", *race_table(row)]
            if over_mitsuba(row) is not None:
                ratios = "; ".join(f"{text} {over_mitsuba(row, kind):.3g}" for kind, text in SECONDS.items())
                lines += ["", f"Price of the best of ours over the better Mitsuba's, by seconds: {ratios}."]
    lines += ["", f"Lights chosen by what they may give a point, and ReSTIR, against choice by power alone, {SAMPLES[-1]} samples, equal "
                  "time: MSE of Y lower by", "", "| lights | by place | ReSTIR, hero | ReSTIR, lanes |", "| --- | --- | --- | --- |"]
    for row in results["choices"]:
        lines.append(f"| {row['scene']} | " + " | ".join(f"{row['better'][name]:.2f}" for name in CHOICES if name in row["better"]) + " |")
    peaks = "; ".join(f"{width} × {height}: {results[name]:,} MiB" for name, (width, height) in LARGE.items()
                      if name in results)
    return lines + ["", f"Peak memory with guiding, ReSTIR and 16 spectral bins: {peaks}."]


def draw(row, axes):
    """A scene's noise against time."""
    for name, points in row["curves"].items():
        axes.loglog([p["processor"] for p in points], [p["error"][1] for p in points], "o-", ms=3, label=name)
    axes.set_title(row["scene"], fontsize=9)
    axes.set_xlabel("processor seconds")
    axes.set_ylabel("relative mean square error of Y")


def plot(results, path):
    from plotting import row_of, write

    drawing, panels = row_of(len(results["noise"]))
    for axes, row in zip(panels, results["noise"]):
        draw(row, axes)
    write(drawing, panels, path, named=panels[:1])
