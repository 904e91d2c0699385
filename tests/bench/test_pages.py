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

    def test_the_published_figures_are_short(self):
        text = (REPOSITORY / "docs" / "bench.json").read_text(encoding="utf-8")
        results = json.loads(text)
        self.assertEqual(text, report.published_text(report.published(results)))
        for name in results:
            self.assertEqual(report.raw_of(name, results[name]["figures"]), [])

    def test_publishing_drops_curves_and_digits_alone(self):
        curve = [0.1234567891] * 401
        run = {"wavelengths": {"figures": {"histogram": {"optimum": curve, "density": curve, "patch": "red", "difference": 0.123456789}}}}
        kept = report.published(run)
        self.assertEqual(kept["wavelengths"]["figures"], {"histogram": {"patch": "red", "difference": 0.123457}})
        self.assertEqual(run["wavelengths"]["figures"]["histogram"]["optimum"], curve)
        self.assertEqual(json.loads(report.published_text(kept)), kept)

    def test_words_stand_in_front_and_tables_fold(self):
        results = report.ordered(json.loads((REPOSITORY / "docs" / "bench.json").read_text(encoding="utf-8")))
        for name in report.PAGES:
            text = report.page(results, name)
            self.assertEqual(text.count("<details>"), text.count("</details>"))
            for part in text.split("<details>"):
                self.assertNotRegex(part.split("</details>")[-1], r"(?m)^\|", name)
            for section in text.split("\n## ")[1:]:
                self.assertRegex(section, r"\A[^\n]+\n\n[A-Z0-9]", "words follow the heading")

    def test_every_figure_is_of_a_section(self):
        results = json.loads((REPOSITORY / "docs" / "bench.json").read_text(encoding="utf-8"))
        self.assertLessEqual(set(results), set(report.SECTIONS))


if __name__ == "__main__":
    unittest.main()
