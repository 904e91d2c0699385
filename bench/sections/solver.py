# SPDX-License-Identifier: Apache-2.0
"""Smoothest spectrum, one core, against colour-science's Meng 2015."""

import numpy as np

import peers
from door import Engine
from timing import median_seconds

BANDS = (41, 81, 201, 251)


def boxes(light, count, generator):
    """Tristimuli of box-shaped reflectances: colours that the bounds hold for, and bite on."""
    import colour

    shape = colour.SpectralShape(380, 780, 5)
    wavelengths = shape.wavelengths
    observer = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(shape)
    weights = observer.values.T * colour.SDS_ILLUMINANTS[light].copy().align(shape).values
    weights /= weights[1].sum()
    rows = []
    for _ in range(count):
        centre, width = generator.uniform(400, 700), generator.uniform(30, 160)
        spectrum = 0.04 * generator.random() + generator.random() * (np.abs(wavelengths - centre) < width / 2)
        rows.append(weights @ np.clip(spectrum, 0, 1))
    return np.array(rows)


def engine_microseconds(door, rounds):
    """The exact engine at 81 bands, a colour at a time: a photograph's, and of the whole gamut."""
    generator = np.random.default_rng(1)
    colours = {"photograph": generator.choice(peers.photograph("astronaut").reshape(-1, 4)[:, :3], 4000).astype(float),
               "gamut": generator.random((4000, 3))}
    rows = []
    for scene in ("smooth", "natural"):
        for pair in peers.PAIRS[:4]:
            engine = Engine(door, *pair, 81, scene)
            rows += [{"pair": "->".join(pair), "scene": scene, "colours": name,
                      "microseconds": 1e6 / len(rgb) * float(np.median([engine.apply(rgb)[1] for _ in range(rounds)]))}
                     for name, rgb in colours.items()]
    return rows


def run(context):
    import colour

    generator = np.random.default_rng(2026)
    rows = []
    for light in ("D65", "FL11"):
        tristimuli = boxes(light, 2000, generator)
        for bands in BANDS:
            for upper in (False, True):
                seconds = context.door.time_solves(light, bands, upper, tristimuli)
                rows.append({"light": light, "bands": bands, "upper_bound": upper,
                             "microseconds": float(np.median(seconds[seconds > 0])) * 1e6,
                             "infeasible": int((seconds < 0).sum())})
    engine = engine_microseconds(context.door, context.rounds)
    sample = np.array([0.21781186, 0.12541048, 0.04697113])
    meng = median_seconds(lambda: colour.recovery.XYZ_to_sd_Meng2015(sample), 3) * 1e6
    return {"solves": rows, "engine": engine, "meng_2015_microseconds": meng}


def markdown(results):
    lines = ["| light | bands | R ≥ 0, µs | 0 ≤ R ≤ 1, µs |", "| --- | --- | --- | --- |"]
    by_key = {(r["light"], r["bands"], r["upper_bound"]): r["microseconds"] for r in results["solves"]}
    for light, bands, upper in by_key:
        if not upper:
            lines.append(f"| {light} | {bands} | {by_key[light, bands, False]:.2f} | {by_key[light, bands, True]:.2f} |")
    ours = by_key["D65", 81, False]
    meng = results["meng_2015_microseconds"]
    lines += ["", f"Medians of 2,000 colours. colour-science's Meng 2015, 81 bands, same run: {meng:,.0f} µs, "
                  f"{meng / ours:,.0f} times the time of 81 bands here."]
    if "engine" in results:
        lines += ["", "The exact engine at 81 bands, µs per colour:", "", "| lights | scene | photograph | gamut |",
                  "| --- | --- | --- | --- |"]
        took = {(r["pair"], r["scene"], r["colours"]): r["microseconds"] for r in results["engine"]}
        lines += [f"| {pair} | {scene} | {took[pair, scene, 'photograph']:.2f} | {took[pair, scene, 'gamut']:.2f} |"
                  for pair, scene in dict.fromkeys((r["pair"], r["scene"]) for r in results["engine"])]
    return lines
