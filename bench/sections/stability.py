# SPDX-License-Identifier: Apache-2.0
"""Numerical stability: every light of data/ as input, float32 against wider arithmetic, instruction sets."""

import json
import os
from pathlib import Path

import numpy as np

from door import Engine, Map, targets, use_target

ADVERSARIAL = 1_000_000


def tables(group):
    manifest = json.loads((Path(os.environ["METAMER_DATA"]) / "manifest.json").read_text(encoding="utf-8"))
    return [table for table in manifest["tables"] if table["group"] == group]


def illuminants():
    return [name for table in tables("illuminants") if table["quantity"] == "spectral power distribution"
            for name in table["names"]]


def observers(context):
    """Every observer of data/ under every light: condition number, and where the tristimulus is relaxed."""
    rows = []
    for observer in (name for table in tables("observers") for name in table["names"]):
        found = {light: context.door.observer_diagnostics(observer, light) for light in illuminants()}
        seen = {light: d for light, d in found.items() if d}
        ranked = sorted(seen, key=lambda light: seen[light]["condition"])
        rows.append({"observer": observer, "least": seen[ranked[0]]["condition"],
                     "median": seen[ranked[len(ranked) // 2]]["condition"], "largest": seen[ranked[-1]]["condition"],
                     "worst_light": ranked[-1], "next_worst": seen[ranked[-2]]["condition"], "next_light": ranked[-2],
                     "relaxed": [light for light in ranked if seen[light]["relaxation"] > 0],
                     "refused": [light for light, d in found.items() if not d],
                     "conditions": {light: round(d["condition"], 4) for light, d in seen.items()}})
    return rows


def lights(context):
    """Each as input light, to D65: condition number, relaxation, gain of the matrix and the largest gain over it, and error."""
    door, rows = context.door, []
    handle = door.open("D65", "A")  # for CIEDE2000 in ACEScg, and chromaticities
    probes = door.probes(handle)[::4]
    for name in illuminants():
        engine = Engine(door, name, "D65", 251)
        if engine.refused:
            rows.append({"light": name, "refused": True})
            continue
        converged, _ = Engine(door, name, "D65", 401).apply(probes)
        result, _ = engine.apply(probes)
        errors = door.delta_e(handle, converged, result)
        rows.append({"light": name, **engine.diagnostics(), "gain_over_matrix": engine.largest_gain(probes),
                     "p99": float(np.quantile(errors, 0.99)), "max": float(errors.max()),
                     "finite": bool(np.isfinite(result).all())})
    door.close(handle)
    return rows


def adversarial(door, count):
    """Colours where arithmetic is hard: on kinks, edges and the neutral axis, over ±30 stops, negatives, near zero."""
    generator = np.random.default_rng(7)
    rgba = np.ones((count, 4), np.float32)
    directions = generator.normal(size=(count, 3))
    directions[: count // 2] = generator.random((count // 2, 3))  # inside the gamut
    directions[: count // 8] = 1 + 1e-6 * generator.normal(size=(count // 8, 3))  # the neutral axis
    directions[count // 8: count // 4, generator.integers(0, 3)] = 0  # gamut edges
    rgba[:, :3] = directions * np.exp2(generator.uniform(-30, 30, (count, 1)))
    return rgba


def arithmetic(context):
    """The kernel's float32 against the same tables in double and long double, relative to the pixel's largest value."""
    rows = []
    rgba = adversarial(context.door, ADVERSARIAL)
    for pair in (("D65", "A"), ("D65", "HP1"), ("FL11", "D50")):
        table = Map(Engine(context.door, *pair, 251), 0.09)
        output = np.empty_like(rgba)
        table.run(rgba, output)
        scale = np.abs(output[:, :3]).max(axis=1, keepdims=True).astype(np.float64)
        double, extended = table.evaluate(64, rgba), table.evaluate(80, rgba)
        for name, reference, value in (("float32 against double", double, output[:, :3]),
                                       ("float32 against long double", extended, output[:, :3]),
                                       ("double against long double", extended, double)):
            difference = (np.abs(value - reference) / np.maximum(scale, 1e-300)).max(axis=1)
            rows.append({"pair": "->".join(pair), "what": name, "median": float(np.median(difference)),
                         "p9999": float(np.quantile(difference, 0.9999)), "max": float(difference.max()),
                         "finite": bool(np.isfinite(value).all())})
    return rows


def instruction_sets(context):
    """Every instruction set that runs here against the first: pixels with other bits."""
    rgba = adversarial(context.door, 100_003)
    rgba[:7, 0] = [np.nan, np.inf, -np.inf, 0.0, -0.0, 1e-45, 65504]
    table = Map(Engine(context.door, "D65", "HP1", 251), 0.09)
    rows, first = [], None
    try:
        for name, bit in targets(context.door).items():
            use_target(context.door, bit)
            output = np.empty_like(rgba)
            table.run(rgba, output)
            bits = output.view(np.uint32)
            first = bits if first is None else first
            rows.append({"target": name, "pixels": len(rgba), "different": int((bits != first).any(axis=1).sum())})
    finally:
        use_target(context.door, 0)
    return rows


def run(context):
    return {"lights": lights(context), "observers": observers(context), "arithmetic": arithmetic(context),
            "instruction_sets": instruction_sets(context)}


TABLE = ("| light | condition | relaxation | matrix gain | worst gain over it | p99 | max |",
         "| --- | --- | --- | --- | --- | --- | --- |")


def _light_row(r):
    return (f"| {r['light']} | {r['condition']:.3g} | {r.get('relaxation', 0.0):.2g} | {r['matrix_gain']:.3g} "
            f"| {r['gain_over_matrix']:.3g} | {r['p99']:.3f} | {r['max']:.2f} |")


def _some(names):
    """The last three, and how many there are."""
    more = f"{len(names)}: …, " if len(names) > 3 else ""
    return more + ", ".join(names[-3:]) or "none"


def markdown(results):
    ranked = sorted((r for r in results["lights"] if "refused" not in r), key=lambda r: -r["condition"])
    lines = [f"{len(results['lights'])} lights as input, to D65. Condition number of the white-normalised weights; how far the "
             "tristimulus is relaxed; gain of the linear branch and of the worst colour over it; error against 401 bands. The ten worst "
             "and three ordinary ones:", "", *TABLE]
    for r in ranked[:10] + [r for r in ranked if r["light"] in ("A", "D65", "FL11")]:
        lines.append(_light_row(r))
    refused = [r["light"] for r in results["lights"] if "refused" in r]
    lines += ["", "Refused, with a message: " + (", ".join(refused) or "none") + ".", "",
              "<details><summary>All lights</summary>", "", *TABLE]
    lines += [_light_row(r) for r in ranked]
    lines += ["", "</details>", "",
              f"Every observer of data/ under the {len(results['lights'])} lights: condition number, and the lights under which "
              "its tristimulus is relaxed, or refused.", "",
              "| observer | least | median | worst but one | worst | relaxed under | refused |",
              "| --- | --- | --- | --- | --- | --- | --- |"]
    lines += [f"| {r['observer']} | {r['least']:.2f} | {r['median']:.2f} | {r['next_worst']:.3g} ({r['next_light']}) "
              f"| {r['largest']:.3g} ({r['worst_light']}) | {_some(r['relaxed'])} | {_some(r['refused'])} |" for r in results["observers"]]
    lines += ["",
              f"The kernel on {ADVERSARIAL:,} hard colours, difference relative to the pixel's largest value:", "",
              "| lights | | median | p99.99 | max | all finite |", "| --- | --- | --- | --- | --- | --- |"]
    lines += [f"| {r['pair']} | {r['what']} | {r['median']:.1e} | {r['p9999']:.1e} | {r['max']:.1e} | {r['finite']} |"
              for r in results["arithmetic"]]
    lines += ["", "Instruction sets, same bits asked:", "", "| instruction set | pixels | different |", "| --- | --- | --- |"]
    return lines + [f"| {r['target']} | {r['pixels']:,} | {r['different']} |" for r in results["instruction_sets"]]


def plot(results, path):
    """Every light: how far apart it tells three channels, against what that costs."""
    from plotting import figure, save

    rows = [r for r in results["lights"] if "refused" not in r and r["p99"] > 0]
    drawing, axes = figure("gain of the linear branch", "condition number of CIE 1931 under the light")
    points = axes.scatter([r["condition"] for r in rows], [r["matrix_gain"] for r in rows],
                          c=[min(r["p99"], 1.5) for r in rows], s=18, label="lights of data/, to D65")
    axes.set_xscale("log")
    axes.set_yscale("log")
    for r in rows:
        if r["condition"] > 6 or r["light"] in ("A", "FL11"):
            axes.annotate(r["light"], (r["condition"], r["matrix_gain"]), fontsize=7)
    drawing.colorbar(points, label="CIEDE2000, p99 of 251 bands against 401")
    save(drawing, axes, path)
