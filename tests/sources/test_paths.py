# SPDX-License-Identifier: Apache-2.0
"""Paths meet text in two functions alone (metamer/spectral/path_text.h), and files are opened by name in one.

What goes from text to a path without a word, a text given where a path is wanted, stands in no pattern: that is what
cmake/strict_paths.h is for, in the clang preset and in the bundles for other systems.
"""

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("spectral", "skin", "sip", "stage", "ocio_plugin", "lutgen", "ofx", "playground", "spectral_ref", "python")
# Where the conversions and the system's own calls stand.
ALLOWED = {"spectral/src/text/path_text.cpp", "spectral/src/files/platform.cpp"}

PATH = r"\b(?:std::filesystem|fs)::path"
LITERAL = r'"(?:[^"\\]|\\.)*"'
RULES = {
    r"(?:\.|->)(?:generic_)?(?:u8|w)?string\(\)": "spectral::utf8(path) makes text of a path",
    PATH + r"\((?!\)|" + LITERAL + r"\))": "spectral::pathOf(text) makes a path of text",
    PATH + r"\{(?!\}|" + LITERAL + r"\})": "spectral::pathOf(text) makes a path of text",
    PATH + r" \w+\([\w.]+(?:->\w+)*\);": "write path = spectral::pathOf(text)",
    PATH + r" \w+\{[^}]": "write path = spectral::pathOf(text)",
    r"\bu8path\(": "spectral::pathOf(text) makes a path of text",
    r"\bfopen\(": "spectral::openFile(path, mode) opens files of any name",
    r"\bgetenv\(": "spectral::environmentValue(name) reads variables",
    r"fstream\b[^;]*\.c_str\(\)": "give the stream the path itself",
}


def faults(text):
    """(line, rule's words) of each place in a source that goes its own way."""
    code = re.sub(r"//[^\n]*", "", text)
    for pattern, words in RULES.items():
        for found in re.finditer(pattern, code):
            yield code.count("\n", 0, found.start()) + 1, words


class Paths(unittest.TestCase):
    def test_no_source_goes_its_own_way(self):
        found = []
        sources = [file for folder in FOLDERS for file in sorted((ROOT / folder).rglob("*")) if file.suffix in (".cpp", ".h")]
        self.assertGreater(len(sources), 300)
        for file in sources:
            name = file.relative_to(ROOT).as_posix()
            if name not in ALLOWED:
                found += [f"{name}:{line}: {words}" for line, words in faults(file.read_text(encoding="utf-8"))]
        self.assertEqual(found, [], "\n" + "\n".join(found))

    def test_the_rules_see_what_they_are_for(self):
        for text in (
            "where = file.string();",
            "lowerCase(file.extension().generic_string())",
            "stem(entry->path().u8string())",
            "std::filesystem::path(name).stem()",
            "fs::path(recipe.folder + name)",
            "const std::filesystem::path path(name);",
            "fs::path file{name};",
            "fs::u8path(name)",
            "std::fopen(path.c_str(), mode)",
            'std::getenv("OCIO")',
            "std::ifstream stream(file.c_str());",
        ):
            self.assertEqual(len(list(faults(text))), 1, text)

    def test_the_rules_pass_what_is_right(self):
        for text in (
            "where = spectral::utf8(file);",
            "const std::filesystem::path path = spectral::pathOf(name);",
            'folder / "manifest.json"',
            'found ? file : std::filesystem::path();',
            'fs::path folderOf(const fs::path& file);',
            "std::ifstream stream(file, std::ios::binary);",
            "words = stream.str();",
            "// file.string() is in a code page",
        ):
            self.assertEqual(list(faults(text)), [], text)


if __name__ == "__main__":
    unittest.main()
