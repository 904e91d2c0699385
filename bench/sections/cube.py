# SPDX-License-Identifier: Apache-2.0
"""Cubes baked by lutgen, certificate included: fitted (behind a 1-D shaper and without) and sampled, seconds and error inside
the gamut within ±7 stops."""

import json
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

PAIRS = (("D65", "A"), ("D65", "HP1"), ("D65", "FL11"))
SIZES = (33, 65)
KINDS = (("fitted, 1-D shaper", ("--format", "resolve_cube")), ("fitted", ()), ("sampled", ("--sampled",)))


def run(context):
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for pair in PAIRS:
            for size in SIZES:
                for kind, options in KINDS:
                    file, seconds = Path(folder) / f"{kind}.cube", []
                    for _ in range(3):
                        start = time.perf_counter()
                        subprocess.run([context.bin_folder / "lutgen", "bake", "--illuminant-in", pair[0],
                                        "--illuminant-out", pair[1], "--size", str(size), *options, "-o", file],
                                       check=True, stdout=subprocess.DEVNULL)
                        seconds.append(time.perf_counter() - start)
                    error = json.loads(Path(str(file) + ".json").read_text(encoding="utf-8"))["error"]
                    rows.append({"pair": "->".join(pair), "size": size, "kind": kind,
                                 "seconds": statistics.median(seconds), "p99": error["p99"], "max": error["max"]})
    return rows


def markdown(results):
    lines = ["Wall seconds of `lutgen bake`, with the map's build and the certificate's own measurement, and the certificate's "
             "figures.", "", "| lights | nodes | | s | p99 | max |", "| --- | --- | --- | --- | --- | --- |"]
    return lines + [f"| {r['pair']} | {r['size']}³ | {r['kind']} | {r['seconds']:.2f} | {r['p99']:.2f} | {r['max']:.1f} |"
                    for r in results]
