# SPDX-License-Identifier: Apache-2.0
"""The examples run, and pass a strict type check against the stubs."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import metamer

REPOSITORY = Path(__file__).resolve().parent.parent.parent
EXAMPLES = sorted((REPOSITORY / "python" / "examples").glob("*.py"))
PACKAGE = Path(metamer.__file__).parent


def run(*command, **options):
    return subprocess.run([sys.executable, *command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)


class Types(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cache = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cache.cleanup)
        cls.cache = cache.name

    def check(self, *files):
        environment = dict(os.environ, MYPYPATH=str(PACKAGE.parent)) if "site-packages" not in PACKAGE.parts else None
        return run("-m", "mypy", "--strict", "--cache-dir", self.cache, *map(str, files), env=environment, cwd=self.cache)

    def test_examples(self):
        result = self.check(*EXAMPLES)
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_mistakes_are_seen(self):
        mistakes = ("metamer.Recipe('D65')", "metamer.Recipe('D65', 3)", "metamer.Recipe('D65', 'A', spaec='ACEScg')",
                    "metamer.Transform(metamer.Recipe('D65', 'A')).aply",
                    "metamer.Transform('recipe.yaml')(numpy.zeros((4, 3), numpy.uint8))",
                    "metamer.Spectrum([400], [1], quantity='colour')", "metamer.Library().illuminant(3)")
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "mistakes.py"
            file.write_text("import metamer\nimport numpy\n" + "\n".join(mistakes) + "\n")
            result = self.check(file)
        for line in range(3, 3 + len(mistakes)):
            self.assertIn(f"mistakes.py:{line}: error:", result.stdout, mistakes[line - 3])

    def test_examples_run(self):
        self.assertTrue(EXAMPLES)
        for example in EXAMPLES:
            with self.subTest(example.name), tempfile.TemporaryDirectory() as folder:
                result = run("-B", str(example), cwd=folder)
                self.assertEqual(result.returncode, 0, result.stdout)


if __name__ == "__main__":
    unittest.main()
