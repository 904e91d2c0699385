#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""clang-tidy over the sources of a build tree: all of them, or those that the last commits touched.

    script/tidy.py --all
    script/tidy.py --changed --seconds 300    # newest changes first, until the time is used up

A changed header is judged through one source that includes it. Exit 1 where clang-tidy finds something.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Changes older than this were judged when they were new.
COMMITS = 40


def git(*words: str) -> list[str]:
    return subprocess.run(["git", *words], cwd=ROOT, check=True, capture_output=True, text=True).stdout.splitlines()


def compiled(build: Path) -> list[Path]:
    """Every source of this tree that the build compiles: none that it made, none of a package that it uses."""
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    names = {Path(os.path.normpath(os.path.join(entry["directory"], entry["file"]))) for entry in entries}
    return sorted(name for name in names if ROOT in name.parents and ROOT / "build" not in name.parents)


def changed(commits: int) -> list[Path]:
    """C++ files that differ from the last commit, then those of the commits before it, newest first."""
    names = [line[3:] for line in git("status", "--porcelain", "--no-renames")]
    names += git("log", f"-{commits}", "--first-parent", "-m", "--name-only", "--format=", "--diff-filter=d")
    files = (ROOT / name for name in dict.fromkeys(names) if name.endswith((".cpp", ".h")))
    return [file for file in files if file.exists()]


def judged_through(header: Path, sources: list[Path]) -> Path | None:
    """The source of the header's own name, else the first that includes it."""
    own = [source for source in sources if source.stem == header.stem]
    if own:
        return own[0]
    including = re.compile(rf'#include ["<]([^">]*/)?{re.escape(header.name)}[">]')
    return next((source for source in sources if including.search(source.read_text(encoding="utf-8", errors="replace"))), None)


def wanted(files: list[Path], sources: list[Path]) -> list[Path]:
    known = set(sources)
    found: dict[Path, None] = {}
    for file in files:
        source = judged_through(file, sources) if file.suffix == ".h" else file
        if source in known:
            found[source] = None
    return list(found)


def judge(source: Path, build: Path, until: float) -> str | None:
    """What clang-tidy says of it, "" where nothing; None where the time was used up before."""
    if time.monotonic() > until:
        return None
    run = subprocess.run(["clang-tidy", "--quiet", "--extra-arg=-Wno-unknown-warning-option", "-p", build, source],
                         capture_output=True, text=True)
    return "" if run.returncode == 0 else run.stdout + run.stderr


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--all", action="store_true", help="every source (the default)")
    parser.add_argument("--changed", action="store_true", help=f"what the working tree and the last {COMMITS} commits touched")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="no file is begun after these")
    parser.add_argument("-p", dest="build", type=Path, default=ROOT / "build" / "release", help="build tree")
    arguments = parser.parse_args()
    sources = compiled(arguments.build)
    files = wanted(changed(COMMITS), sources) if arguments.changed else sources
    until = time.monotonic() + arguments.seconds
    faults = left = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for source, said in zip(files, pool.map(lambda file: judge(file, arguments.build, until), files), strict=True):
            if said is None:
                left += 1
            elif said:
                faults += 1
                print(f"{source.relative_to(ROOT)}:\n{said}")
    print(f"clang-tidy: {len(files) - left} of {len(files)} files judged, {faults} with findings"
          + (f"; {left} older changes left for want of time (script/test --full judges all)" if left else ""))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
