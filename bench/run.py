# SPDX-License-Identifier: Apache-2.0
"""Speed against error, beside the peers, in one process on the same pixels.

Writes out/bench.json, out/bench.md and plots, and prints the tables. Times are medians of interleaved runs: the machine
may be shared, so trust the ratios and look at the noise beside them.
"""

import argparse
import importlib
import json
import os
import sys
import time
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import PyOpenColorIO as ocio  # noqa: E402
import report  # noqa: E402
import timing  # noqa: E402
from door import Door  # noqa: E402
from releases import Release  # noqa: E402

REPOSITORY = Path(__file__).resolve().parent.parent


@dataclass(frozen=True)
class Context:
    """What every section needs."""

    door: Door
    linked_ocio: Release
    older_ocio: Release
    bin_folder: Path
    rounds: int


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=list(report.SECTIONS), action="append", help="these sections alone (repeatable)")
    parser.add_argument("--stability", action="store_true", help="the stability report alone")
    parser.add_argument("--rounds", type=int, default=15, help="interleaved runs a median is taken of (default 15)")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "out", help="folder of bench.json, bench.md and plots")
    arguments = parser.parse_args()
    wanted = arguments.only or (["stability", "compilers", "hard_cases"] if arguments.stability else list(report.SECTIONS))
    bin_folder = Path(os.environ.get("METAMER_BIN", REPOSITORY / "build/release/bin"))
    os.environ.setdefault("METAMER_DATA", str(REPOSITORY / "data"))
    library = bin_folder.parent / "lib" / "libmetamer_bench_door.so"
    door = Door(library)
    context = Context(door, Release(library.parent, "linked"), Release(library.parent, "older"), bin_folder, arguments.rounds)
    arguments.out.mkdir(parents=True, exist_ok=True)
    file = arguments.out / "bench.json"
    # Sections keep their last figures until they are run again.
    results = report.ordered(json.loads(file.read_text())) if file.exists() else {}
    print("machine:", timing.machine())
    for name in wanted:
        start = time.perf_counter()
        section = importlib.import_module(f"sections.{name}")
        results[name] = {"machine": timing.machine(), "ocio": ocio.__version__, "figures": section.run(context)}
        results[name]["seconds"] = round(time.perf_counter() - start, 1)
        file.write_text(json.dumps(results, indent=1) + "\n")
        print("\n".join(report.section_markdown(name, results[name], heading=2)), flush=True)
    report.write(results, arguments.out)
    print(f"\nwritten: {file}, bench.md and plots beside it")
    return 0


if __name__ == "__main__":
    sys.exit(main())
