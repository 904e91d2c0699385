# SPDX-License-Identifier: Apache-2.0
"""From the figures in bench.json to tables and plots: out/bench.md, docs/accuracy.md, docs/performance.md.

    script/bench && build/venv/bin/python bench/report.py out/bench.json docs     # publishes a run

Everything written here comes from the JSON alone, so that pages and figures cannot drift apart. docs/bench.json keeps what
the pages show of a run; the run as it was measured goes into release archives.
"""

import argparse
import hashlib
import importlib
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import fronts  # noqa: E402
import targets  # noqa: E402
import words  # noqa: E402

# Section: title, page of docs/ it stands on.
SECTIONS = {
    "solver": ("One smoothest spectrum", "performance"),
    "build": ("Building the homogeneous map", "performance"),
    "kernel": ("The map's kernel beside OpenColorIO", "performance"),
    "releases": ("The linked OpenColorIO beside an older one", "performance"),
    "cube": ("Baking cubes", "performance"),
    "transforms": ("Error against time, every representation", "accuracy"),
    "bands": ("How many bands", "accuracy"),
    "recovery": ("Other recoveries in the same pipeline", "accuracy"),
    "uplifts": ("Uplifts on skin", "accuracy"),
    "storage": ("Spectra in few numbers", "accuracy"),
    "matching": ("Matching shots: robust or accurate", "accuracy"),
    "pairs": ("Colours whose spectra are known", "accuracy"),
    "balance": ("How the shot was balanced", "accuracy"),
    "robustness": ("Gain, energy and pixels of noise", "accuracy"),
    "validation": ("The loop closed", "accuracy"),
    "stability": ("Numerical stability", "accuracy"),
    "compilers": ("Whatever compiled it, and however many threads", "accuracy"),
    "hard_cases": ("Hard cases", "accuracy"),
    "growth": ("How cost grows", "performance"),
    "apply": ("Frames through lutgen apply", "performance"),
    "ofx": ("The OFX plug-in beside OpenColorIO", "performance"),
    "gpu": ("For graphics cards", "performance"),
    "renderer": ("The renderer's noise against time", "performance"),
    "wavelengths": ("The renderer's wavelengths", "performance"),
}
PAGES = {
    "accuracy": ("Accuracy", "What each representation costs and how wrong it is, by the [error protocol](error_protocol.md)."),
    "performance": ("Performance", "Times beside the peers', measured in the same run on the same pixels. Ratios travel "
                                   "between machines; seconds do not."),
}


def section_markdown(name, result, heading, pictures=None):
    """Lines of one section. `pictures`: link prefix of plots, where they are to be shown."""
    section = importlib.import_module(f"sections.{name}")
    lines = ["", "#" * heading + " " + SECTIONS[name][0], "", words.opening(name, result["figures"])]
    if pictures is not None and hasattr(section, "plot"):
        lines += ["", f"![{SECTIONS[name][0]}]({pictures}{name}.png)", "", f"*{words.CAPTIONS[name]}*"]
    lines += ["", *words.folded([words.plain(line) for line in section.markdown(result["figures"])])]
    older = f"Release {result['release']}; " if "release" in result else ""
    return lines + ["", f"*{older}{result['machine']}; OpenColorIO {result['ocio']}; script/bench --only {name}.*"]


def rounded(value):
    """Floats to six significant digits: more is noise of the machine that measured."""
    if isinstance(value, float):
        return float(f"{value:.6g}")
    if isinstance(value, dict):
        return {key: rounded(inner) for key, inner in value.items()}
    return [rounded(inner) for inner in value] if isinstance(value, list) else value


def raw_of(name, figures):
    """(dictionary, key) of each curve that only the section's plot needs, where the figures still hold it."""
    section, found = importlib.import_module(f"sections.{name}"), []
    for path in getattr(section, "RAW", ()):
        *way, last = path.split("/")
        inner = figures
        for step in way:
            inner = inner[step]
        if last in inner:
            found.append((inner, last))
    return found


def published(results):
    """What docs/bench.json keeps of a run: the figures that the pages show."""
    kept = rounded(ordered(results))
    for name, result in kept.items():
        for inner, key in raw_of(name, result["figures"]):
            del inner[key]
    return kept


