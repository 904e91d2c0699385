# SPDX-License-Identifier: Apache-2.0
"""How much small differences are magnified, how much saturated lights grow, and what files do to pixels of noise."""

import csv
import itertools
import json
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from door import RecipeEngine

LIGHTS = ("A", "HP1", "FL11", "LED-RGB1")
# (input, filters of the input, output)
PAIRS = ([("D65", "", light) for light in LIGHTS] + [(light, "", "D65") for light in LIGHTS] +
         [("FL11", "", "D50"), ("A", "", "LED-B3"), ("LED-B3", "", "A"), ("HP2", "", "D65"), ("D65", "", "1900 K"),
          ("D65", "Lee 204 Full C.T. Orange", "D65")])
SCENES = ("natural", "smooth")
FILES = (("LED-RGB1", "D65"), ("FL11", "D65"), ("A", "D65"), ("D65", "HP1"))
TABLES = (("chain of 65 nodes", ".ctf", 65, ()), ("chain of 33 nodes", ".ctf", 33, ()), ("cube of 33, fitted", ".cube", 33, ()),
          ("cube of 65, sampled", ".cube", 65, ("--sampled",)))
BANDS, LUMINANCE, STEP, MOST_STEP = 81, 0.18, 1e-3, 0.05
DIRECTIONS = np.array([d for d in itertools.product((-1, 0, 1), repeat=3) if any(d)], float)
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1, keepdims=True)
Y_OF_ACESCG = np.array([0.27222872, 0.67408177, 0.05368952])


def pixels():
    """{kind: linear ACEScg, n x 3}"""
    kinds = {}
    with (Path(os.environ["METAMER_DATA"]) / "pixels/certificate.csv").open(encoding="utf-8") as text:
        for row in csv.DictReader(text):
            kinds.setdefault(row["kind"], []).append([float(row[c]) for c in ("red", "green", "blue")])
    return {kind: np.array(rows) for kind, rows in kinds.items()}


def colours():
    """Colours with light in them, at the protocol's luminance: {name: n x 3}"""
    random = np.random.default_rng(2)
    kinds = pixels()
    spread = random.dirichlet((1, 1, 1), 2000)
    found = {"saturated lights": kinds["saturated light"], "AP1": spread / (spread @ Y_OF_ACESCG)[:, None],
             "photographs": kinds["photograph"]}
    bright = {name: rgb[rgb @ Y_OF_ACESCG > 1e-3 * np.abs(rgb).max(axis=1)] for name, rgb in found.items()}
    return {name: rgb * (LUMINANCE / (rgb @ Y_OF_ACESCG))[:, None] for name, rgb in bright.items()}


def gains(door, handle, engine, rgb):
    """CIEDE2000 out per CIEDE2000 in, in the worst direction of each colour."""
    step = np.minimum(STEP * np.linalg.norm(rgb, axis=1), MOST_STEP * LUMINANCE)[:, None]
    result, worst = engine.apply(rgb)[0], np.zeros(len(rgb))
    for direction in DIRECTIONS:
        moved = rgb + step * direction
        ratio = door.delta_e(handle, result, engine.apply(moved)[0]) / np.maximum(door.delta_e(handle, rgb, moved), 1e-9)
        worst = np.maximum(worst, ratio)
    return worst


def run(context):
    door = context.door
    handle = door.open("D65", "A")  # for CIEDE2000 in ACEScg
    sets, rows = colours(), []
    for scene in SCENES:
        for source, gel, destination in PAIRS:
            filters = f", filters: [{gel}]" if gel else ""
            engine = RecipeEngine(door, f"metamer: 1\nspace: ACEScg\ninput: {{illuminant: {source}{filters}}}\n"
                                        f"output: {{illuminant: {destination}, adaptation: 1}}\nscene: {{kind: {scene}}}\n", BANDS)
            light = sets["saturated lights"]
            energy = (engine.apply(light)[0] @ Y_OF_ACESCG) / (light @ Y_OF_ACESCG)
            found = {name: gains(door, handle, engine, rgb) for name, rgb in sets.items()}
            rows.append({"scene": scene, "pair": f"{source}{' + ' + gel if gel else ''}->{destination}",
                         "gain": {name: {"p99": float(np.quantile(g, 0.99)), "max": float(g.max())} for name, g in found.items()},
                         "energy": {"least": float(energy.min()), "most": float(energy.max())}})
    door.close(handle)
    return {"engine": rows, "files": files(context)}


def files(context):
    """What certificates say of pixels."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for source, destination in FILES:
            for name, extension, size, options in TABLES:
                file = Path(folder) / f"{source}_{destination}_{size}{extension}"
                subprocess.run([context.bin_folder / "lutgen", "bake", "--illuminant-in", source, "--illuminant-out", destination,
                                "--adaptation", "1", "--size", str(size), *options, "-o", file], check=True,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                found = json.loads(Path(f"{file}.json").read_text())
                rows.append({"pair": f"{source}->{destination}", "file": name, "p99": found["error"]["p99"], **found["pixels"]})
    return rows


def markdown(results):
    lines = ["Local gain: CIEDE2000 out per CIEDE2000 in, in the worst of 26 directions, the eye adapted. Saturated lights and photographs are "
             "those of data/pixels; AP1 is 2,000 colours all over it. Energy: luminance out over in at the saturated lights.", "",
             "| scene | pair | " + " | ".join(f"{name}, p99 / max" for name in results["engine"][0]["gain"]) + " | energy |",
             "| --- | --- | --- | --- | --- | --- |"]
    for scene in SCENES:
        rows = [row for row in results["engine"] if row["scene"] == scene]
        for row in rows:
            cells = " | ".join(f"{g['p99']:.2f} / {g['max']:.2f}" for g in row["gain"].values())
            lines.append(f"| {scene} | {row['pair']} | {cells} | {row['energy']['least']:.2f} … {row['energy']['most']:.2f} |")
        means = " | ".join(f"**{np.mean([r['gain'][n]['p99'] for r in rows]):.2f} / {max(r['gain'][n]['max'] for r in rows):.2f}**"
                           for n in rows[0]["gain"])
        lines.append(f"| {scene} | **mean of p99 / largest** | {means} | |")
    lines += ["", "Files on pixels, by their certificates: distance from the engine over a pixel's largest channel, and 99th percentiles on photographs in "
              "display codes.", "", "| pair | file | p99 | off by, p99.9 | largest | photographs | noisy |", "| --- | --- | --- | --- | --- | --- | --- |"]
    for row in results["files"]:
        off, codes = row["off_by"], row["display_codes"]
        lines.append(f"| {row['pair']} | {row['file']} | {row['p99']:.2f} | {off['p999']:.3f} | {off['largest']:.3f} "
                     f"| {codes['photograph_p99']:.2f} | {codes['noisy_p99']:.2f} |")
    return lines
