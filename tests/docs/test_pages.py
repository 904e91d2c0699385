# SPDX-License-Identifier: Apache-2.0
"""Lines of README and docs run as printed in a copy of demo/files, page by page, as a new user would run them."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import textwrap
import unittest
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
LONG = bool(os.environ.get("METAMER_LONG"))
PAGES = [REPOSITORY / "README.md", *sorted((REPOSITORY / "docs").rglob("*.md"))]

# Blocks that are not run, by their first line, and why.
SKIPPED = {
    "script/bootstrap     # installs": "builds metamer: what runs this test did so",
    "script/bootstrap --no-build": "the same, by hand",
    "export PATH=$PWD/build/install/bin:$PATH": "done by this test, with the build's programs",
    "cmake --install build/release --component ofx": "installs; tests/ofx_host does the same",
    "pip install .": "script/wheel does so",
    "tar xzf metamer-*": "tests/releases does so, with the archive",
}
# Run with METAMER_LONG=1 alone, as they take longer than a few seconds: pages, and beginnings of lines.
LONG_PAGES = {"compare.md", "configs.md"}
LONG_LINES = ("lutgen validate", "lutgen report", "lutgen stage patterns", "lutgen bake day_to_sodium.yaml --", "lutgen bake --illuminant-in \"3200",
              "lutgen config day_to_sodium", "lutgen compare day_to_sodium")
# A figure that a page shows may be this far from today's, of its size: what a reader sees is the same.
QUOTED = 0.02
NUMBER = re.compile(r"\d+(?:\.\d+)?")
BLOCK = re.compile(r"^( *)```(\w*)\n(.*?)^\1```$", re.MULTILINE | re.DOTALL)


def blocks(page):
    """(language, text) of each fenced block, without the indentation of lists."""
    for indent, language, text in BLOCK.findall(page.read_text(encoding="utf-8")):
        yield language, textwrap.dedent(text)


def skipped(text):
    return next((first for first in SKIPPED if text.startswith(first)), None)


class Pages(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name) / "try"
        shutil.copytree(REPOSITORY / "demo" / "files", self.folder)

    def run_in_folder(self, command, what):
        environment = {key: value for key, value in os.environ.items() if key != "OCIO"}
        environment["PATH"] = os.pathsep.join((os.environ["METAMER_BIN"], str(Path(sys.executable).parent), environment["PATH"]))
        run = subprocess.run(command, cwd=self.folder, env=environment, capture_output=True, text=True, timeout=900)
        self.assertEqual(run.returncode, 0, f"{what}:\n{run.stdout}{run.stderr}")
        return run.stdout

    def run_shell(self, text, page):
        if not LONG:
            text = "\n".join(line for line in text.splitlines() if not line.startswith(LONG_LINES))
        # -x: the line that failed is the last that it tells.
        self.run_in_folder(["bash", "-euxo", "pipefail", "-c", text], page)

    def run_console(self, text, page):
        """A line behind "$ ", and the first lines that it prints: the same words, and figures as near as they are quoted."""
        command, *printed = text.rstrip("\n").split("\n")
        self.assertTrue(command.startswith("$ "), page)
        got = self.run_in_folder(["bash", "-c", command[2:]], page).split("\n")
        for said, line in zip(got, printed, strict=False):
            self.assertEqual(NUMBER.sub("#", said), NUMBER.sub("#", line), page)
            for now, quoted in zip(NUMBER.findall(said), NUMBER.findall(line), strict=True):
                self.assertAlmostEqual(float(now), float(quoted), delta=QUOTED * abs(float(quoted)), msg=f"{page}: {line}")
        self.assertGreaterEqual(len(got), len(printed), page)

    def run_yaml(self, text, page):
        """A file that the page has its reader write, named in its first line; else one to look at, a recipe that bakes."""
        named = re.match(r"# (\S+\.yaml)\n", text)
        name = named[1] if named else "printed.yaml"
        (self.folder / name).write_text(text, encoding="utf-8")
        if not named:
            self.run_in_folder(["lutgen", "bake", name, "-o", "printed.cube", "--size", "9"], page)

    def run_page(self, page):
        python = []
        for language, text in blocks(page):
            if skipped(text):
                continue
            if language == "sh":
                self.run_shell(text, page.name)
            elif language == "console":
                self.run_console(text, page.name)
            elif language == "yaml":
                self.run_yaml(text, page.name)
            elif language == "python":
                python.append(text)
        if python:
            self.run_in_folder([sys.executable, "-c", "\n".join(python)], page.name)

    def test_what_is_skipped_is_there(self):
        texts = [text for page in PAGES for _, text in blocks(page)]
        for first in SKIPPED:
            self.assertTrue(any(text.startswith(first) for text in texts), f"no page has '{first}': renew SKIPPED")

    def test_every_language_is_known(self):
        for page in PAGES:
            for language, text in blocks(page):
                self.assertIn(language, {"sh", "console", "yaml", "python", "cmake", "cpp", ""}, page.name)
                if not language:
                    # What is printed, or a tree: a command belongs in a block that is run.
                    self.assertNotRegex(text, r"(?m)^(\$ )?(lutgen|spectral_ref|script/) ", page.name)


# apply.md names spaces of OpenColorIO's own configs, which 2.1 does not have.
VERSION = subprocess.run([Path(os.environ["METAMER_BIN"]) / "lutgen", "--version"], capture_output=True, text=True, check=True).stdout
NEEDS_OWN_CONFIGS = {"apply.md"} if "OpenColorIO 2.1" in VERSION else set()


def of_page(page):
    if page.name in NEEDS_OWN_CONFIGS:
        return unittest.skip("the linked OpenColorIO has no config of its own")(lambda self: None)
    return lambda self: self.run_page(page)


for one in PAGES:
    if any(language for language, _ in blocks(one)) and (LONG or one.name not in LONG_PAGES):
        setattr(Pages, f"test_{one.stem}", of_page(one))


if __name__ == "__main__":
    unittest.main()
