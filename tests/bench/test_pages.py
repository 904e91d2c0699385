# SPDX-License-Identifier: Apache-2.0
"""The pages of docs/ that show benchmarks are what bench/report.py makes of docs/bench.json."""

import json
import sys
import unittest
from pathlib import Path

from PIL import Image

REPOSITORY = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(REPOSITORY / "bench"))

import report  # noqa: E402


class Pages(unittest.TestCase):
    def test_pages_are_those_of_the_figures(self):
        results = report.ordered(json.loads((REPOSITORY / "docs" / "bench.json").read_text(encoding="utf-8")))
        for name in report.PAGES:
            page = (REPOSITORY / "docs" / f"{name}.md").read_text(encoding="utf-8")
            self.assertEqual(page, report.page(results, name), f"docs/{name}.md: run bench/report.py docs/bench.json docs")

    def test_pictures_show_the_figures(self):
        results = report.ordered(json.loads((REPOSITORY / "docs" / "bench.json").read_text(encoding="utf-8")))
        pictures = report.pictures(results)
        self.assertIn("fronts.png", pictures)
        for name, (figures, _) in pictures.items():
            with Image.open(REPOSITORY / "docs" / "images" / f"bench_{name}") as picture:
                self.assertEqual(picture.text["Figures"], report.digest(figures), f"bench_{name}: run bench/report.py")

    def test_every_figure_is_of_a_section(self):
        results = json.loads((REPOSITORY / "docs" / "bench.json").read_text(encoding="utf-8"))
        self.assertLessEqual(set(results), set(report.SECTIONS))


if __name__ == "__main__":
    unittest.main()
