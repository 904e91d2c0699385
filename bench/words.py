# SPDX-License-Identifier: Apache-2.0
"""Words before the figures: what each section of the pages says, in plain English, with the few figures that it hangs on."""

import re


def _by_label(figures, label):
    return [row for row in figures if row["label"].startswith(label)]


def _worst(rows, colours, statistic):
    return max(row["error"][colours][statistic] for row in rows)


def _transforms(figures):
    ctf = [row for row in _by_label(figures, "chain 65") if row["family"] == figures_newest(figures)]
    table, cube, matrix = (_by_label(figures, label) for label in ("map 0.09", "fitted 1-D shaper + cube 33", "matrix"))
    return (f"The exposure-invariant file, `.ctf` of 65 nodes, is off by more than {_worst(ctf, 'all', 'p99'):.2f} CIEDE2000 at no more than one in a "
            f"hundred of all colours over ±10 stops, under the worst of these lights, and costs {_nanoseconds(ctf)} ns per pixel. The map of the "
            f"plug-in: {_worst(table, 'all', 'p99'):.2f}, at {_nanoseconds(table)} ns. A cube of 33 nodes behind a 1-D shaper holds "
            f"{_worst(cube, 'inside', 'p99'):.2f} inside the gamut within ±7 stops, and clips what lies beyond. A matrix, which is all that a white "
            f"balance does: {_worst(matrix, 'inside', 'p99'):.0f}.")


def figures_newest(figures):
    """The family of exposure-invariant files in the newest OpenColorIO: the first measured."""
    return next(row["family"] for row in figures if row["family"].startswith("chain, "))


def _nanoseconds(rows):
    least, most = (f(row["nanoseconds_per_pixel"] for row in rows) for f in (min, max))
    return f"{least:.0f}" if round(least) == round(most) else f"{least:.0f} to {most:.0f}"


def _bands(figures):
    at = {bands: max(row["p99"] for row in figures if row["bands"] == bands) for bands in (41, 81, 251)}
    return ("A spectrum is computed at a number of wavelengths, its bands. Few bands miss the narrow lines of discharge lamps. Against 401 bands, "
            f"under the worst of these lights, p99 is {at[41]:.1f} at 41 bands, {at[81]:.1f} at 81 and {at[251]:.2f} at 251.")


def _uplifts(figures):
    mean = {row["method"]: sum(row["lights"].values()) / len(row["lights"]) for row in figures["skin"]["rows"]}
    return ("Skin is where a wrong spectrum is seen first. Each published way of finding a reflectance for a colour is tried on measured skins, "
            f"under lights that it was not made for. Mean over the lights: `natural` {mean['natural']:.2f} CIEDE2000, `smooth` {mean['smooth']:.2f}, the "
            f"best of the others {min(mean[m] for m in ('meng', 'mallett', 'smits', 'jakob', 'otsu')):.2f}.")


def _robustness(figures):
    rows = [row for row in figures["engine"] if row["scene"] == "natural"]
    worst = max(row["gain"]["photographs"]["max"] for row in rows)
    return ("A transform that stretches small differences makes noise visible and breaks up neon. Gain is that stretch: 1 leaves noise as it was. "
            f"Scene `natural` stays below {worst:.1f} on photographs, whichever two lights.")


def _validation(figures):
    smooth = max(s["beyond_noise"] for row in figures for s in row["scenes"] if s["name"] == "smooth objects")
    return ("The reference renderer shows a scene under both lights; the transform has only the first picture and has to make the second. Where objects "
            f"are what the engine takes them for, it is right within {smooth:.3f} CIEDE2000. What remains is named: materials that no picture tells "
            "apart (metamerism), and light that bounces between them (interreflection).")


def _kernel(figures):
    ratios = [c["map_is_faster_by"] for row in figures["rows"] for name, c in row["candidates"].items() if name == "OCIO log + 33^3"]
    return (f"What the plug-in runs per pixel is {min(ratios):.1f} to {max(ratios):.1f} times as fast as a cube of 33 nodes behind a logarithm in OpenColorIO, "
            "and hundreds of times nearer to the truth.")


def _ofx(figures):
    rates = [row["frames_per_second"]["metamer.ofx"] for row in figures["rows"]]
    return (f"Spectral Transfer makes {min(rates):.0f} to {max(rates):.0f} UHD frames per second on two threads of a server's processor. A new light takes a "
            "few hundredths of a second to the first frame.")


def _gpu(figures):
    rows = {row["file"]: row for row in figures["files"]}
    return ("What a machine without a graphics card can say of them: the plug-in's kernel on a driver for processors, and files through OpenColorIO's "
            f"shader. Where a viewer keeps tables as halves, a .ctf is off by {rows['.ctf']['half_textures']['p99']:.2f} at p99 in place of "
            f"{rows['.ctf']['error']['p99']:.2f}; a .clf by {rows['.clf']['half_textures']['p99']:.2f}, in place of {rows['.clf']['error']['p99']:.2f}.")


