# SPDX-License-Identifier: Apache-2.0
"""The same results whatever compiled it: the release build (gcc) beside the preset `clang`, built here where it is not."""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[2]
TARGETS = ("lutgen", "metamer_bench_door", "spectral_ref")
KINDS = {"exact": "exact engine, double", "map": "map kernel, float32, every instruction set", "file": "baked files",
         "certificate": "their certificates", "threads": "lutgen apply, 1, 2 and 3 threads",
         "render": "spectral_ref, float32: plain, and guided and resampled"}


def build_clang():
    """Its bin folder."""
    for command in (("cmake", "--preset", "clang"), ("cmake", "--build", "--preset", "clang", "--target", *TARGETS)):
        subprocess.run(command, cwd=REPOSITORY, check=True, stdout=sys.stderr)
    return REPOSITORY / "build" / "clang" / "bin"


def compiler_of(bin_folder):
    """As CMake found it: name and version."""
    found = {}
    for file in (bin_folder.parent / "CMakeFiles").glob("*/CMakeCXXCompiler.cmake"):
        found = dict(re.findall(r'set\(CMAKE_CXX_COMPILER_(ID|VERSION) "(.*)"\)', file.read_text(encoding="utf-8")))
    return f"{found.get('ID', 'unknown')} {found.get('VERSION', '')}".strip()


def figures_of(bin_folder):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, REPOSITORY / "bench" / "compiler_figures.py", bin_folder, folder], check=True)
        with np.load(Path(folder) / "figures.npz") as arrays:
            return dict(arrays)


def compare(one, other):
    """Values that differ in a bit, and the largest difference relative to its colour."""
    if one.dtype.kind == "U":
        return int((one != other).sum()), None
    bits = np.uint64 if one.dtype == np.float64 else np.uint32
    different = int((one.view(bits) != other.view(bits)).sum())
    one, other = (np.where(np.isfinite(v), v, 0).reshape(-1, v.shape[-1]).astype(np.float64) for v in (one, other))
    scale = np.abs(one[:, :3]).max(axis=1)
    return different, float((np.abs(one - other).max(axis=1) / np.where(scale > 0, scale, 1)).max())


def run(context):
    folders = (context.bin_folder, build_clang())
    first, second = (figures_of(folder) for folder in folders)
    rows = []
    for name, value in first.items():
        if name not in second:  # an instruction set that one compiler cannot do
            continue
        different, largest = compare(value, second[name])
        rows.append({"what": name, "count": int(value.size), "different": different, "largest": largest})
    # Within one build: threads and instruction sets against the first of them.
    within = []
    for compiler, arrays in zip(folders, (first, second)):
        for kind in ("threads", "map"):
            groups = {}
            for name, value in arrays.items():
                if name.startswith(kind + "/"):
                    groups.setdefault(name.rsplit("/", 1)[0] if kind == "map" else kind, []).append(value)
            within.append({"compiler": compiler_of(compiler), "kind": kind, "sets": len(next(iter(groups.values()))),
                           "different": sum(compare(group[0], value)[0] for group in groups.values() for value in group[1:])})
    return {"compilers": [compiler_of(folder) for folder in folders], "rows": rows, "within": within}


def markdown(results):
    first, second = results["compilers"]
    lines = [f"{first} and {second} on the same inputs. Values: numbers, or whole files.", "",
             "| | values | with another bit | largest difference, of its colour |", "| --- | --- | --- | --- |"]
    for kind, title in KINDS.items():
        rows = [r for r in results["rows"] if r["what"].startswith(kind + "/")]
        largest = [r["largest"] for r in rows if r["largest"] is not None]
        lines.append(f"| {title} | {sum(r['count'] for r in rows):,} | {sum(r['different'] for r in rows):,} "
                     f"| {f'{max(largest):.1e}' if largest else ''} |")
    named = [r["what"].split("/", 1)[1] for r in results["rows"] if r["largest"] is None and r["different"]
             and r["what"].startswith("file/")]
    renders = [r["what"].split("/", 1)[1] for r in results["rows"] if r["what"].startswith("render/") and r["different"]]
    if renders:
        lines += ["", "Renders with other values: " + ", ".join(renders) + "."]
    if named:
        lines += ["", "Files with other bytes: " + ", ".join(named) + "."]
    lines += ["", "Within one build, against the first thread count or instruction set:", "",
              "| compiler | | how many | values with another bit |", "| --- | --- | --- | --- |"]
    names = {"threads": "thread counts", "map": "instruction sets"}
    return lines + [f"| {r['compiler']} | {names[r['kind']]} | {r['sets']} | {r['different']} |" for r in results["within"]]
