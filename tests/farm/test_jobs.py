# SPDX-License-Identifier: Apache-2.0
"""What `spectral_ref job` and `lutgen job` write, run by Open Job Description's own command line and, for Slurm,
script by script as its scheduler would."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BIN = Path(os.environ["METAMER_BIN"])
OPENJD = Path(sys.executable).parent / "openjd"
FILES = Path(__file__).resolve().parents[2] / "demo/files"


class JobTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        # A name that shells and templates could trip over.
        self.folder = Path(folder.name) / "it's a show"
        self.folder.mkdir()
        for name in ("scene.yaml", "day_to_sodium.yaml", "night.yaml"):
            shutil.copy(FILES / name, self.folder)

    def run_in(self, *words, code=0, **more):
        result = subprocess.run([str(word) for word in words], cwd=self.folder, capture_output=True, text=True, timeout=240,
                                check=False, **more)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def refused(self, *words, says, code=2):
        result = self.run_in(*words, code=code)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertIn(says, result.stderr)


class Render(JobTest):
    def job(self, *words):
        return self.run_in(BIN / "spectral_ref", "job", "scene.yaml", "-o", "picture.exr", "--spp", 96, *words)

    def single(self):
        self.run_in(BIN / "spectral_ref", "render", "scene.yaml", "-o", "single.exr", "--spp", 96, "--restir", "lanes")
        return (self.folder / "single.exr").read_bytes()

    def test_open_job_description(self):
        said = self.job("--chunks", 6, "--openjd", "job", "--", "--restir", "lanes").stdout
        self.assertIn("openjd run job/template.json --job-param file://job/parameters.json", said)
        self.run_in(OPENJD, "check", "job/template.json")
        # A worker dies at one chunk: the program is not what it should be there.
        broken = self.folder / "worker"
        broken.write_text(f'#!/bin/sh\ncase "$*" in *48:64*) exit 1;; esac\nexec {BIN}/spectral_ref "$@"\n')
        broken.chmod(0o755)
        run = [OPENJD, "run", "job/template.json", "--job-param", "file://job/parameters.json"]
        self.run_in(*run, "--job-param", f"Program={broken}", code=1)
        self.assertFalse((self.folder / "picture.exr").exists())
        done = {path.name: path.stat().st_mtime_ns for path in (self.folder / "job/parts").iterdir()}
        self.assertIn("part.0-16.exr", done)
        self.run_in(*run)
        self.assertEqual((self.folder / "picture.exr").read_bytes(), self.single())
        for name, when in done.items():
            self.assertEqual((self.folder / "job/parts" / name).stat().st_mtime_ns, when, "rendered again")

    def test_slurm(self):
        self.job("--chunks", 4, "--slurm", "job", "--", "--restir", "lanes", "--threads", 1)
        scripts = {name: (self.folder / "job" / name).read_text() for name in ("render.sh", "merge.sh", "submit.sh")}
        self.assertIn("#SBATCH --array=0-3\n", scripts["render.sh"])
        self.assertIn('--dependency="afterok:$render" --kill-on-invalid-dep=yes', scripts["submit.sh"])
        # Without its parts the merge says what is missing, and writes nothing.
        self.refused("bash", "job/merge.sh", says="part.0-16.exr", code=1)
        for task in range(4):
            self.run_in("bash", "job/render.sh", env={**os.environ, "SLURM_ARRAY_TASK_ID": str(task)})
        self.run_in("bash", "job/merge.sh")
        self.assertEqual((self.folder / "picture.exr").read_bytes(), self.single())
        # submit.sh, with a scheduler that says what it was given.
        fake = self.folder / "sbatch"
        fake.write_text('#!/bin/sh\necho "$@" >> calls\nwc -l < calls\n')
        fake.chmod(0o755)
        self.run_in("sh", "job/submit.sh", "-p", "night", env={**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"})
        self.assertEqual((self.folder / "job/calls").read_text().splitlines(),
                         ["--parsable -p night render.sh", "--parsable --dependency=afterok:1 --kill-on-invalid-dep=yes -p night merge.sh"])

    def test_resumed_by_name(self):
        part = ["render", "scene.yaml", "-o", "part.exr", "--samples", "0:16", "--resume"]
        self.run_in(BIN / "spectral_ref", *part)
        self.assertIn("are there already", self.run_in(BIN / "spectral_ref", *part).stderr)
        self.refused(BIN / "spectral_ref", *part, "--seed", 3, says="another scene, build, options or range", code=1)

    def test_progress(self):
        said = self.run_in(BIN / "spectral_ref", "render", "scene.yaml", "-o", "a.exr", "--seconds", 2.5, "--progress",
                           "openjd").stdout
        shares = [float(line.split()[1]) for line in said.splitlines() if line.startswith("openjd_progress: ")]
        self.assertGreaterEqual(len(shares), 1, said)
        self.assertEqual(shares, sorted(shares))
        self.assertIn("openjd_status: ", said)

    def test_refused(self):
        job = [BIN / "spectral_ref", "job", "scene.yaml", "-o", "picture.exr", "--spp", 96]
        self.refused(*job, "--chunks", 7, "--openjd", "job", says="--chunks: 7")
        self.refused(*job, "--chunks", 2, says="--openjd DIR or --slurm DIR")
        self.refused(*job, "--chunks", 2, "--openjd", "job", "--", "--restir", "lane", says="--restir")
        (self.folder / "scene.yaml").write_text("metamer_scene: 1\nfilm: {width: 0}\n")
        self.refused(*job, "--chunks", 2, "--openjd", "job", says="scene.yaml:2", code=1)
        self.assertFalse((self.folder / "job").exists())


class Lutgen(JobTest):
    def test_frames(self):
        self.run_in(BIN / "spectral_ref", "render", "scene.yaml", "-o", "shot.1.exr", "--spp", 1)
        for frame in (2, 3, 4, 7):
            shutil.copy(self.folder / "shot.1.exr", self.folder / f"shot.{frame}.exr")
        self.run_in(BIN / "lutgen", "job", "apply", "day_to_sodium.yaml", "shot.#.exr".replace("#", "%d"), "relit.%d.exr",
                    "--frames-per-task", 3, "--openjd", "job", "--", "--picture-space", "ACEScg", "--quiet")
        template = json.loads((self.folder / "job/template.json").read_text())
        [frames] = template["steps"][0]["parameterSpace"]["taskParameterDefinitions"]
        self.assertEqual(frames["range"], ["1-3", "4,7"])
        self.run_in(OPENJD, "run", "job/template.json", "--job-param", "file://job/parameters.json")
        self.run_in(BIN / "lutgen", "apply", "day_to_sodium.yaml", "shot.7.exr", "one.exr", "--picture-space", "ACEScg")
        self.assertEqual((self.folder / "relit.7.exr").read_bytes(), (self.folder / "one.exr").read_bytes())
        self.refused(BIN / "lutgen", "job", "apply", "day_to_sodium.yaml", "shot.%d.exr", "relit.%d.exr", "--openjd", "job",
                     "--", "--engine", "mup", says="--engine")

    def test_looks(self):
        self.run_in(BIN / "lutgen", "job", "bake", "day_to_sodium.yaml", "night.yaml", "-o", "looks", "--format", "cube",
                    "--openjd", "job", "--", "--size", 9)
        self.run_in(OPENJD, "run", "job/template.json", "--job-param", "file://job/parameters.json")
        self.run_in(BIN / "lutgen", "bake", "night.yaml", "-o", "night.cube", "--size", 9)
        self.assertEqual((self.folder / "looks/night.cube").read_bytes(), (self.folder / "night.cube").read_bytes())
        self.refused(BIN / "lutgen", "job", "bake", "night.yaml", "night.yaml", "-o", "looks", "--openjd", "job",
                     says="is another recipe's too", code=1)


if __name__ == "__main__":
    unittest.main()
