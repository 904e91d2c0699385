# SPDX-License-Identifier: Apache-2.0
"""One look for all plots."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def figure(vertical, horizontal):
    drawing, axes = plt.subplots(figsize=(7.2, 4.6), layout="constrained")
    axes.set_ylabel(vertical)
    axes.set_xlabel(horizontal)
    axes.grid(True, which="both", color="0.92")
    axes.set_axisbelow(True)
    return drawing, axes


def save(drawing, axes, path):
    axes.legend(fontsize=8, framealpha=0.9)
    # No dates or versions inside: the same figures give the same file.
    drawing.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(drawing)