def published_text(results):
    """A line a row, so that a new run shows as the rows that moved."""
    def lines(value, depth):
        compact = json.dumps(value)
        if len(compact) < 240 or not isinstance(value, (dict, list)):
            return compact
        pad, end = " " * (depth + 1), " " * depth
        if isinstance(value, dict):
            inner = [f"{pad}{json.dumps(key)}: {lines(one, depth + 1)}" for key, one in value.items()]
            return "{\n" + ",\n".join(inner) + f"\n{end}}}"
        return "[\n" + ",\n".join(pad + lines(one, depth + 1) for one in value) + f"\n{end}]"

    return lines(results, 0) + "\n"


def digest(figures):
    """Of what a picture is drawn from."""
    return hashlib.sha256(json.dumps(figures, sort_keys=True).encode()).hexdigest()


def pictures(results):
    """{name without prefix: (the published figures of what it shows, what draws it to a path)}"""
    found, kept = {}, published(results)
    for name in results:
        section = importlib.import_module(f"sections.{name}")
        if hasattr(section, "plot"):
            figures = results[name]["figures"]
            found[f"{name}.png"] = (kept[name]["figures"], lambda path, s=section, f=figures: s.plot(f, path))
    if fronts.sources(results):
        found[fronts.PICTURE] = (fronts.sources(kept), lambda path: fronts.draw(results, path))
    return found


def write_plots(results, folder, prefix):
    """Each picture says in its text "Figures" which figures it shows. Those that need curves of the run are left as they
    are where `results` is what docs/bench.json kept of it."""
    from PIL import Image, PngImagePlugin

    for name, (figures, draw) in pictures(results).items():
        path, section = folder / f"{prefix}{name}", name.removesuffix(".png")
        if section in results and hasattr(importlib.import_module(f"sections.{section}"), "RAW") and not raw_of(
                section, results[section]["figures"]):
            continue
        draw(path)
        text = PngImagePlugin.PngInfo()
        text.add_text("Figures", digest(figures))
        with Image.open(path) as picture:
            picture.load()
        picture.convert("RGB").save(path, pnginfo=text, optimize=True)


def ordered(results):
    return {name: results[name] for name in SECTIONS if name in results}


def write(results, folder):
    """bench.md and its plots."""
    results = ordered(results)
    lines = ["# Speed against error"]
    for name, result in results.items():
        lines += section_markdown(name, result, 2, "bench_")
    lines += ["", *target_markdown(results, list(SECTIONS))]
    (folder / "bench.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    write_plots(results, folder, "bench_")


def target_markdown(results, sections):
    return ["## Goals", "", *targets.verdict(results, sections), "", *words.folded(targets.markdown(results, sections), "All goals")]


def page(results, name):
    """One page of docs/, as text."""
    title, opening = PAGES[name]
    lines = [f"# {title}", "", opening, "", "Written by bench/report.py from [bench.json](bench.json); "
             "`script/bench` measures anew. Tables are folded: a click opens them. At the end: [the goals, and which are missed](#goals)."]
    # Sections that an older release measured say so.
    releases = sorted({result["release"] for result in results.values() if "release" in result})
    if releases:
        lines += ["", f"**What says release {', '.join(releases)} below it is of that release**: the engine has been replaced since "
                  "([engine.md](engine.md)), and it is to be measured anew."]
    if fronts.sources(results):
        lines += ["", f"![The fronts](images/bench_{fronts.PICTURE})", "", f"*{fronts.CAPTION}*"]
    for section, result in ordered(results).items():
        if SECTIONS[section][1] == name:
            lines += section_markdown(section, result, 2, "images/bench_")
    lines += ["", *target_markdown(results, [s for s, (_, where) in SECTIONS.items() if where == name])]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description="Writes the pages of docs/ that show a run, and its figures.")
    parser.add_argument("json", type=Path)
    parser.add_argument("docs", type=Path)
    arguments = parser.parse_args()
    results = ordered(json.loads(arguments.json.read_text(encoding="utf-8")))
    kept = published(results)
    (arguments.docs / "bench.json").write_text(published_text(kept), encoding="utf-8")
    for name in PAGES:
        (arguments.docs / f"{name}.md").write_text(page(kept, name), encoding="utf-8")
    (arguments.docs / "images").mkdir(exist_ok=True)
    write_plots(results, arguments.docs / "images", "bench_")
    return 0


if __name__ == "__main__":
    sys.exit(main())
