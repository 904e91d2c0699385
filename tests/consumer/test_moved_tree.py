# SPDX-License-Identifier: Apache-2.0
"""test_moved_tree.py PREFIX release|system: programs of an install tree that was moved find what it carries."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PREFIX, OCIO = Path(sys.argv[1]), sys.argv[2]
LIBRARY = "libOpenColorIO.so"


def loaded(program, environment):
    """The file of libOpenColorIO.so that a program loads; none where it loads only others (.so.2.1)."""
    run = subprocess.run(["ldd", program], capture_output=True, text=True, check=True, env=environment)
    found = re.search(rf"^\s*{re.escape(LIBRARY)} => (\S+)", run.stdout, re.MULTILINE)
    return found and Path(found.group(1)).resolve()


class MovedTree(unittest.TestCase):
    def setUp(self):
        # Neither the cache that the build was linked from, nor tables named by a variable.
        self.shell = {key: value for key, value in os.environ.items() if key not in ("METAMER_DATA", "OCIO")}
        self.shell["XDG_CACHE_HOME"] = self.shell["HOME"] = "/nonexistent"

    def test_a_table_is_baked(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "a.ctf"
            run = subprocess.run([PREFIX / "bin" / "lutgen", "bake", "--illuminant-in", "D65", "--illuminant-out", "A", "-o", file],
                                 env=self.shell, capture_output=True, text=True, check=False)
            self.assertEqual((run.returncode, run.stderr), (0, ""))
            self.assertTrue(file.is_file())

    @unittest.skipIf(OCIO == "system", "the system's OpenColorIO is not carried")
    def test_the_tree_carries_opencolorio(self):
        [library] = PREFIX.glob(f"lib*/**/{LIBRARY}")
        # A studio's shell may lead to other releases.
        others = [str(one.parent) for one in Path("/usr/lib").glob(f"*/{LIBRARY}")]
        for path in ("", os.pathsep.join(others)):
            for program in ("lutgen", "lutgen-pictures"):
                shell = {**self.shell, "LD_LIBRARY_PATH": path}
                self.assertEqual(loaded(PREFIX / "bin" / program, shell), library.resolve(), f"{program}, {path}")
        licences = PREFIX / "share" / "metamer" / "licences" / "OpenColorIO"
        self.assertIn("Contributors to the OpenColorIO Project", (licences / "LICENSE").read_text())
        self.assertTrue((licences / "THIRD-PARTY.md").is_file())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
