# SPDX-License-Identifier: Apache-2.0
"""All tests of the Python package: python tests/python. They need the package, and use lutgen where $METAMER_BIN has it."""

import sys
import unittest
from pathlib import Path

if __name__ == "__main__":
    folder = str(Path(__file__).resolve().parent)
    suite = unittest.defaultTestLoader.discover(folder, top_level_dir=folder)
    sys.exit(not unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful())
