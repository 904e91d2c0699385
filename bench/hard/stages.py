# SPDX-License-Identifier: Apache-2.0
"""LED stages whose calibration does not say what it should."""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "lutgen"))

from stage_physics import Stage, led, write_chart  # noqa: E402


def _solve(b):
    code, message = b.run("stage", "solve", "stage.yaml", "-o", "out.json")
    return code, message, json.loads((b.folder / "out.json").read_text()) if code == 0 else {}


def collinear_primaries(b):
    stage = Stage()
    stage.primaries[:, 2] = 0.5 * (stage.primaries[:, 0] + stage.primaries[:, 1])
    stage.write(b.folder)
    code, message, _ = _solve(b)
    return code, f"refused: {message}"


def faulty_chart(b):
    """A patch that one chart lacks, one without a value, and two that are saturated."""
    stage = Stage()
    expected = {stage.names[0], stage.names[2], stage.names[15], stage.names[18]}
    stage.target[[15, 18], 0] = stage.target.max() * 1.05
    stage.write(b.folder)
    write_chart(b.folder / "g.csv", stage.names[1:], stage.charts[1][1:])
    text = (b.folder / "t.csv").read_text().splitlines()
    text[3] = text[3].split(",")[0] + ",,0.2,0.3"
    (b.folder / "t.csv").write_text("\n".join(text))
    code, message, result = _solve(b)
    if code != 0:
        return code, message
    left_out = {patch["name"]: patch["reason"] for patch in result["excluded"]}
    # What is left must give what it gives alone.
    kept = [i for i, name in enumerate(stage.names) if name not in expected]
    target, charts = stage.target[kept], [chart[kept] for chart in stage.charts]
    drives = np.linalg.inv(stage.primaries) @ stage.white
    predicted = sum(chart * drive for chart, drive in zip(charts, drives)) / stage.factor
    q = np.linalg.lstsq(predicted, target, rcond=None)[0].T
    difference = float(np.abs(np.array(result["Q"]) - q).max())
    good = set(left_out) == expected and difference < 1e-9
    return int(not good), ("left out and named: " + ", ".join(f"{k} ({v})" for k, v in left_out.items()) +
                           f"; Q of the rest within {difference:.0e} of numpy's")


def rank_one_q(b):
    """A place lit by one wavelength: every patch has one colour there."""
    Stage(led(589, 1.5)).write(b.folder)
    code, message, result = _solve(b)
    if code != 0:
        return code, message
    singular = np.linalg.svd(np.array(result["Q"]))[1]
    good = result["N_bounded"] and np.isfinite(result["N"]).all() and result["dE_after"]["mean"] < result["dE_before"]["mean"]
    return int(not good), (f"Q's singular values {', '.join(f'{s:.2g}' for s in singular)}; N bounded: {result['N_bounded']}, "
                           f"largest entry {np.abs(result['N']).max():.3g}; mean CIEDE2000 {result['dE_before']['mean']:.1f} "
                           f"with M alone, {result['dE_after']['mean']:.1f} with Q and N")
