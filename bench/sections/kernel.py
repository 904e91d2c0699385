# SPDX-License-Identifier: Apache-2.0
"""The map's kernel against OpenColorIO, RGBA float32 1920x1080, linear ACEScg in and out, one core."""

import itertools

import numpy as np
import PyOpenColorIO as ocio

import peers
from timing import interleaved, spread

OURS, CUBE, CUBE_LOG, MATRIX, COPY = ("metamer map", "OCIO log + 33^3", "OCIO log + 33^3 + antilog", "OCIO 3x3 matrix",
                                      "memcpy")


def run(context):
    door, rows = context.door, []
    for name in ("astronaut", "coffee"):
        picture = peers.photograph(name)
        destination = np.empty_like(picture)
        for pair, scene in itertools.product(peers.PAIRS[:4], ("natural", "smooth")):
            handle = door.open(*pair, scene)

            def exact(rgb, handle=handle):
                return door.exact(handle, rgb, converged=False)

            candidates = {OURS: lambda s, d, h=handle: door.map(h, s, d)}
            for label, processor in ((CUBE, peers.sampled_cube(exact, 33, False)),
                                     (CUBE_LOG, peers.sampled_cube(exact, 33, True)), (MATRIX, peers.matrix(exact))):
                candidates[label] = lambda s, d, p=processor: peers.run_ocio(p, s, d)
            candidates[COPY] = door.copy
            times = interleaved({k: (lambda r=r: r(picture, destination)) for k, r in candidates.items()},
                                context.rounds)
            pixels = picture[::3, ::3, :3].reshape(-1, 3)[::7].astype(np.float64)
            truth = door.exact(handle, pixels, converged=True)
            row = {"picture": name, "pair": "->".join(pair), "scene": scene, "candidates": {}}
            for label, seconds in times.items():
                figures = {"megapixels_per_second": picture.size / 4 / float(np.median(seconds)) / 1e6,
                           "noise": spread(seconds),
                           "map_is_faster_by": float(np.median(seconds / times[OURS]))}
                if label != COPY:
                    figures["error"] = peers.protocol_errors(door, handle, candidates[label])
                    source = np.ones((1, len(pixels), 4), np.float32)
                    source[0, :, :3] = pixels
                    output = np.empty_like(source)
                    candidates[label](source, output)
                    figures["picture_p99"] = float(np.quantile(door.delta_e(handle, truth, output[0, :, :3]), 0.99))
                row["candidates"][label] = figures
            rows.append(row)
            door.close(handle)
    return {"ocio": ocio.__version__, "rounds": context.rounds, "rows": rows}


def markdown(results):
    lines = [f"OpenColorIO {results['ocio']}, medians of {results['rounds']} interleaved rounds. Error: p99 CIEDE2000 of the "
             "protocol, of its probes inside the gamut within ±7 stops, and on the picture.", ""]
    for row in results["rows"]:
        lines += [f"{row['picture']}, {row['pair']}, {row.get('scene', 'smooth')}", "",
                  "| | Mpixel/s | noise | map is … times as fast | protocol | inside | picture |",
                  "| --- | --- | --- | --- | --- | --- | --- |"]
        for label, c in row["candidates"].items():
            error = (f"{c['error']['all']['p99']:.3f} | {c['error']['inside']['p99']:.3f} | {c['picture_p99']:.4f}"
                     if "error" in c else " | | ")
            lines.append(f"| {label} | {c['megapixels_per_second']:.0f} | ±{c['noise']:.0%} | {c['map_is_faster_by']:.2f} "
                         f"| {error} |")
        lines.append("")
    return lines
