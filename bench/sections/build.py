# SPDX-License-Identifier: Apache-2.0
"""Build of the homogeneous map, one core."""

import statistics

from peers import PAIRS


def run(context):
    rows = []
    for pair in PAIRS:
        handles = [context.door.open(*pair) for _ in range(3)]
        rows.append({"pair": "->".join(pair), "seconds": statistics.median(
            context.door.library.metamerBuildSeconds(h) for h in handles)})
        for handle in handles:
            context.door.close(handle)
    return rows


def markdown(results):
    return ["| lights | build, s |", "| --- | --- |"] + [f"| {r['pair']} | {r['seconds']:.2f} |" for r in results]
