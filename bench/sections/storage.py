# SPDX-License-Identifier: Apache-2.0
"""Spectra in few numbers, by lutgen spectrum pack: what each form costs, and figure 1.2 of the course notes."""

import re
import subprocess
import tempfile
from pathlib import Path

import numpy as np

SURFACES = ("colorchecker", "tm30", "model skins")
FORMS = ("points", "hats", "bytes", "cosines", "moments")
COUNTS = (8, 12, 16, 20)
LIGHT_FORMS = ("points", "hats", "cosines", "moments", "lines")
LIGHT_COUNTS = (12, 20)
# Figure 1.2: a patch lit by a lamp with lines.
PATCH, LAMP, SHOWN = "blue sky", "FL2", 12
DATA = Path(__file__).resolve().parents[2] / "data"


def table(file, name):
    """Wavelengths and one column of a table of data/."""
    lines = [line for line in (DATA / file).read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    column = lines[0].split(",").index(name)
    rows = np.array([[float(cells[0]), float(cells[column])] for cells in (line.split(",") for line in lines[1:]) if cells[column]])
    return rows[:, 0], rows[:, 1]


def run(context):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)

        def lutgen(*arguments):
            return subprocess.run([context.bin_folder / "lutgen", "spectrum", *map(str, arguments)], cwd=folder, check=True,
                                  capture_output=True, text=True).stdout

        def packed(spectra, form, count, *more):
            said = lutgen("pack", *spectra, "-o", "s.json", "--form", form, "--numbers", count, *more)
            found = re.search(r"mean ([\d.]+), worst spectrum ([\d.]+) \((.*)\), largest ([\d.]+) \(", said)
            size = int(re.search(r"at most (\d+) bytes", said)[1])
            return {"form": form, "numbers": count, "bytes": size, "mean": float(found[1]), "worst": float(found[2]), "where": found[3],
                    "largest": float(found[4])}

        surfaces = [packed(SURFACES, form, count) for form in FORMS for count in COUNTS]
        lights = [packed(["all"], form, count, "--use", "light") for form in LIGHT_FORMS for count in LIGHT_COUNTS]
        domain = np.arange(380, 781.0)
        product = np.interp(domain, *table("reflectances/colorchecker.csv", PATCH)) * np.interp(
            domain, *table("illuminants/cie_fl.csv", LAMP), left=0, right=0)
        (folder / "lit.csv").write_text("wavelength_nm,power\n" + "".join(f"{nm:g},{v:.9g}\n" for nm, v in zip(domain, product)))
        curves = {}
        for form in LIGHT_FORMS:
            packed(["lit.csv"], form, SHOWN, "--use", "light")
            lutgen("convert", "s.json", "-o", "s.csv", "--step", 5)
            curves[form] = [float(v) for v in np.loadtxt(folder / "s.csv", delimiter=",", skiprows=1)[:, 1]]
        return {"surfaces": surfaces, "lights": lights, "lit": {"true": [float(v) for v in product[::5]], "curves": curves}}


def markdown(results):
    lines = ["223 reflectances (ColorChecker, TM-30, model skins) under A, FL11, HP1 and LED-RGB1: mean CIEDE2000, and that of the worst "
             "reflectance. Numbers are floats of 4 bytes, those of `bytes` 1.", "",
             "| form | " + " | ".join(f"{count} numbers" for count in COUNTS) + " |", "| --- |" + " --- |" * len(COUNTS)]

    def cells(rows, form, counts):
        own = {row["numbers"]: row for row in rows if row["form"] == form}
        return " | ".join(f"{own[count]['mean']:.3f} ({own[count]['worst']:.2f})" for count in counts)

    lines += [f"| {form} | {cells(results['surfaces'], form, COUNTS)} |" for form in FORMS]
    lines += ["", "All illuminants of `data/`, the ColorChecker under each: mean, and that of the worst lamp.", "",
              "| form | " + " | ".join(f"{count} numbers" for count in LIGHT_COUNTS) + " |", "| --- |" + " --- |" * len(LIGHT_COUNTS)]
    return lines + [f"| {form} | {cells(results['lights'], form, LIGHT_COUNTS)} |" for form in LIGHT_FORMS]


def plot(results, path):
    """Figure 1.2: a panel a form."""
    from plotting import row_of, write

    drawing, panels = row_of(len(LIGHT_FORMS))
    nm = np.arange(380, 781, 5)
    for form, axes in zip(LIGHT_FORMS, panels):
        axes.plot(nm, results["lit"]["true"], color="0.6", lw=2, label="spectrum")
        axes.plot(nm, results["lit"]["curves"][form], color="tab:red", lw=1.2, label=f"{SHOWN} numbers")
        axes.set_ylim(-0.5, 1.15 * max(results["lit"]["true"]))
        axes.set_title(form, fontsize=9)
        axes.set_xlabel("nm", fontsize=8)
    write(drawing, panels, path, named=panels[:1])
