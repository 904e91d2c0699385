# SPDX-License-Identifier: Apache-2.0
"""Uplifts side by side: measured skins from their colours in daylight (figure 1.3 of the course notes), and time."""

import ctypes
import sys
import time
import warnings

import numpy as np

LIGHTS = ("D65", "A", "FL11", "HP1", "LED-RGB1")
SHOWN = ("D65", "FL11")
# Name, wanted nanoseconds, colours, rounds: random in Rec.709's cube.
TIMED = (("meng", None, 200, 3), ("mallett", 30, 20_000, 20), ("smits", 100, 20_000, 20), ("jakob", 5000, 4_000, 5),
         ("jakob table", None, 20_000, 20), ("otsu", 100, 20_000, 20))
SCENES = ("smooth", "natural", "skin")
RGB_OF_REC709 = np.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]])
DOMAIN = np.arange(380, 781.0)


def peers(rgb):
    """colour-science's: how many are enough for a time, and a call."""
    import colour

    recovery = colour.recovery
    cmfs = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(colour.SpectralShape(380, 780, 5))
    light = colour.SDS_ILLUMINANTS["D65"].copy().align(cmfs.shape)
    xyz = colour.RGB_to_XYZ(rgb[:50], "sRGB")
    return {"smits": (50, lambda i: recovery.RGB_to_sd_Smits1999(rgb[i])),
            "mallett": (50, lambda i: recovery.RGB_to_sd_Mallett2019(rgb[i])),
            "otsu": (20, lambda i: recovery.XYZ_to_sd_Otsu2018(xyz[i])),
            "jakob": (5, lambda i: recovery.XYZ_to_sd_Jakob2019(xyz[i], cmfs, light)),
            "meng": (2, lambda i: recovery.XYZ_to_sd_Meng2015(xyz[i], cmfs, light))}


def times(context, metamer):
    door = ctypes.CDLL(str(context.bin_folder.parent / "lib" / "libmetamer_uplift_door.so"))
    for function in (door.metamerUpliftTime, door.metamerUpliftLookupTime):
        function.restype = ctypes.c_double
    rgb = np.ascontiguousarray(np.random.default_rng(1).uniform(size=(200_000, 3)))
    pointer, rows, theirs = rgb.ctypes.data_as(ctypes.c_void_p), [], peers(rgb)
    for name, asked, colours, rounds in TIMED:
        row = {"method": name, "ns": door.metamerUpliftTime(name.encode(), pointer, ctypes.c_size_t(colours), rounds)}
        if asked:
            row["asked"] = asked
        if name in theirs:
            count, call = theirs[name]
            start = time.perf_counter()
            for i in range(count):
                call(i)
            row["peer"] = (time.perf_counter() - start) / count * 1e9
        rows.append(row)
    seconds = ctypes.c_double()
    lookup = door.metamerUpliftLookupTime(pointer, ctypes.c_size_t(200_000), 10, ctypes.byref(seconds))
    rows.append({"method": "jakob table, coefficients", "ns": lookup, "asked": 60})
    for name in SCENES:
        uplift, least = metamer.Uplift(name), np.inf
        for _ in range(5):
            start = time.perf_counter()
            uplift(rgb[:20_000])
            least = min(least, time.perf_counter() - start)
        rows.append({"method": name, "ns": least / 20_000 * 1e9})
    return rows, seconds.value


def on_domain(spectrum, held=True):
    ends = {} if held else {"left": 0, "right": 0}
    return np.interp(DOMAIN, spectrum.wavelengths, spectrum.values, **ends)


