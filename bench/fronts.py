# SPDX-License-Identifier: Apache-2.0
"""The two fronts as one picture: transforms, error against time per pixel; the renderer, noise against time, one scene per panel."""

import importlib

PICTURE = "fronts.png"
CAPTION = ("Above: error of every file and table against its time per pixel. Below: the renderer's noise against time, one scene per panel. Further left is "
           "faster, further down is better; all scales are logarithmic.")


def sources(results):
    """What the picture is drawn from: {section: figures}, nothing where no transforms were measured."""
    if "transforms" not in results:
        return {}
    found = {"transforms": results["transforms"]["figures"]}
    if "renderer" in results:
        found["renderer"] = results["renderer"]["figures"]["noise"]
    return found


def draw(results, path):
    """Writes the picture; False where there is nothing to draw."""
    from plotting import sheet, write

    data = sources(results)
    if not data:
        return False
    scenes = data.get("renderer", [])
    drawing, top, below = sheet(len(scenes))
    importlib.import_module("sections.transforms").draw(data["transforms"], top)
    for row, axes in zip(scenes, below):
        importlib.import_module("sections.renderer").draw(row, axes)
    write(drawing, [top, *below], path, named=[top, *below[:1]])
    return True
