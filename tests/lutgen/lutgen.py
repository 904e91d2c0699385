# SPDX-License-Identifier: Apache-2.0
"""Runs the built lutgen for the tests beside this file."""

import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

LUTGEN = Path(os.environ["METAMER_BIN"]) / "lutgen"


def lutgen(*arguments, folder=None, environment=None):
    """One call: exit code, stdout, stderr. $OCIO is not inherited."""
    own = {key: value for key, value in os.environ.items() if key != "OCIO"}
    own.update(environment or {})
    run = subprocess.run(
        [LUTGEN, *map(str, arguments)], capture_output=True, text=True, cwd=folder, env=own, timeout=300
    )
    # What a log is told of long work, on a machine that is slow.
    run.stderr = re.sub(r"^lutgen: .* \d+ %\n", "", run.stderr, flags=re.MULTILINE)
    return run


# Of the OpenColorIO that lutgen is linked with, 2.1 or newer: (major, minor).
LINKED = tuple(int(part) for part in lutgen("--version").stdout.split("OpenColorIO ")[1].split(")")[0].split(".")[:2])


class LutgenTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def assertFails(self, *arguments, code=1, says=(), environment=None):
        """It fails with one line on stderr that says all of `says`, and writes nothing."""
        before = sorted(self.folder.rglob("*"))
        run = lutgen(*arguments, folder=self.folder, environment=environment)
        self.assertEqual(run.returncode, code, run.stderr)
        self.assertEqual(run.stdout, "")
        self.assertEqual(run.stderr.count("\n"), 1, run.stderr)
        for text in says:
            self.assertIn(text, run.stderr)
        self.assertEqual(sorted(self.folder.rglob("*")), before, "something is left behind")

    def assertWorks(self, *arguments, environment=None):
        run = lutgen(*arguments, folder=self.folder, environment=environment)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stderr, "")
        return run.stdout
