# SPDX-License-Identifier: Apache-2.0
"""The plug-in's kernels through oclgrind: no race, nothing read that was not written, nothing beyond a buffer's end."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = Path(os.environ["METAMER_BIN"]) / "ofx_opencl_tests"
DRIVERS = [Path("/usr/lib/oclgrind/liboclgrind-rt-icd.so")]


class Races(unittest.TestCase):
    def run_kernels(self, **more):
        """Exit code and words of the test that runs every kernel once, on oclgrind alone."""
        driver = next((each for each in DRIVERS if each.is_file()), None)
        if driver is None:
            self.skipTest("no oclgrind: races and reads out of bounds are not looked for; install oclgrind")
        with tempfile.TemporaryDirectory() as vendors:
            (Path(vendors) / "oclgrind.icd").write_text(f"{driver}\n")
            environment = os.environ | {"OCL_ICD_VENDORS": vendors, "OCLGRIND_DATA_RACES": "1", "OCLGRIND_UNINITIALIZED": "1", **more}
            run = subprocess.run([PROGRAM, "--gtest_filter=OfxDevice.EveryKernelOnSmallFrames", "--gtest_brief=1"],
                                 capture_output=True, text=True, env=environment, errors="replace")
        return run.returncode, run.stdout + run.stderr

    def test_nothing_is_found(self):
        code, words = self.run_kernels()
        self.assertEqual(code, 0, words)
        self.assertIn("[  PASSED  ] 1 test", words)  # and none is skipped
        for sign in ("Invalid", "race", "ninitialized"):
            self.assertNotIn(sign, words)

    def test_what_is_there_is_found(self):
        code, words = self.run_kernels(METAMER_HALF_BUFFERS="1")
        self.assertNotEqual(code, 0)
        self.assertIn("Invalid read", words)


if __name__ == "__main__":
    unittest.main()
