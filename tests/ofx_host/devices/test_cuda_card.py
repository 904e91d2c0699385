# SPDX-License-Identifier: Apache-2.0
"""The program for who has a CUDA card, on the tests' own driver: it compares bits, and says so where there is no card."""

import os
import re
import subprocess
import unittest
from pathlib import Path

PROGRAM = Path(os.environ["METAMER_BIN"]) / "metamer_cuda_card"
DRIVER = Path(os.environ["METAMER_LIB"]) / "libmetamer_cuda_library.so"


def run(driver, **more):
    environment = os.environ | {"METAMER_OFX_CUDA": str(driver), **more}
    return subprocess.run([PROGRAM, "61", "34"], capture_output=True, text=True, env=environment)


class CudaCard(unittest.TestCase):
    def test_bits_and_times(self):
        found = run(DRIVER)
        self.assertEqual(found.returncode, 0, found.stderr)
        looks = found.stdout.splitlines()[1:]
        self.assertEqual(len(looks), 4)
        for look in looks:
            self.assertRegex(look, r"bits equal; card [\d.]+ ms, processor's two threads [\d.]+ ms \([\d.]+ times\), a copy")

    def test_one_bit_is_found(self):
        found = run(DRIVER, METAMER_FLIP_A_BIT="1")
        self.assertEqual(found.returncode, 1)
        self.assertEqual(len(re.findall("DIFFER", found.stdout)), 4)

    def test_no_card(self):
        found = run("/nowhere/libcuda.so")
        self.assertEqual((found.returncode, found.stdout), (2, ""))
        self.assertIn("/nowhere/libcuda.so", found.stderr)
        self.assertEqual(len(found.stderr.splitlines()), 1)


if __name__ == "__main__":
    unittest.main()
