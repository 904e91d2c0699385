# SPDX-License-Identifier: Apache-2.0
"""One look for all plots."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import NullFormatter  # noqa: E402


def figure(vertical, horizontal):
    drawing, axes = plt.subplots(figsize=(7.2, 4.6), layout="constrained")
    axes.set_ylabel(vertical)
    axes.set_xlabel(horizontal)
    return drawing, axes


def sheet(panels):
    """A drawing, a wide panel, and below it a row of this many."""
    if panels == 0:
        drawing, axes = plt.subplots(figsize=(9, 4.8), layout="constrained")
        return drawing, axes, []
    below = [f"panel {i}" for i in range(panels)]
    drawing, axes = plt.subplot_mosaic([["top"] * panels, below], figsize=(9, 7.6), layout="constrained",
                                       height_ratios=[1.3, 1])
    return drawing, axes["top"], [axes[name] for name in below]


def row_of(panels):
    """A drawing and a row of this many panels."""
    drawing, axes = plt.subplots(1, panels, figsize=(3.7 * panels, 3.9), layout="constrained", squeeze=False)
    return drawing, list(axes[0])


def save(drawing, axes, path):
    write(drawing, [axes], path)


def write(drawing, panels, path, named=None):
    """Writes the drawing. named: the panels that say which line is which; all without it."""
    for axes in panels:
        axes.grid(True, which="both", color="0.92")
        axes.set_axisbelow(True)
        for axis in (axes.xaxis, axes.yaxis):
            if axis.get_scale() == "log":
                axis.set_minor_formatter(NullFormatter())
        if named is None or axes in named:
            axes.legend(fontsize=8 if len(panels) == 1 else 6, framealpha=0.9)
    # No dates or versions inside: the same figures give the same file.
    drawing.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(drawing)
