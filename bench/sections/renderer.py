# SPDX-License-Identifier: Apache-2.0
"""The renderer's noise against time, with each of its methods and beside Mitsuba; ReSTIR; memory."""

import subprocess
import sys
from pathlib import Path

import numpy as np

import render_scenes as scenes
from render_scenes import Runs, price

REPOSITORY = Path(__file__).resolve().parent.parent.parent
METHODS = {"uniform": (), "guided": ("--guiding", "on"), "ReSTIR, hero": ("--restir", "hero"),
           "ReSTIR, lanes": ("--restir", "lanes")}
MITSUBA = ("scalar_spectral", "llvm_ad_spectral")
SAMPLES = (16, 64, 256)
RESTIR_SAMPLES = 64
LARGE = (1920, 1080)


def noise_scenes(folder):
    """Scene, and the script and first argument that make Mitsuba render the same."""
    oracle = REPOSITORY / "tests/oracle"
    return {"chart under A": (scenes.chart("A"), (oracle / "mitsuba_chart.py", "A")),
            "chart under FL11": (scenes.chart("FL11"), (oracle / "mitsuba_chart.py", "FL11")),
            "LED wall": (scenes.box(scenes.WALL), (oracle / "mitsuba_wall.py", folder / "wall.exr"))}


def mitsuba(runs, script, first, truth, samples, variant):
    """Its seconds and MSE of Y; None, and a line that says so, where it does not run."""
    output = runs.folder / "mitsuba.npz"
    # Apart: LLVM may take its whole program down where it does not know the processor.
    done = subprocess.run([sys.executable, script, str(first), str(scenes.WIDTH), str(scenes.HEIGHT), str(samples), variant,
                           output], capture_output=True, text=True)
    if done.returncode != 0:
        reason = (done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1]
        print(f"skipped: Mitsuba {variant}, {Path(script).name} {first}: {reason}", flush=True)
        return None
    result = np.load(output)
    error = float(((result["picture"] - truth[1]) ** 2).mean())
    return {"samples": samples, "mse": [None, error, None], "seconds": float(result["seconds"])}


def noise(runs):
    rows = []
    for label, (scene, (script, first)) in noise_scenes(runs.folder).items():
        truth = runs.render(scene, 2048, "--guiding", "on", seed=777)[0]
        curves = {name: [] for name in METHODS}
        for samples in SAMPLES:
            for name, cost in runs.costs(scene, truth, samples, METHODS).items():
                curves[name].append(cost)
        for variant in MITSUBA:
            points = [mitsuba(runs, script, first, truth, samples, variant) for samples in SAMPLES[:2]]
            if None not in points:
                curves[f"Mitsuba {variant}"] = points
        rows.append({"scene": label, "curves": curves})
    return rows


def restir(runs):
    rows = []
    for label, light, wanted in (("LED wall, 32 × 18", scenes.WALL, "≥ 4"), ("100,000 emitters", scenes.MANY, "≥ 10")):
        scene = scenes.box(light)
        truth = runs.render(scene, 2048, seed=777)[0]
        variants = {name: METHODS[name] for name in ("uniform", "ReSTIR, hero", "ReSTIR, lanes")}
        costs = runs.costs(scene, truth, RESTIR_SAMPLES, variants, seeds=2)
        plain = costs.pop("uniform")
        rows.append({"scene": label, "wanted": wanted,
                     "better": {name: price(plain) / price(cost) for name, cost in costs.items()}})
    return rows


def memory(runs):
    width, height = LARGE
    scene = scenes.chart("FL11", depth=4, width=width, height=height).replace(
        f"height: {height}", f"height: {height}, bins: {{from: 400, to: 775, step: 25}}")
    return round(runs.render(scene, 5, "--guiding", "on", "--restir", "lanes")[2])


def run(context):
    runs = Runs(context.bin_folder)
    scenes.write_lights(runs.folder)
    return {"size": [scenes.WIDTH, scenes.HEIGHT], "noise": noise(runs), "restir_samples": RESTIR_SAMPLES,
            "restir": restir(runs), "memory_mib": memory(runs)}


def markdown(results):
    width, height = results["size"]
    lines = [f"{width} × {height}, direct light. Time × MSE of Y (user CPU seconds), relative to uniform wavelengths with the same "
             "samples; lower is better. Mitsuba where it runs on the machine.", ""]
    for row in results["noise"]:
        curves = row["curves"]
        counts = [c["samples"] for c in curves["uniform"]]
        lines += [row["scene"], "", "| | " + " | ".join(f"{n} samples" for n in counts) + " |",
                  "| --- |" + " --- |" * len(counts)]
        for name, points in curves.items():
            cells = [f"{price(p) / price(u):.3g}" for p, u in zip(points, curves["uniform"])]
            lines.append(f"| {name} | " + " | ".join(cells + [""] * (len(counts) - len(cells))) + " |")
        if (ratio := scenes.best_over_mitsuba(curves)) is not None:
            lines += ["", f"Best of ours over the better Mitsuba, {counts[1]} samples each: {ratio:.3g}."]
        lines.append("")
    lines += [f"ReSTIR against next-event estimation by power, {results['restir_samples']} samples, equal time: MSE of Y lower by", "",
              "| lights | hero | lanes | asked |", "| --- | --- | --- | --- |"]
    for r in results["restir"]:
        lines.append(f"| {r['scene']} | {r['better']['ReSTIR, hero']:.2f} | {r['better']['ReSTIR, lanes']:.2f} | {r['wanted']} |")
    return lines + ["", f"Peak memory at {LARGE[0]} × {LARGE[1]}, guiding, ReSTIR and 16 spectral bins: {results['memory_mib']:,} MiB "
                        "(asked: 2,048)."]


def draw(row, axes):
    """A scene's noise against time."""
    for name, points in row["curves"].items():
        axes.loglog([p["seconds"] for p in points], [p["mse"][1] for p in points], "o-", ms=3, label=name)
    axes.set_title(row["scene"], fontsize=9)
    axes.set_xlabel("user CPU seconds")
    axes.set_ylabel("mean square error of Y")


def plot(results, path):
    from plotting import row_of, write

    drawing, panels = row_of(len(results["noise"]))
    for axes, row in zip(panels, results["noise"]):
        draw(row, axes)
    write(drawing, panels, path, named=panels[:1])
