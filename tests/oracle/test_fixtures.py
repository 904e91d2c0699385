"""The checked-in fixtures are what their generator writes.

Run with ``python -m unittest tests/oracle/test_fixtures.py``; skipped where the pinned packages are missing.
"""

from __future__ import annotations

import csv
import importlib.util
import math
import tempfile
import unittest
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
PUBLISHED = {"sharma_2005.csv"}  # typed from print, not generated

# The generator's mathematics runs in another order on other processors and BLAS builds: a few units in the last place.
TOLERANCE = 1e-12


def load_generator():
    """Return generate_fixtures.py as a module."""
    spec = importlib.util.spec_from_file_location("generate_fixtures", FOLDER / "generate_fixtures.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


GENERATOR = load_generator()


def rows_of(file: Path) -> list[list[str]]:
    """Return the header line and the cells of a fixture."""
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.reader(stream))


def difference(a: str, b: str) -> float:
    """Return how far two cells lie apart: relative above 1, absolute below; infinite where text differs."""
    try:
        x, y = float(a), float(b)
    except ValueError:
        return 0.0 if a == b else math.inf
    return abs(x - y) / max(1.0, abs(x), abs(y))


@unittest.skipIf(GENERATOR.missing_package(), f"needs {GENERATOR.missing_package()}")
class Fixtures(unittest.TestCase):
    def test_regenerated_equal(self) -> None:
        """A fresh run equals every checked-in file, and writes no other."""
        with tempfile.TemporaryDirectory() as name:
            fresh = Path(name)
            GENERATOR.generate(fresh)
            written = {file.name for file in fresh.iterdir()}
            self.assertEqual(written, {f.name for f in FOLDER.glob("*.csv")} - PUBLISHED)
            for file in sorted(written):
                with self.subTest(file):
                    old, new = rows_of(FOLDER / file), rows_of(fresh / file)
                    self.assertEqual(old[:2], new[:2])
                    self.assertEqual([len(row) for row in old], [len(row) for row in new])
                    worst = max(difference(a, b) for x, y in zip(old, new) for a, b in zip(x, y))
                    self.assertLessEqual(worst, TOLERANCE)


if __name__ == "__main__":
    unittest.main()
