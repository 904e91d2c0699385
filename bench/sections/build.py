# SPDX-License-Identifier: Apache-2.0
"""Build of the homogeneous map, one core."""

import itertools
import statistics

from peers import PAIRS


def run(context):
    rows = []
    for pair, scene in itertools.product(PAIRS, ("natural", "smooth")):
        handles = [context.door.open(*pair, scene) for _ in range(3)]
        rows.append({"pair": "->".join(pair), "scene": scene, "seconds": statistics.median(
            context.door.library.metamerBuildSeconds(h) for h in handles)})
        for handle in handles:
            context.door.close(handle)
    return rows


def markdown(results):
    return ["| lights | scene | build, s |", "| --- | --- | --- |"] + [
        f"| {r['pair']} | {r.get('scene', 'smooth')} | {r['seconds']:.2f} |" for r in results]
