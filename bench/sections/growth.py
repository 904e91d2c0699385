# SPDX-License-Identifier: Apache-2.0
"""How cost grows: picture and cube size, recipes in a config, emitters of a lamp and of a scene, patches, threads.

Exponents over the larger half, where what does not grow no longer shows."""

import subprocess
import tempfile
from pathlib import Path

import numpy as np

import peers
from timing import exponent, interleaved_medians, median_seconds

WAVELENGTHS = np.arange(380, 781, 5)


def command(*parts):
    subprocess.run([str(part) for part in parts], check=True, stdout=subprocess.DEVNULL)


def picture_size(context, folder):
    handle = context.door.open("D65", "HP1")
    picture = peers.photograph("astronaut").reshape(-1, 4)
    calls = {}
    for pixels in (1 << 14, 1 << 16, 1 << 18, 1 << 20, len(picture)):
        source = np.ascontiguousarray(picture[:pixels])
        destination = np.empty_like(source)
        calls[pixels] = lambda s=source, d=destination: context.door.map(handle, s, d)
    times = interleaved_medians(calls, context.rounds)
    context.door.close(handle)
    return times


def cube_size(context, folder):
    calls = {size ** 3: lambda s=size: command(context.bin_folder / "lutgen", "bake", "--illuminant-in", "D65", "--illuminant-out", "A", "--size", s,
                                               "-o", folder / "grow.cube") for size in (17, 33, 49, 65, 97)}
    return interleaved_medians(calls, 3)


def recipes(context, folder):
    files = []
    for i in range(16):
        files.append(folder / f"r{i}.yaml")
        files[-1].write_text(f"metamer: 1\nname: r{i}\nspace: ACEScg\ninput: {{illuminant: D65}}\n"
                             f"output: {{illuminant: {2500 + 250 * i} K}}\n", encoding="utf-8")
    calls = {n: lambda n=n: command(context.bin_folder / "lutgen", "config", "-o", folder / f"c{n}" / "config.ocio",
                                    *files[:n]) for n in (2, 4, 8, 16)}
    for n in calls:
        (folder / f"c{n}").mkdir(exist_ok=True)
    return {n: median_seconds(call, 1) for n, call in calls.items()}


def emitters(context, folder):
    files = []
    for i, peak in enumerate(np.linspace(430, 670, 24)):
        files.append(folder / f"led{i}.csv")
        rows = "".join(f"{w},{np.exp(-0.5 * ((w - peak) / 9) ** 2):.9f}\n" for w in WAVELENGTHS)
        files[-1].write_text("wavelength_nm,power\n" + rows, encoding="utf-8")
    calls = {n: lambda n=n: command(context.bin_folder / "lutgen", "stage", "match", "--target", "D65", "--emitters",
                                    *files[::24 // n][:n], "--method", "mrm", "--json", folder / "match.json")
             for n in (3, 6, 12, 24)}
    return interleaved_medians(calls, 3)


def patches(context, folder):
    generator = np.random.default_rng(5)
    calls = {}
    for count in (24, 240, 2400, 9600):
        at = folder / f"p{count}"
        at.mkdir(exist_ok=True)
        for name in ("red", "green", "blue", "target"):
            rows = "".join(f"p{i},{r:.6f},{g:.6f},{b:.6f}\n" for i, (r, g, b) in
                           enumerate(generator.random((count, 3)) * 0.8 + 0.05))
            (at / f"{name}.csv").write_text("patch,R,G,B\n" + rows, encoding="utf-8")
        (at / "stage.yaml").write_text(
            "metamer_stage: 1\nprimaries: {red: [0.82, 0.09, 0.01], green: [0.31, 0.90, 0.12], blue: [0.02, 0.14, 0.88]}\n"
            "charts: {red: red.csv, green: green.csv, blue: blue.csv, target: target.csv}\n"
            "calibration_square: {width_m: 1, height_m: 1, distance_m: 1}\nenvironment: {white: [1.1, 1.0, 0.8]}\n"
            "black_level: [0, 0, 0]\nq: {preserve_white: false, white_patch: p0}\n", encoding="utf-8")
        calls[count] = lambda at=at: command(context.bin_folder / "lutgen", "stage", "solve", at / "stage.yaml", "-o",
                                             at / "stage.json")
    return interleaved_medians(calls, 3)


def threads(context, folder):
    import imageio.v3 as imageio

    source = folder / "picture.tif"
    imageio.imwrite(source, np.tile(peers.photograph("coffee")[::2, ::2, :3], (2, 2, 1)).astype(np.float32))
    recipe = folder / "t.yaml"
    recipe.write_text("metamer: 1\nname: t\nspace: ACEScg\ninput: {illuminant: D65}\noutput: {illuminant: HP1}\n",
                      encoding="utf-8")
    calls = {n: lambda n=n: command(context.bin_folder / "lutgen", "apply", recipe, source, folder / "out.exr", "--threads",
                                    n) for n in (1, 2)}
    return interleaved_medians(calls, 3)


def scene_emitters(context, folder):
    """Small triangles that all light a wall; the whole program, reading the mesh too."""
    generator = np.random.default_rng(6)
    calls = {}
    for count in (100, 1_000, 10_000, 100_000):
        corners = generator.uniform([-2, 0, 0.5], [2, 3, 1], (count, 1, 3)) + 3e-3 * np.array([[0, 0, 0], [0, 1, 0], [1, 0, 0]])
        lines = [f"v {a:.6f} {b:.6f} {c:.6f}" for a, b, c in corners.reshape(-1, 3)]
        lines += [f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}" for i in range(count)]
        (folder / f"many{count}.obj").write_text("\n".join(lines) + "\n", encoding="utf-8")
        scene = folder / f"many{count}.yaml"
        scene.write_text("metamer_scene: 1\nfilm: {width: 48, height: 32}\n"
                         "camera: {origin: [0, 1.5, 6], target: [0, 1.5, 0], up: [0, 1, 0], fov_x: 40}\n"
                         "integrator: {max_depth: 2, wavelengths: 4}\nshapes:\n"
                         "  - rectangle: {center: [0, 1.5, 0], half_u: [2, 0, 0], half_v: [0, 1.5, 0]}\n    diffuse: 0.5\n"
                         f"  - mesh: many{count}.obj\n    emission: LED-B1\n", encoding="utf-8")
        calls[count] = lambda scene=scene: command(context.bin_folder / "spectral_ref", "render", scene, "-o",
                                                   folder / "many.exr", "--spp", 64)
    return interleaved_medians(calls, 3)


MEASURES = {"pixels of a picture": picture_size, "nodes of a cube": cube_size, "recipes in a config": recipes,
            "emitters of a lamp (MRM)": emitters, "emitters of a rendered scene": scene_emitters,
            "patches of a stage's chart": patches, "threads (exact engine)": threads}


def run(context):
    rows = []
    for what, measure in MEASURES.items():
        with tempfile.TemporaryDirectory() as folder:
            times = measure(context, Path(folder))
        sizes = list(times)
        half = sizes[len(sizes) // 2 - (len(sizes) % 2 == 0):] if len(sizes) > 2 else sizes
        rows.append({"what": what, "seconds": {str(k): v for k, v in times.items()},
                     "exponent": exponent(half, [times[k] for k in half])})
    return rows


def markdown(results):
    lines = ["| what grows | seconds at each size | exponent |", "| --- | --- | --- |"]
    for r in results:
        cells = ", ".join(f"{int(k):,}: {v:.3g}" for k, v in r["seconds"].items())
        lines.append(f"| {r['what']} | {cells} | {r['exponent']:.2f} |")
    return lines
