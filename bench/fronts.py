# SPDX-License-Identifier: Apache-2.0
"""The two fronts as one picture: transforms, error against time a pixel; the renderer, noise against time, a scene a panel.

The renderer's panels come from its section's `curves`: [{scene, method, points: [[seconds, mean square error], ...]}].
"""

import importlib

PICTURE = "fronts.png"


def sources(results):
    """What the picture is drawn from: {section: figures}, nothing where no transforms were measured."""
    if "transforms" not in results:
        return {}
    found = {"transforms": results["transforms"]["figures"]}
    curves = results.get("renderer", {}).get("figures", {})
    if isinstance(curves, dict) and curves.get("curves"):
        found["renderer"] = curves["curves"]
    return found


def draw(results, path):
    """Writes the picture; False where there is nothing to draw."""
    from plotting import sheet, write

    data = sources(results)
    if not data:
        return False
    curves = data.get("renderer", [])
    scenes = list(dict.fromkeys(curve["scene"] for curve in curves))
    drawing, top, below = sheet(len(scenes))
    importlib.import_module("sections.transforms").draw(data["transforms"], top)
    for scene, axes in zip(scenes, below):
        for curve in (c for c in curves if c["scene"] == scene):
            seconds, errors = zip(*curve["points"])
            axes.loglog(seconds, errors, "o-", markersize=3, label=curve["method"])
        axes.set_title(scene, fontsize=9)
        axes.set_xlabel("seconds")
        axes.set_ylabel("mean square error of Y")
    write(drawing, [top, *below], path)
    return True
