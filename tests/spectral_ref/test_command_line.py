# SPDX-License-Identifier: Apache-2.0
"""spectral_ref's contract with the shell: exit codes, one line of stderr, files whole or not at all, equal bytes."""

import json
import os
import re
import resource
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np
import OpenEXR

PROGRAM = Path(os.environ["METAMER_BIN"]) / "spectral_ref"

SCENE = """metamer_scene: 1
film: {width: 40, height: 32, observer: CIE 1931 2, space: XYZ, bins: {from: 400, to: 700, step: 50}}
camera: {origin: [0, 0, 9], target: [0, 0, 0], up: [0, 1, 0], fov_x: 12}
integrator: {max_depth: 6, russian_roulette: 5, wavelengths: 4}
spectra: {lamp: {illuminant: A, scale: 12}, paint: {wavelengths: [400, 700], values: [0.2, 0.6]}}
shapes:
  - rectangle: {center: [0, 0, 0], half_u: [1, 0, 0], half_v: [0, 1, 0]}
    diffuse: paint
  - rectangle: {center: [-3, 4, 6], half_u: [1, 0, 0], half_v: [0, 0, 1]}
    emission: lamp
"""


class CommandLine(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "scene.yaml").write_text(SCENE)

    def run_program(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True)

    def works(self, *arguments):
        result = self.run_program(*arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ""), arguments)
        return result.stdout

    def fails(self, *arguments, code, says=""):
        before = sorted(path.name for path in self.folder.iterdir())
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, code, (arguments, result.stderr))
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertTrue(result.stderr.startswith("spectral_ref: "), result.stderr)
        self.assertIn(says, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), before)

    def read(self, name):
        return (self.folder / name).read_bytes()

    def test_help(self):
        for arguments in (["--help"], ["render", "--help"], ["merge", "--help"], ["measure", "--help"], ["--version"]):
            self.assertNotEqual(self.works(*arguments), "")

    def test_usage_errors(self):
        for arguments in (
            [],
            ["draw"],
            ["render", "scene.yaml"],
            ["render", "-o", "a.exr"],
            ["render", "scene.yaml", "-o", "a.exr", "--spp", "0"],
            ["render", "scene.yaml", "-o", "a.exr", "--spp", "4x"],
            ["render", "scene.yaml", "-o", "a.exr", "--samples", "4:2"],
            ["render", "scene.yaml", "-o", "a.exr", "--samples", "4"],
            ["render", "scene.yaml", "-o", "a.exr", "--samples", "0:4", "--spp", "4"],
            ["render", "scene.yaml", "-o", "a.exr", "--guiding", "maybe"],
            ["render", "scene.yaml", "-o", "a.exr", "--restir", "all"],
            ["render", "scene.yaml", "-o", "a.exr", "--threads", "0"],
            ["render", "scene.yaml", "-o", "a.exr", "--seed", "-1"],
            ["render", "scene.yaml", "-o", "a.exr", "--guide-dump", "a.json", "--guide-pixel", "1,1"],
            ["render", "scene.yaml", "-o", "a.exr", "--guiding", "on", "--guide-dump", "a.json"],
            ["render", "scene.yaml", "-o", "a.exr", "--guiding", "on", "--guide-dump", "a.json", "--guide-pixel", "40,1"],
            ["render", "scene.yaml", "-o", "a.exr", "--guiding", "on", "--guide-dump", "a.json", "--guide-pixel", "4x1"],
            ["merge", "-o", "a.exr"],
        ):
            with self.subTest(arguments):
                self.fails(*arguments, code=2)

    def test_failures(self):
        (self.folder / "bad.yaml").write_text(SCENE.replace("diffuse: paint", "diffuse: pain"))
        self.fails("render", "none.yaml", "-o", "a.exr", code=1, says="no such file")
        self.fails("render", "bad.yaml", "-o", "a.exr", code=1, says="bad.yaml:8:14")
        self.fails("render", "scene.yaml", "-o", "a.png", code=1, says="must be .exr")
        self.fails("render", "scene.yaml", "-o", "no/such/a.exr", "--spp", "1", code=1, says="folder")
        self.fails("merge", "scene.yaml", "-o", "a.exr", code=1, says="cannot be read")
        self.fails("measure", "none.exr", code=1, says="cannot be read")

    def test_the_file(self):
        self.works("render", "scene.yaml", "-o", "a.exr", "--spp", "16")
        file = OpenEXR.File(str(self.folder / "a.exr"), separate_channels=True)
        header = file.header()
        pixels = {name: channel.pixels for name, channel in file.channels().items()}
        names = set(pixels)
        bins = {f"S0.{nm},000000nm" for nm in range(400, 701, 50)}
        self.assertEqual(names, {"R", "G", "B", "Y", "variance.Y", "samples"} | bins)
        self.assertEqual(header["spectralLayoutVersion"], "1.0")
        self.assertEqual(header["emissiveUnits"], "W.m^-2.sr^-1")  # the layout's word for radiance per nm
        np.testing.assert_allclose(header["chromaticities"], [1, 0, 0, 1, 0, 0, 1 / 3, 1 / 3], rtol=1e-6)
        for channel in pixels.values():
            self.assertEqual(channel.dtype, np.float32)
            self.assertEqual(channel.shape, (32, 40))
            self.assertTrue(np.isfinite(channel).all())
        np.testing.assert_array_equal(pixels["samples"], 16)
        np.testing.assert_allclose(pixels["G"], pixels["Y"], rtol=1e-6)
        self.assertGreater(pixels["variance.Y"].mean(), 0)

    def test_chromaticities_are_the_space_s(self):
        def written(space, *arguments):
            (self.folder / "space.yaml").write_text(SCENE.replace("space: XYZ", "space: " + space))
            self.works("render", "space.yaml", "-o", "space.exr", *arguments)
            return OpenEXR.File(str(self.folder / "space.exr"), separate_channels=True).header().get("chromaticities")

        acescg = [0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767]
        np.testing.assert_allclose(written("ACEScg", "--spp", "1"), acescg, rtol=1e-6)
        self.assertIsNone(written("native", "--spp", "1"))
        # Parts carry them, and their merge.
        np.testing.assert_allclose(written("ACEScg", "--samples", "0:1"), acescg, rtol=1e-6)
        self.works("merge", "space.exr", "-o", "merged.exr")
        self.works("render", "space.yaml", "-o", "whole.exr", "--spp", "1")
        self.assertEqual(self.read("merged.exr"), self.read("whole.exr"))

    def test_same_bytes_whatever_the_threads_and_parts(self):
        self.works("render", "scene.yaml", "-o", "whole.exr", "--spp", "24")
        self.works("render", "scene.yaml", "-o", "one.exr", "--spp", "24", "--threads", "1")
        self.assertEqual(self.read("whole.exr"), self.read("one.exr"))
        self.works("render", "scene.yaml", "-o", "a.exr", "--samples", "0:7")
        self.works("render", "scene.yaml", "-o", "b.exr", "--samples", "7:24", "--threads", "1")
        self.works("merge", "b.exr", "a.exr", "-o", "merged.exr")
        self.assertEqual(self.read("whole.exr"), self.read("merged.exr"))
        self.works("merge", "b.exr", "-o", "part.exr", "--keep-state")
        self.works("merge", "part.exr", "a.exr", "-o", "merged.exr")
        self.assertEqual(self.read("whole.exr"), self.read("merged.exr"))
        self.fails("merge", "a.exr", "a.exr", "-o", "c.exr", code=1, says="overlap")
        self.fails("merge", "a.exr", "whole.exr", "-o", "c.exr", code=1, says="--samples")
        self.works("render", "scene.yaml", "-o", "other.exr", "--samples", "24:30", "--seed", "1")
        self.fails("merge", "a.exr", "other.exr", "-o", "c.exr", code=1, says="seed")

    def test_parts_that_are_missing_or_damaged_are_named(self):
        for name, samples in (("a", "0:4"), ("b", "6:8"), ("c", "4:6")):
            self.works("render", "scene.yaml", "-o", name + ".exr", "--samples", samples)
        self.fails("merge", "a.exr", "b.exr", "-o", "m.exr", "--expect", "0:12", code=1, says="samples '4:6 8:12'")
        self.fails("merge", "a.exr", "b.exr", "-o", "m.exr", "--expect", "0:8", code=1, says="--samples 4:6")
        self.fails("merge", "a.exr", "b.exr", "c.exr", "-o", "m.exr", "--expect", "0:6", code=1, says="more than 0:6")
        for bad in ("8:0", "0", "nan:4"):
            self.fails("merge", "a.exr", "-o", "m.exr", "--expect", bad, code=2, says="FIRST:END")
        self.works("merge", "a.exr", "b.exr", "c.exr", "-o", "m.exr", "--expect", "0:8")
        # A bit of the sums that changed on its way: in the pixels of the part, and in its description.
        for change in (lambda part: part.channels["w000000"].pixels.__setitem__((3, 4), 7), None):
            file = OpenEXR.File(str(self.folder / "b.exr"), separate_channels=True)
            if change:
                change(file.parts[1])
            else:
                state = file.parts[1].header["metamer:state"]
                file.parts[1].header["metamer:state"] = state.replace("[[6,8]]", "[[5,7]]")
                self.assertNotEqual(file.parts[1].header["metamer:state"], state)
            file.write(str(self.folder / "damaged.exr"))
            self.fails("merge", "a.exr", "damaged.exr", "-o", "m2.exr", code=1, says="damaged")
        file = OpenEXR.File(str(self.folder / "b.exr"), separate_channels=True)
        self.assertEqual(len(file.parts[0].header["metamer:build"]), 16)
        # Half a file.
        data = self.read("b.exr")
        (self.folder / "half.exr").write_bytes(data[:len(data) // 2])
        self.fails("merge", "a.exr", "half.exr", "-o", "m2.exr", code=1, says="half.exr")
        self.assertFalse((self.folder / "m2.exr").exists())

    def test_guide_dump(self):
        scene = SCENE.replace("illuminant: A", "illuminant: FL11")
        (self.folder / "scene.yaml").write_text(scene)
        self.works("render", "scene.yaml", "-o", "a.exr", "--spp", "4", "--guiding", "on", "--guide-dump", "a.json",
                   "--guide-pixel", "20,16", "--guide-pixel", "0,0")
        dump = json.loads(self.read("a.json"))
        self.assertEqual([(p["x"], p["y"]) for p in dump["pixels"]], [(20, 16), (0, 0)])
        for pixel in dump["pixels"]:
            self.assertAlmostEqual(sum(pixel["density"]), 1, places=3)
            self.assertAlmostEqual(sum(pixel["histogram"]), 1, places=6)
            self.assertEqual((len(pixel["density"]), len(pixel["histogram"])), (401, 20))
        # FL11 has its strongest line at 545 nm: in the bin from 540 nm.
        self.assertEqual(int(np.argmax(dump["pixels"][0]["histogram"])), 8)

    def test_a_killed_render_goes_on(self):
        scene = SCENE.replace("width: 40, height: 32", "width: 120, height: 100")
        (self.folder / "scene.yaml").write_text(scene)
        self.works("render", "scene.yaml", "-o", "whole.exr", "--spp", "400")
        for number in (signal.SIGKILL, signal.SIGINT):
            with self.subTest(number):
                process = subprocess.Popen(
                    [PROGRAM, "render", "scene.yaml", "-o", "cut.exr", "--spp", "400", "--checkpoint", "0"],
                    cwd=self.folder,
                    stderr=subprocess.PIPE,
                )
                checkpoint = self.folder / "cut.exr.checkpoint"
                while not checkpoint.exists() and process.poll() is None:
                    time.sleep(0.01)
                process.send_signal(number)
                said = process.communicate()[1].decode()
                self.assertEqual(process.returncode, -number)
                self.assertEqual(re.sub("[0-9]+", "N", said), {
                    signal.SIGKILL: "",
                    signal.SIGINT: "spectral_ref: stopped after N samples; go on with --resume\n"}[number])
                self.assertTrue(checkpoint.exists())
                self.assertFalse((self.folder / "cut.exr").exists())
                self.fails("render", "scene.yaml", "-o", "cut.exr", "--spp", "400", "--resume", "--seed", "1",
                           code=1, says="checkpoint")
                self.works("render", "scene.yaml", "-o", "cut.exr", "--spp", "400", "--resume")
                self.assertEqual(self.read("whole.exr"), self.read("cut.exr"))
                self.assertFalse(checkpoint.exists())
                (self.folder / "cut.exr").unlink()

    def test_a_checkpoint_that_cannot_be_written(self):
        # A checkpoint that cannot be written (its place is taken by a folder) is said once; the picture still comes.
        (self.folder / "a.exr.checkpoint").mkdir()
        result = self.run_program("render", "scene.yaml", "-o", "a.exr", "--seconds", "0.6", "--checkpoint", "0")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertIn("goes on without checkpoints", result.stderr)
        self.assertTrue((self.folder / "a.exr").exists())

    def test_a_full_disk_while_checkpointing(self):
        # Files may grow to the size of the picture, not to that of a checkpoint, which holds exact sums.
        self.works("render", "scene.yaml", "-o", "a.exr", "--seconds", "0.3")
        checkpoint = self.folder / "a.exr.checkpoint"
        before = checkpoint.read_bytes()
        limit = 2 * (self.folder / "a.exr").stat().st_size
        self.assertGreater(len(before), limit)

        def limited():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # then writing fails, as on a full disk
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

        result = subprocess.run(
            [PROGRAM, "render", "scene.yaml", "-o", "a.exr", "--seconds", "0.6", "--checkpoint", "0", "--resume"],
            cwd=self.folder, capture_output=True, text=True, preexec_fn=limited,
            env={**os.environ, "LLVM_PROFILE_FILE": os.devnull})  # else the limit is that of counts of coverage, too
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertIn("a.exr.checkpoint", result.stderr)
        self.assertIn("goes on without checkpoints", result.stderr)
        self.assertEqual(checkpoint.read_bytes(), before)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()),
                         ["a.exr", "a.exr.checkpoint", "scene.yaml"])
        self.works("render", "scene.yaml", "-o", "a.exr", "--seconds", "0.3", "--resume")

    def test_seconds_and_target_error(self):
        start = time.monotonic()
        self.works("render", "scene.yaml", "-o", "a.exr", "--seconds", "0.5")
        self.assertLess(time.monotonic() - start, 30)
        self.assertTrue((self.folder / "a.exr.checkpoint").exists())
        self.works("render", "scene.yaml", "-o", "b.exr", "--target-error", "2")
        self.assertTrue((self.folder / "b.exr").exists())

    def test_target_error_stops_in_time_and_at_the_cap(self):
        def samples(*arguments):
            self.works("render", "scene.yaml", "-o", "a.exr", *arguments)
            return int(OpenEXR.File(str(self.folder / "a.exr"), separate_channels=True).channels()["samples"].pixels.max())

        # The error falls with the root of the samples: half of it takes about four times as many, no more.
        coarse = samples("--target-error", "0.4")
        fine = samples("--target-error", "0.2")
        self.assertLess(coarse, fine)
        self.assertLess(fine, 10 * coarse)
        # A cap below that ends the render, one far above it does not.
        self.assertEqual(samples("--target-error", "0.2", "--spp", str(coarse)), coarse)
        self.assertLess(samples("--target-error", "0.2", "--spp", "100000000"), 10 * coarse)
        self.assertTrue((self.folder / "a.exr.checkpoint").exists())
        # ReSTIR deals samples out in blocks of 16: halves to compare come late.
        self.assertGreater(samples("--target-error", "5", "--restir", "lanes"), 16)

    def test_measure(self):
        self.works("render", "scene.yaml", "-o", "a.exr", "--spp", "64")
        report = json.loads(self.works("measure", "a.exr", "--patch", "middle=16,12,8,8", "--json"))
        patch = report["patches"][0]
        self.assertEqual((patch["name"], patch["area"]), ("middle", [16, 12, 8, 8]))
        low, high = patch["interval95"]
        self.assertTrue(low < patch["Y"] < high)
        self.assertEqual(report["wavelengths"], list(range(400, 701, 50)))
        table = self.works("measure", "a.exr", "--grid", "4x2")
        self.assertEqual(len(table.splitlines()), 9)
        self.assertRegex(table, re.compile("^8 ", re.MULTILINE))


if __name__ == "__main__":
    unittest.main()
