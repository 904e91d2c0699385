# SPDX-License-Identifier: Apache-2.0
"""The front: error against time per pixel of every representation, each through what runs it."""

import subprocess
import tempfile
from pathlib import Path

import numpy as np
import PyOpenColorIO as ocio

import defaults
import peers
import words
from door import Engine, Map
from timing import interleaved, spread

MAP_TOLERANCES = (0.03, 0.09, 0.3, 1.0)
EXACT_BANDS = (81, 161, 251)
CHAIN_SIZES = (17, 33, 65, 129)
CUBE_SIZES = (17, 33, 65)
CUBE_KINDS = (("fitted 1-D shaper + cube", ("--format", "resolve_cube")), ("fitted cube", ()), ("sampled cube", ("--sampled",)))


def bake(context, pair, folder, name, *options):
    file = Path(folder) / name
    subprocess.run([context.bin_folder / "lutgen", "bake", "--illuminant-in", pair[0], "--illuminant-out", pair[1],
                    "--space", "ACEScg", *options, "-o", file], check=True, stdout=subprocess.DEVNULL)
    return file


def candidates_of(context, pair, handle, folder):
    """{label: (family, bytes of its table or file, call on (source, destination))}"""
    door = context.door

    def exact(rgb):
        return door.exact(handle, rgb, converged=False)

    matrix = peers.matrix(exact)
    made = {"matrix": ("matrix", 9 * 4, lambda s, d: peers.run_ocio(matrix, s, d))}
    engine = Engine(door, *pair, 251)
    for tolerance in MAP_TOLERANCES:
        table = Map(engine, tolerance)
        made[f"map {tolerance:g}"] = ("homogeneous map", table.bytes, table.run)
    older = context.older_ocio
    for size in CHAIN_SIZES:
        file = bake(context, pair, folder, f"chain{size}.ctf", "--size", str(size))
        newest = peers.file_processor(file, False)
        made[f"chain {size}, OCIO {ocio.__version__}"] = (
            f"chain, OCIO {ocio.__version__}", file.stat().st_size, lambda s, d, p=newest: peers.run_ocio(p, s, d))
        made[f"chain {size}, OCIO {older.version}"] = (f"chain, OCIO {older.version}", file.stat().st_size,
                                                       older.file(file, False))
    for size in CUBE_SIZES:
        for kind, options in CUBE_KINDS:
            file = bake(context, pair, folder, f"{kind.replace(' ', '_')}{size}.cube", "--size", str(size), *options)
            newest = peers.file_processor(file, True)
            made[f"{kind} {size}, OCIO {ocio.__version__}"] = (
                f"{kind}, OCIO {ocio.__version__}", file.stat().st_size, lambda s, d, p=newest: peers.run_ocio(p, s, d))
            made[f"{kind} {size}, OCIO {older.version}"] = (f"{kind}, OCIO {older.version}", file.stat().st_size,
                                                            older.file(file, True))
    return made


def run(context):
    door, rows = context.door, []
    picture = peers.photograph("astronaut")[::2, ::2].copy()
    destination = np.empty_like(picture)
    pixels = picture.size // 4
    for pair in peers.PAIRS[:3]:
        handle = door.open(*pair)
        with tempfile.TemporaryDirectory() as folder:
            candidates = candidates_of(context, pair, handle, folder)
            times = interleaved({k: (lambda r=r: r(picture, destination)) for k, (*_, r) in candidates.items()},
                                context.rounds)
            for label, (family, size, call) in candidates.items():
                rows.append({"pair": "->".join(pair), "label": label, "family": family, "bytes": size,
                             "nanoseconds_per_pixel": float(np.median(times[label])) / pixels * 1e9,
                             "noise": spread(times[label]), "error": peers.protocol_errors(door, handle, call)})
        # The engine is too slow for a whole picture: a sample of its pixels.
        sample = picture[::9, ::9, :3].reshape(-1, 3).astype(np.float64)
        for bands in EXACT_BANDS:
            engine = Engine(door, *pair, bands)
            seconds = min(engine.apply(sample)[1] for _ in range(3))

            def call(s, d, engine=engine):
                d[...] = s
                d[..., :3] = engine.apply(s[..., :3].astype(np.float64))[0].reshape(s[..., :3].shape)

            rows.append({"pair": "->".join(pair), "label": f"exact engine {bands}", "family": "exact engine", "bytes": 0,
                         "nanoseconds_per_pixel": seconds / len(sample) * 1e9, "noise": 0.0,
                         "error": peers.protocol_errors(door, handle, call)})
        door.close(handle)
    return rows


def markdown(results):
    lines = ["CIEDE2000 by the error protocol: all probes over ±10 stops, and those inside the gamut within ±7 stops (what a "
             "cube with a log shaper can hold). kB: of the file, or of the map's tables.", ""]
    for pair in dict.fromkeys(r["pair"] for r in results):
        lines += [pair, "", "| representation | kB | ns/pixel | noise | mean | p99 | max | p99 inside | max inside |",
                  "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
        for r in (r for r in results if r["pair"] == pair):
            every, inside = r["error"]["all"], r["error"]["inside"]
            lines.append(f"| {r['label']} | {r['bytes'] / 1000:,.0f} | {r['nanoseconds_per_pixel']:.1f} | ±{r['noise']:.0%} | {every['mean']:.3f} "
                         f"| {every['p99']:.3f} | {every['max']:.2f} | {inside['p99']:.3f} | {inside['max']:.2f} |")
        lines.append("")
    return lines + defaults.markdown(results)


def draw(results, axes):
    """The front of the first pair of lights."""
    pair = results[0]["pair"]
    for family in dict.fromkeys(r["family"] for r in results):
        rows = [r for r in results if r["pair"] == pair and r["family"] == family]
        axes.loglog([r["nanoseconds_per_pixel"] for r in rows], [max(r["error"]["inside"]["p99"], 1e-3) for r in rows],
                    "o-" if len(rows) > 1 else "s", label=words.plain(family))
    axes.set_ylabel("CIEDE2000, p99 inside the gamut within ±7 stops")
    axes.set_xlabel(f"ns per pixel, one core ({pair})")


def plot(results, path):
    from plotting import figure, save

    drawing, axes = figure("", "")
    draw(results, axes)
    save(drawing, axes, path)