def _apply(figures):
    return (f"Relighting a sequence takes about as long as copying it: {figures['apply_seconds']:.1f} s beside {figures['copy_seconds']:.1f} s for "
            f"{figures['frames']} HD frames.")


def _cube(figures):
    fitted = [row for row in figures if row["size"] == 33 and row["kind"] == "fitted, 1-D shaper"]
    sampled = [row for row in figures if row["size"] == 33 and row["kind"] == "sampled"]
    return (f"A cube of 33 nodes is written in {max(row['seconds'] for row in fitted):.1f} s. Fitting its nodes, in place of writing the transform's values "
            f"at them, brings p99 from {max(row['p99'] for row in sampled):.1f} to {max(row['p99'] for row in fitted):.1f}.")


def _hard_cases(figures):
    return f"{sum(row['as_it_should'] for row in figures)} of {len(figures)} come out as they should: lasers, empty filters, torn files, full disks."


OPENINGS = {
    "solver": "Time to find the smoothest spectrum of one colour, in microseconds (µs): with reflectance held above 0, and between 0 and 1.",
    "build": "Time to make the fast table (the map) for two lights, once per recipe.",
    "kernel": _kernel,
    "releases": "The OpenColorIO that metamer links runs the same file several times as fast as the one that Debian 12 has, with the same result.",
    "cube": _cube,
    "transforms": _transforms,
    "bands": _bands,
    "recovery": "Other published ways from a colour to a reflectance, in the same place: 24 patches whose spectra are known.",
    "uplifts": _uplifts,
    "storage": "How few numbers hold a spectrum, so that nobody sees the difference.",
    "matching": "One shot under a lamp, brought to daylight: what each scene setting makes of surfaces that were measured. Folds are colours that swap "
                "places, which should be none.",
    "pairs": "Colours whose spectra you give come out exactly; what that does to the others, held out, stands beside it.",
    "balance": "The setting `balanced` of a recipe, right and wrong, for every usual way of balancing a shot. The smallest figure of a row is the right "
               "setting for it.",
    "robustness": _robustness,
    "validation": _validation,
    "stability": "How far the arithmetic may be trusted: condition numbers, single precision, and instruction sets.",
    "compilers": "Two compilers, any number of threads and every instruction set give the same bits.",
    "hard_cases": _hard_cases,
    "growth": "What twice the work costs. An exponent of 1: twice the time; 0: none.",
    "apply": _apply,
    "ofx": _ofx,
    "gpu": _gpu,
    "renderer": "How soon a render is free of noise, beside Mitsuba 3 on the same scenes. MSE: mean square error; ReSTIR: light samples shared between "
                "neighbouring pixels and passes; guided: wavelengths chosen where the light is.",
    "wavelengths": "What choosing wavelengths by the light (guiding) and carrying several per path (lanes) gains.",
}

# What a picture shows, beneath it.
CAPTIONS = {
    "transforms": "Each dot is a file or table of one size: further left is faster, further down is nearer to the exact result. Both scales are logarithmic.",
    "bands": "Error against time per colour, one dot per number of bands, from 16; both scales are logarithmic.",
    "uplifts": "Three measured skins (left half of each square) beside what each way makes of them (right half, top to bottom), under daylight and under a "
               "fluorescent tube. Daylight is where the colour came from: all agree.",
    "storage": "A fluorescent lamp (grey) and what each form keeps of it in few numbers (red).",
    "stability": "Every light of the data: how far apart it keeps colours (right: badly) and how much a small difference grows on its way to daylight (up). Low-pressure "
                 "sodium, LPS, has one colour, and no transform brings the others back.",
    "renderer": "Noise (relative mean square error of luminance Y) against processor seconds: lower and further left is better.",
    "wavelengths": "The share of wavelengths that the renderer should take (grey, black) and what it learnt (red).",
}


def opening(section, figures):
    words = OPENINGS[section]
    return words if isinstance(words, str) else words(figures)


def plain(line):
    """Labels of the runs as a reader knows them: an exposure-invariant file is named by its extension."""
    line = re.sub(r"\bchain of (\d+) nodes", r".ctf of \1 nodes", line)
    return re.sub(r"\bchain (\d+)", r".ctf \1", re.sub(r"^chain, ", ".ctf, ", line))


def folded(lines, summary="The figures"):
    """Behind a fold that a click opens."""
    return ["<details>", f"<summary>{summary}</summary>", "", *lines, "", "</details>"]
