# SPDX-License-Identifier: Apache-2.0
"""One look for all plots."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


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


def save(drawing, axes, path):
    write(drawing, [axes], path)


def write(drawing, panels, path):
    for axes in panels:
        axes.grid(True, which="both", color="0.92")
        axes.set_axisbelow(True)
        axes.legend(fontsize=8, framealpha=0.9)
    # No dates or versions inside: the same figures give the same file.
    drawing.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(drawing)
