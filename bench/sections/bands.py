# SPDX-License-Identifier: Apache-2.0
"""How many bands: error against the converged engine (401) and time per colour, smooth and spiky lamps."""

import numpy as np

from door import Engine
from peers import PAIRS

BANDS = (16, 24, 32, 41, 61, 81, 121, 161, 201, 251, 321, 401)
CONVERGED = 401


def run(context):
    door, rows = context.door, []
    for pair in PAIRS:
        handle = door.open(*pair)
        probes = door.probes(handle)
        converged, _ = Engine(door, *pair, CONVERGED).apply(probes)
        for bands in BANDS:
            engine = Engine(door, *pair, bands)
            seconds = []
            for _ in range(3):
                result, elapsed = engine.apply(probes)
                seconds.append(elapsed / len(probes))
            errors = np.sort(door.delta_e(handle, converged, result))
            rows.append({"pair": "->".join(pair), "bands": bands, "microseconds": min(seconds) * 1e6,
                         "mean": float(errors.mean()), "p99": float(np.quantile(errors, 0.99)), "max": float(errors[-1])})
        door.close(handle)
    return rows


def markdown(results):
    pairs = list(dict.fromkeys(r["pair"] for r in results))
    lines = ["p99 CIEDE2000 against 401 bands; in brackets µs per colour.", "",
             "| bands | " + " | ".join(pairs) + " |", "| --- |" + " --- |" * len(pairs)]
    for bands in BANDS:
        cells = [f"{r['p99']:.3f} ({r['microseconds']:.1f})" for r in results if r["bands"] == bands]
        lines.append(f"| {bands} | " + " | ".join(cells) + " |")
    return lines


def plot(results, path):
    from plotting import figure, save

    drawing, axes = figure("CIEDE2000, p99 against 401 bands", "µs per colour, one core")
    for pair in dict.fromkeys(r["pair"] for r in results):
        rows = [r for r in results if r["pair"] == pair and r["bands"] < CONVERGED]
        axes.loglog([r["microseconds"] for r in rows], [max(r["p99"], 1e-4) for r in rows], "o-", label=pair)
        axes.annotate(str(rows[0]["bands"]), (rows[0]["microseconds"], rows[0]["p99"]))
    axes.axvline(10, color="0.8", zorder=0)
    save(drawing, axes, path)
