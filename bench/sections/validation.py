# SPDX-License-Identifier: Apache-2.0
"""lutgen validate: scenes rendered under both lights, and what the transform makes of them."""

import json
import subprocess
import tempfile
from pathlib import Path

LIGHTS = (("D65", "A"), ("D65", "HP1"), ("D65", "LED-RGB1"))


def run(context):
    rows = []
    for source, destination in LIGHTS:
        with tempfile.TemporaryDirectory() as folder:
            recipe, report = Path(folder) / "r.yaml", Path(folder) / "r.json"
            recipe.write_text(f"metamer: 1\nname: r\nspace: ACEScg\ninput: {{illuminant: {source}}}\n"
                              f"output: {{illuminant: {destination}}}\n", encoding="utf-8")
            subprocess.run([context.bin_folder / "lutgen", "validate", recipe, "--json", report, "--tolerance", "100"],
                           check=True, stdout=subprocess.DEVNULL)
            result = json.loads(report.read_text(encoding="utf-8"))
        for scene in (*result["scenes"], result["led_wall"]):
            scene.pop("patches")
        rows.append({"pair": f"{source}->{destination}", "scenes": result["scenes"], "led_wall": result["led_wall"]})
    return rows


def markdown(results):
    lines = ["Mean CIEDE2000 over patches. Total: the baked transform (a `.ctf`, exposure-invariant) against the render under the "
             "output light. Engine: the exact engine in its place. What is named: metamerism (the patch's own spectrum is not the "
             "smoothest one; computed from spectra, no render), interreflection (the engine in the box, beyond metamerism), "
             "representation (the file against the engine), noise (95 % interval of the renders).", "",
             "| lights | scene | total | beyond noise | engine | metamerism | interreflection | representation | noise |",
             "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    for row in results:
        for s in row["scenes"]:
            between = f"{s['interreflection']:.3f}" if "interreflection" in s else ""
            lines.append(f"| {row['pair']} | {s['name']} | {s['total']:.3f} | {s['beyond_noise']:.3f} | {s['engine']:.3f} "
                         f"| {s['metamerism']:.3f} | {between} | {s['representation']:.3f} | {s['noise']:.3f} |")
    lines += ["", "A chart inside an RGB LED wall against the same chart in the input light, seen by the input's observer:", "",
              "| real place | M alone | M, Q, N | noise | chart predicted within | background kept within |",
              "| --- | --- | --- | --- | --- | --- |"]
    wall = results[0]["led_wall"]
    lines.append(f"| {results[0]['pair'].split('->')[0]} | {wall['driven_only']:.3f} | {wall['corrected']:.3f} "
                 f"| {wall['noise']:.3f} | {wall['prediction_error']:.3f} | {wall['frustum_error']:.1e} |")
    return lines
