# SPDX-License-Identifier: Apache-2.0
"""test_moved_tree.py PREFIX OPENCOLORIO OPENIMAGEIO: programs of an install tree that was moved find what it carries.

Each library is release or system, as METAMER_OCIO and METAMER_OIIO say.
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PREFIX, OCIO, OIIO = Path(sys.argv[1]), sys.argv[2], sys.argv[3]


def loaded(library, program, environment):
    """The file of a library that a program loads; none where it loads only others (libOpenColorIO.so.2.1)."""
    run = subprocess.run(["ldd", program], capture_output=True, text=True, check=True, env=environment)
    found = re.search(rf"^\s*{re.escape(library)} => (\S+)", run.stdout, re.MULTILINE)
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

    def carries(self, pattern, title, programs, owner):
        [library] = PREFIX.glob(f"lib*/metamer/**/{pattern}")
        # A studio's shell may lead to other releases.
        others = [str(one.parent) for one in Path("/usr/lib").glob(f"*/{pattern}")]
        for path in ("", os.pathsep.join(others)):
            for program in programs:
                shell = {**self.shell, "LD_LIBRARY_PATH": path}
                self.assertEqual(loaded(library.name, PREFIX / "bin" / program, shell), library.resolve(), f"{program}, {path}")
        licences = PREFIX / "share" / "metamer" / "licences" / title
        [licence] = licences.glob("LICENSE*")
        self.assertIn(owner, licence.read_text())
        self.assertTrue((licences / "THIRD-PARTY.md").is_file())

    @unittest.skipIf(OCIO == "system", "the system's OpenColorIO is not carried")
    def test_the_tree_carries_opencolorio(self):
        self.carries("libOpenColorIO.so", "OpenColorIO", ("lutgen", "lutgen-pictures"), "Contributors to the OpenColorIO Project")

    @unittest.skipIf(OIIO == "system", "the system's OpenImageIO is not carried")
    def test_the_tree_carries_openimageio(self):
        programs = ("lutgen-pictures", "spectral_ref")
        self.carries("libOpenImageIO.so.*", "OpenImageIO", programs, "Apache License")
        self.carries("libOpenImageIO_Util.so.*", "OpenImageIO", programs, "Apache License")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