def skins(metamer):
    library = metamer.Library()
    curves = np.array([on_domain(curve) for curve in library.observer("CIE 1931 2").curves])
    measured = library.reflectances("skin")
    truth = np.array([on_domain(skin) for skin in measured])

    def lab(spectra, light):
        weights = curves * on_domain(library.illuminant(light), held=False)
        xyz = spectra @ (weights / weights[1].sum()).T
        white = weights.sum(axis=1) / weights[1].sum()
        return np.array([metamer.lab(one, white) for one in xyz])

    def shown(values):
        """sRGB codes of CIELAB, white to white."""
        l, a, b = values
        f = np.array([(l + 16) / 116 + a / 500, (l + 16) / 116, (l + 16) / 116 - b / 200])
        xyz = np.where(f > 6 / 29, f**3, 3 * (6 / 29) ** 2 * (f - 4 / 29)) * (0.95047, 1, 1.08883)
        rgb = np.clip(RGB_OF_REC709 @ xyz, 0, 1)
        return [int(v) for v in np.round(255 * np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * rgb ** (1 / 2.4) - 0.055))]

    weights = curves * on_domain(library.illuminant("D65"), held=False)
    given = truth @ (weights / weights[1].sum()).T
    found = {"skins": [skin.name for skin in measured], "rows": [],
             "measured": {light: [shown(one) for one in lab(truth, light)] for light in SHOWN}}
    for method in ("meng", "mallett", "smits", "jakob", "otsu", *SCENES):
        uplift = metamer.Uplift(method)
        spectra = uplift(np.linalg.solve(uplift.xyz_from_rgb, given.T).T)
        spectra = np.array([np.interp(DOMAIN, uplift.wavelengths, one) for one in spectra])
        row = {"method": method, "rms": float(np.sqrt(np.mean((spectra - truth) ** 2))), "lights": {}, "codes": {}}
        for light in LIGHTS:
            there, wanted = lab(spectra, light), lab(truth, light)
            row["lights"][light] = float(np.mean([metamer.delta_e_2000(x, y) for x, y in zip(there, wanted)]))
            if light in SHOWN:
                row["codes"][light] = [shown(one) for one in there]
        found["rows"].append(row)
    return found


def run(context):
    warnings.simplefilter("ignore")
    sys.path.insert(0, str(context.bin_folder.parent / "python"))
    import metamer

    rows, seconds = times(context, metamer)
    return {"times": rows, "table_seconds": seconds, "skin": skins(metamer)}


def markdown(results):
    found = results["skin"]
    lines = [f"Measured skins ({', '.join(found['skins'])}) from their colours under D65: mean CIEDE2000 under other lights, and how far the "
             "spectrum is off. natural and skin hold these skins among their measured ones; the others have not seen them.", "",
             "| method | " + " | ".join(LIGHTS) + " | rms of the spectrum |", "| --- |" + " --- |" * (len(LIGHTS) + 1)]
    for row in found["rows"]:
        lines.append(f"| {row['method']} | " + " | ".join(f"{row['lights'][light]:.2f}" for light in LIGHTS) + f" | {row['rms']:.3f} |")
    lines += ["", "Time of a whole spectrum, one core:", "", "| method | ns per colour | goal | colour-science |", "| --- | --- | --- | --- |"]
    for row in results["times"]:
        lines.append(f"| {row['method']} | {row['ns']:,.0f} | {row.get('asked', '')} | {row['peer']:,.0f} |" if "peer" in row else
                     f"| {row['method']} | {row['ns']:,.0f} | {row.get('asked', '')} | |")
    return lines + ["", f"Jakob's table is built in {results['table_seconds']:.1f} s."]


def plot(results, path):
    """Figure 1.3: each skin as measured on the left, by each method in strips on the right; a row a light."""
    from plotting import plt

    found = results["skin"]
    count = len(found["skins"])
    drawing, panels = plt.subplots(len(SHOWN), count, figsize=(3.4 * count, 3.3 * len(SHOWN)), layout="constrained", squeeze=False)
    for light, row in zip(SHOWN, panels):
        for index, axes in enumerate(row):
            picture = np.zeros((len(found["rows"]), 2, 3), np.uint8)
            picture[:, 0] = found["measured"][light][index]
            for strip, method in enumerate(found["rows"]):
                picture[strip, 1] = method["codes"][light][index]
            axes.imshow(picture, aspect="auto", interpolation="nearest", extent=(0, 2, len(found["rows"]), 0))
            for strip, method in enumerate(found["rows"]):
                axes.text(1.95, strip + 0.5, method["method"], ha="right", va="center", fontsize=7, color="white")
            axes.text(0.06, 0.5, "measured", ha="left", va="center", fontsize=7, color="white")
            axes.set_title(f"{found['skins'][index]}, {light}", fontsize=9)
            axes.set_axis_off()
    # No dates or versions inside: the same figures give the same file.
    drawing.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(drawing)
