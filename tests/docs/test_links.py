# SPDX-License-Identifier: Apache-2.0
"""Links of all pages lead to files and headings that are there, and folds open and close."""

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = (".", "configs", "data", "docs", "docs/start")
PAGES = [page for folder in FOLDERS for page in sorted((ROOT / folder).glob("*.md"))]
LINK = re.compile(r"\]\(([^)\s]+)\)")


def anchors(page):
    """Of headings, as Git hosts make them."""
    for heading in re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE):
        heading = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading)
        yield re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def links(page):
    """(file, anchor) of each link that stays within the repository."""
    text = re.sub(r"^ *```.*?^ *```$", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    for link in LINK.findall(text):
        if not re.match(r"[a-z]+:", link):
            file, _, anchor = link.partition("#")
            yield (page.parent / file).resolve() if file else page, anchor


class Links(unittest.TestCase):
    def test_they_lead_somewhere(self):
        self.assertGreater(len(PAGES), 30)
        lost = []
        for page in PAGES:
            for file, anchor in links(page):
                if not file.exists() or (anchor and file.suffix == ".md" and anchor not in anchors(file)):
                    lost.append(f"{page.relative_to(ROOT)}: {file.name}#{anchor}")
        self.assertEqual(lost, [])

    def test_folds_have_a_summary_and_a_blank_line(self):
        """Without the blank line Git hosts show a table inside as plain text."""
        for page in PAGES:
            text = page.read_text(encoding="utf-8")
            opened = len(re.findall(r"^<details><?", text, re.MULTILINE))
            proper = len(re.findall(r"^<details>\n?<summary>[^<\n]+</summary>\n\n", text, re.MULTILINE))
            closed = len(re.findall(r"^</details>$", text, re.MULTILINE))
            self.assertEqual((opened, closed), (proper, proper), page.name)


if __name__ == "__main__":
    unittest.main()
