#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the tests of the preset `coverage` ran: text, HTML, totals a folder, and public functions that nothing called.

Reads the counts that the instrumented programs left in build/coverage/profiles. Writes out/coverage/coverage.txt,
out/coverage/html/index.html and out/coverage/public.txt. Exit 1 where a public function was never called.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
BUILD = REPOSITORY / "build" / "coverage"
OUT = REPOSITORY / "out" / "coverage"
FOLDERS = ("spectral", "sip", "stage", "ocio_plugin", "lutgen", "ofx", "spectral_ref")
# Not ours to cover: tests, and what is included from elsewhere.
OTHERS = r"/tests/|^/usr/|/\.cargo/"
# Called, but leaves no counts: another program takes the process's place before they are written.
UNCOUNTED = {"metamer::spectral::becomeProgram"}
# The section that llvm-cov reads; programs of tests' helpers have none.
COVERAGE_SECTION = b"__llvm_covmap"
FUNCTIONS = {"FunctionDecl", "CXXMethodDecl", "CXXConstructorDecl", "CXXConversionDecl"}
# Eigen's headers where Debian has them.
EIGEN = "/usr/include/eigen3"


def output(*words, **options):
    return subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True, **options).stdout


def instrumented():
    """Programs and libraries that carry a map of their lines."""
    files = [path for path in (*BUILD.glob("bin/*"), *BUILD.glob("lib/*.so"), *BUILD.glob("OFX/**/*.ofx")) if path.is_file()]
    return sorted(path for path in files if COVERAGE_SECTION in path.read_bytes())


def coverage_of(profile, objects):
    """Text and HTML; the totals and functions that llvm-cov exports."""
    common = [f"-instr-profile={profile}", f"-ignore-filename-regex={OTHERS}", objects[0],
              *(f"-object={path}" for path in objects[1:])]
    OUT.mkdir(parents=True, exist_ok=True)
    (OUT / "coverage.txt").write_text(output("llvm-cov", "report", *common), encoding="utf-8")
    output("llvm-cov", "show", "-format=html", f"-output-dir={OUT / 'html'}", *common)
    return json.loads(output("llvm-cov", "export", *common))["data"][0]


def totals(data):
    """{folder: (lines run, lines)}"""
    found = {}
    for file in data["files"]:
        # A compiler cache may have made them relative to the build folder.
        name = Path(os.path.normpath(file["filename"])).relative_to(REPOSITORY).parts[0]
        run, lines = found.get(name, (0, 0))
        summary = file["summary"]["lines"]
        found[name] = (run + summary["covered"], lines + summary["count"])
    return found


def one_constructor(mangled):
    """A constructor's complete and base forms are one function to its caller."""
    return mangled.replace("C1E", "C2E")


def public_functions():
    """{mangled name: readable place} of what the installed headers declare and someone must define."""
    includes, text = ["-isystem", EIGEN], ""
    for folder in FOLDERS:
        include = REPOSITORY / folder / "include"
        headers = sorted(include.rglob("*.h"))
        includes += ["-I", include] if headers else []
        text += "".join(f'#include "{header.relative_to(include)}"\n' for header in headers)
    dump = output("clang++", "-std=c++20", "-fsyntax-only", "-x", "c++", *includes, "-Xclang", "-ast-dump=json", "-Xclang",
                  "-ast-dump-filter=metamer", "-", input=text)
    found, decoder, at = {}, json.JSONDecoder(), 0
    while at < len(dump):
        node, at = decoder.raw_decode(dump, at)
        collect(node, [], True, found)
        while at < len(dump) and dump[at].isspace():
            at += 1
    return found


def collect(node, scope, visible, found):
    """Functions under a declaration; `scope`: names around it; `visible`: not private to a class."""
    kind, name = node.get("kind"), node.get("name", "")
    if kind in FUNCTIONS:
        defaulted = node.get("explicitlyDefaulted") or node.get("explicitlyDeleted")
        if visible and not defaulted and not node.get("isImplicit") and not node.get("pure") and "mangledName" in node:
            found[one_constructor(node["mangledName"])] = "::".join([*scope, name])
        return
    if kind not in ("NamespaceDecl", "CXXRecordDecl"):
        return
    access = kind == "NamespaceDecl" or node.get("tagUsed") == "struct"
    for child in node.get("inner", []):
        if child.get("kind") == "AccessSpecDecl":
            access = child.get("access") == "public"
        else:
            collect(child, [*scope, name] if name else scope, visible and access, found)


def never_called(data):
    """Public functions without a count, by name."""
    counts = {}
    for function in data["functions"]:
        name = one_constructor(function["name"].rsplit(":", 1)[-1])
        counts[name] = max(counts.get(name, 0), function["count"])
    public = {mangled: place for mangled, place in public_functions().items() if place not in UNCOUNTED}
    return len(public), sorted(place for mangled, place in public.items() if counts.get(mangled, 0) == 0)


def main():
    profiles = sorted((BUILD / "profiles").glob("*.profraw"))
    if not profiles:
        sys.exit("script/coverage.py: no counts in build/coverage/profiles; run script/test --coverage")
    profile = BUILD / "tests.profdata"
    output("llvm-profdata", "merge", "-sparse", "-failure-mode=all", "-o", profile, *profiles)
    data = coverage_of(profile, instrumented())
    lines = [f"{name:14} {run:6} of {count:6} lines, {run / count:6.1%}" for name, (run, count) in sorted(totals(data).items())]
    run, count = (sum(column) for column in zip(*totals(data).values()))
    lines.append(f"{'all':14} {run:6} of {count:6} lines, {run / count:6.1%}")
    number, silent = never_called(data)
    lines.append(f"public functions: {number - len(silent)} of {number} called by the tests")
    lines += [f"never called: {name}" for name in silent]
    (OUT / "public.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))
    print(f"written: {OUT / 'coverage.txt'}, {OUT / 'html' / 'index.html'}")
    return 1 if silent else 0


if __name__ == "__main__":
    sys.exit(main())
