# SPDX-License-Identifier: Apache-2.0
"""The golden files: the JUnit reports of their comparisons, the exact engine on the golden pixels, and spoilt files.

Arguments: the folder of the reports, then FILE:BOUND for each golden file.
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path

LUTGEN = Path(os.environ["METAMER_BIN"]) / "lutgen"
GOLDEN = Path(__file__).resolve().parent
REPORTS = Path(sys.argv[1])
CASES = dict(case.split(":") for case in sys.argv[2:])
# Pixels go through floats and EXR without loss; another compiler's last bit of a double is no difference here.
PIXEL_TOLERANCE = 0.001


def lutgen(*arguments):
    return subprocess.run([LUTGEN, *map(str, arguments)], capture_output=True, text=True, timeout=300)


def suite_of(report):
    return xml.etree.ElementTree.parse(report).getroot().find("testsuite")


def space_of(recipe):
    return re.search(r"^space: (.*)$", recipe.read_text(), re.MULTILINE)[1]


class Golden(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def test_every_file_is_compared(self):
        files = {path.name for pattern in ("*.ctf", "*.cube") for path in GOLDEN.glob(pattern)}
        self.assertEqual(files, set(CASES))
        self.assertGreaterEqual(len(files), 5)

    def test_every_comparison_is_reported(self):
        tests = failures = 0
        for file in CASES:
            name = Path(file).stem
            suite = suite_of(REPORTS / f"{name}.xml")
            tests += int(suite.get("tests"))
            failures += int(suite.get("failures")) + int(suite.get("errors"))
            self.assertEqual(suite.find("testcase").get("name"), f"{name}.yaml against {file}")
            self.assertIsNone(suite.find("testcase/failure"))
        print(f"{tests} comparisons reported, {failures} failed")
        self.assertEqual((tests, failures), (len(CASES), 0))

    def test_golden_pixels(self):
        """The exact engine, pixel by pixel: what a table's own error might hide."""
        for file in CASES:
            recipe = (GOLDEN / file).with_suffix(".yaml")
            run = lutgen("apply", recipe, GOLDEN / "probes.exr", self.folder / "now.exr")
            self.assertEqual(run.returncode, 0, run.stderr)
            run = lutgen("compare", recipe.with_suffix(".exr"), self.folder / "now.exr", "--space", space_of(recipe),
                         "--statistic", "max", "--tolerance", PIXEL_TOLERANCE)
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)

    def test_other_pixels_are_noticed(self):
        """Adaptation a two-hundredth away."""
        recipe = self.folder / "moved.yaml"
        recipe.write_text((GOLDEN / "day_to_sodium.yaml").read_text().replace("0.5", "0.505"))
        lutgen("apply", recipe, GOLDEN / "probes.exr", self.folder / "now.exr")
        run = lutgen("compare", GOLDEN / "day_to_sodium.exr", self.folder / "now.exr", "--space", "ACEScg", "--statistic",
                     "max", "--tolerance", PIXEL_TOLERANCE)
        self.assertEqual(run.returncode, 3, run.stdout + run.stderr)

    def test_a_spoilt_file_is_noticed(self):
        """Every number of the table a twentieth larger."""
        for file, bound in CASES.items():
            spoilt = self.folder / file
            text = (GOLDEN / file).read_text()
            head, mark, table = text.partition('<Array dim="13 13 13 3">' if file.endswith(".ctf") else "LUT_3D_SIZE 9")
            self.assertTrue(mark, file)
            table, end, tail = table.partition("</Array>")
            table = re.sub(r"(?<![\w.])-?\d*\.\d+(e[-+]?\d+)?", lambda match: repr(float(match[0]) * 1.05), table)
            spoilt.write_text(head + mark + table + end + tail)
            report = self.folder / "spoilt.xml"
            run = lutgen("compare", (GOLDEN / file).with_suffix(".yaml"), spoilt, "--statistic", "mean", "--tolerance", bound,
                         "--junit", report)
            self.assertEqual(run.returncode, 3, f"{file}: {run.stdout}{run.stderr}")
            suite = suite_of(report)
            self.assertEqual((suite.get("tests"), suite.get("failures")), ("1", "1"))
            self.assertIn(f"tolerance {float(bound):.4f}", suite.find("testcase/failure").get("message"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
