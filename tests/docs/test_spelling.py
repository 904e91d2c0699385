# SPDX-License-Identifier: Apache-2.0
"""British spelling of what people read: pages, the words of recipes, messages of the programs, by hunspell's en_GB.

What that dictionary does not know and is right stands in words.txt, one word a line.
"""

import re
import shutil
import subprocess
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = ("*.md", "configs/*.md", "data/*.md", "docs/**/*.md")
RECIPES = ("configs/recipes/*.yaml", "demo/*/*.yaml")
HTML = ("lutgen/pictures/report/page/*.html", "playground/page/*.html")
SOURCES = tuple(f"{folder}/**/*.{kind}" for folder in ("spectral", "skin", "sip", "stage", "ocio_plugin", "lutgen", "ofx", "playground",
                                                       "spectral_ref", "farm", "python") for kind in ("cpp", "h"))
WORDS = Path(__file__).with_name("words.txt")
WORD = re.compile(r"[^\W\d_]+(?:['’][^\W\d_]+)*")
# What no dictionary judges: abbreviations, names with capitals inside, symbols with Greek letters, and two letters.
NO_WORD = re.compile(r"..?$|.+[A-Z]|.*[\u0370-\u03ff]")
# The house writes -ise, as most British papers do; the dictionary takes both.
OXFORD = re.compile(r"\w{3,}(?:iz(?:e(?:d|rs?|s)?|ings?|ations?)|yz(?:e(?:d|rs?|s)?|ing))$")


def prose(text):
    """A page's words: without code, links' targets and tags."""
    text = re.sub(r"^ *```.*?^ *```$", " ", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"`[^`]*`|\]\([^)]*\)|<[^>]*>|\b\w+://\S+", " ", text)
    # Names of files and domains, and what holds figures: FL11, u8, MIM-17.
    return re.sub(r"\S*(?:\w[./_]\w|\w\d|\d\w|\w::\w|\.\w+\()\S*", " ", text)


def comments(text):
    """A recipe's words: its comments, which name what it is for."""
    return prose(" ".join(re.findall(r"(?:^| )# ?(.*)$", text, re.MULTILINE)))


def page_of_html(text):
    return prose(re.sub(r"<(style|script)\b.*?</\1>|\{\{.*?\}\}|&\w+;", " ", text, flags=re.DOTALL))


def messages(text):
    """A source's words: literals of three words and more."""
    text = re.sub(r'"\s*\n\s*"', "", re.sub(r"^ *//.*$", "", text, flags=re.MULTILINE))
    literals = (re.sub(r"\\[nt\"]", " ", literal) for literal in re.findall(r'"((?:[^"\\\n]|\\.)*)"', text))
    told = "\n".join(literal for literal in literals if len(re.findall(r"\b[a-z]{2,}\b", literal)) >= 3)
    # Without values in quotes, options, extensions, and where printf puts something.
    return prose(re.sub(r"(?<!\w)'\S*'(?!\w)|(?<!\w)(?:--?\w[\w-]*|\.\w+)|%[-+.*\d]*[a-z]+", " ", told))


READERS = ((PAGES, prose), (RECIPES, comments), (HTML, page_of_html), (SOURCES, messages))


def words_in(text):
    """Each word to be judged, without a genitive's ending."""
    for word in WORD.findall(text):
        word = re.sub(r"'s?$", "", word.replace("’", "'"))
        if not NO_WORD.match(word):
            yield word


def unknown_to_hunspell(words):
    """Those that are misspelt to en_GB."""
    run = subprocess.run(["hunspell", "-d", "en_GB", "-i", "UTF-8", "-l"], input="\n".join(sorted(words)), capture_output=True, text=True,
                         check=True, encoding="utf-8")
    return set(run.stdout.split())


def known(word, listed):
    """A word of the list, or it at the beginning of a sentence."""
    return word in listed or word[:1].lower() + word[1:] in listed


def places():
    """{word: files that hold it}, over all that is read."""
    found = {}
    for patterns, read in READERS:
        for pattern in patterns:
            for file in sorted(ROOT.glob(pattern)):
                for word in words_in(read(file.read_text(encoding="utf-8"))):
                    found.setdefault(word, set()).add(file.relative_to(ROOT).as_posix())
    return found


class Spelling(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not shutil.which("hunspell"):
            raise RuntimeError("hunspell is missing: script/bootstrap installs it, with its en_GB dictionary")
        cls.listed = WORDS.read_text(encoding="utf-8").split()
        cls.places = places()
        cls.unknown = unknown_to_hunspell(cls.places)

    def test_every_word_is_known(self):
        self.assertGreater(len(self.places), 3000)
        wrong = sorted(word for word in self.unknown if not known(word, set(self.listed)))
        self.assertEqual(wrong, [], "mend them, or add them to tests/docs/words.txt:\n" + "\n".join(f"{word}: {', '.join(sorted(self.places[word])[:3])}" for word in wrong))

    def test_endings_are_ise(self):
        for word in sorted(filter(OXFORD.match, self.places)):
            british = re.sub(r"([iy])z(?=[ei]|ation)", r"\1s", word)
            if british != word and word not in self.listed:
                self.assertIn(british, unknown_to_hunspell({british}), f"{word}: write {british}: {sorted(self.places[word])[:3]}")

    def test_the_list_holds_what_it_must_alone(self):
        self.assertEqual(self.listed, sorted(set(self.listed), key=lambda word: (word.lower(), word)), "words.txt is sorted, each word once")
        needed = {word for word in self.listed if word in self.unknown or word[:1].upper() + word[1:] in self.unknown or OXFORD.match(word)}
        self.assertEqual(sorted(set(self.listed) - needed), [], "no page has these words any more, or the dictionary knows them")

    def test_it_sees_mistakes(self):
        self.assertEqual(unknown_to_hunspell({"colour", "spectral", "color", "recieve", "labeled"}), {"color", "recieve", "labeled"})
        self.assertEqual(list(words_in(prose("The `color` of [a lamp's](color.md) <b>colour</b>, FL11, c.csv"))), ["The", "lamp", "colour"])
        self.assertEqual(list(words_in(messages('throw Fault("no colour is named", "illuminant");  // color'))), ["colour", "named"])


if __name__ == "__main__":
    unittest.main()
