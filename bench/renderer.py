# SPDX-License-Identifier: Apache-2.0
"""The renderer against itself and against Mitsuba: noise against time.

Prints each figure and writes them to out/bench_renderer.json. A picture's error is the mean square difference of Y from a
long render with another seed; times are user CPU seconds of the program, so that a busy machine does not blur them.
Figures of two programs at equal time are products time x MSE: noise falls with the time spent.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import OpenEXR

REPOSITORY = Path(__file__).resolve().parent.parent
PROGRAM = Path(os.environ.get("METAMER_BIN", REPOSITORY / "build/release/bin")) / "spectral_ref"

CHART = """metamer_scene: 1
film: {{width: {width}, height: {height}}}
camera: {{origin: [0, 0, 10], target: [0, 0, 0], up: [0, 1, 0], fov_x: 34}}
integrator: {{max_depth: {depth}, wavelengths: {lanes}}}
spectra: {{lamp: {{illuminant: {lamp}, scale: 0.5}}}}
shapes:
  - chart: {{set: colorchecker, center: [0, 0, 0], half_u: [3, 0, 0], half_v: [0, 2, 0]}}
  - rectangle: {{center: [-3, 4, 6], half_u: [0.3, 0, 0], half_v: [0, 0, 0.3]}}
    emission: lamp
"""
GEL = """  - rectangle: {center: [-3, 3.8, 6], half_u: [2, 0, 0], half_v: [0, 0, 2]}
    gel: Lee 106 Primary Red
"""
BOX = """metamer_scene: 1
film: {{width: {width}, height: {height}}}
camera: {{origin: [0, 1.2, 7], target: [0, 1.2, 0], up: [0, 1, 0], fov_x: 40}}
integrator: {{max_depth: {depth}, wavelengths: 4}}
spectra: {{grey: {{constant: 0.5}}}}
shapes:
{lights}
  - rectangle: {{center: [0, 0, 1], half_u: [2, 0, 0], half_v: [0, 0, -2]}}
    diffuse: grey
  - rectangle: {{center: [0, 1.5, -1], half_u: [2, 0, 0], half_v: [0, 1.5, 0]}}
    diffuse: grey
  - sphere: {{center: [-0.8, 0.5, 1.2], radius: 0.5}}
    diffuse: grey
  - chart: {{set: colorchecker, center: [0.6, 1.2, 0], half_u: [0.9, 0, 0], half_v: [0, 0.6, 0]}}
"""
# Above the picture's upper edge, facing down: it lights, and is not seen.
WALL = """  - led_wall: {center: [0, 3.2, 0.5], half_u: [1.8, 0, 0], half_v: [0, 0, 1.4], picture: wall.exr,
               emitters: [LED-B1, LED-V1, LED-RGB1], scale: 0.02}"""
MANY = """  - mesh: many.obj
    emission: LED-B1"""
PRISM = """metamer_scene: 1
film: {{width: 96, height: 64}}
camera: {{origin: [0, 0, 8], target: [0, 0, 0], up: [0, 1, 0], fov_x: 40}}
integrator: {{max_depth: 12, wavelengths: {lanes}}}
spectra: {{lamp: {{illuminant: D65, scale: 0.2}}}}
shapes:
  - sphere: {{center: [0, 0, 0], radius: 1}}
    dielectric: {{index: {{cauchy: [1.5, 0.03]}}}}
  - rectangle: {{center: [0, 0, -2], half_u: [3, 0, 0], half_v: [0, 2, 0]}}
    diffuse: 0.6
  - rectangle: {{center: [-3, 2, 2], half_u: [0.5, 0.5, 0], half_v: [0, 0, 0.7]}}
    emission: lamp
"""


class Bench:
    def __init__(self, folder, size, samples):
        self.folder = folder
        self.size = size
        self.samples = samples
        self.figures = {}

    def write(self, name, text):
        (self.folder / f"{name}.yaml").write_text(text)
        return name

    def render(self, scene, samples, *options, seed=1):
        """Y, user seconds and peak memory in MiB of one render."""
        output = self.folder / "render.exr"
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(
            [PROGRAM, "render", f"{scene}.yaml", "-o", output, "--spp", str(samples), "--seed", str(seed), *options],
            cwd=self.folder,
            check=True,
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        pixels = OpenEXR.File(str(output), separate_channels=True).channels()
        return pixels["Y"].pixels.astype(float), after.ru_utime - before.ru_utime, after.ru_maxrss / 1024

    def reference(self, scene, samples=None):
        return self.render(scene, samples or 16 * self.samples, "--guiding", "on", seed=777)[0]

    def cost(self, scene, truth, *options, samples=None):
        """Time x MSE of Y, each with what starting the program and reading the scene takes taken off."""
        _, start, _ = self.render(scene, 1, *options)
        picture, seconds, _ = self.render(scene, samples or self.samples, *options)
        return max(seconds - start, 1e-3) * ((picture - truth) ** 2).mean()

    def say(self, name, value, wanted=""):
        self.figures[name] = value
        print(f"{name:60s} {value:10.4g}  {wanted}", flush=True)

    def chart(self, name, lamp, lanes=4, depth=2, extra=""):
        width, height = self.size
        text = CHART.format(width=width, height=height, lamp=lamp, lanes=lanes, depth=depth)
        return self.write(name, text + extra)

    def box(self, name, lights, depth=2):
        width, height = self.size
        return self.write(name, BOX.format(width=width, height=height, lights=lights, depth=depth))


def guiding(bench):
    cases = [("FL11", "FL11", "", ">= 2"), ("HP1", "HP1", "", ">= 2"), ("A, red gel", "A", GEL, ""),
             ("A, smooth", "A", "", ">= 0.95"), ("D65, smooth", "D65", "", ">= 0.95")]
    for label, lamp, extra, wanted in cases:
        scene = bench.chart("guiding", lamp, extra=extra)
        truth = bench.reference(scene)
        uniform = bench.cost(scene, truth, "--guiding", "off")
        guided = bench.cost(scene, truth, "--guiding", "on")
        bench.say(f"guided against uniform, equal time, chart under {label}", uniform / guided, wanted)


def lights(bench):
    rng = np.random.default_rng(5)
    y, x = np.mgrid[0:18, 0:32] / np.array([18, 32])[:, None, None]
    picture = np.stack([np.exp(-8 * (x - 0.3) ** 2), 0.2 + x, np.exp(-9 * (y - 0.5) ** 2)], -1)
    picture = (picture * rng.uniform(0, 1, (18, 32, 1)) ** 3).astype(np.float32)
    OpenEXR.File({}, {"RGB": picture}).write(str(bench.folder / "wall.exr"))
    # Small triangles near the back wall, facing it: those nearby light a point, and power says nothing of that. The camera
    # sees their black backs.
    count = 100_000
    centres = rng.uniform([-1.9, 0.05, -0.9], [1.9, 2.9, -0.6], (count, 1, 3))
    corners = centres + 3e-3 * np.array([[0, 0, 0], [0, 1, 0], [1, 0, 0]])
    lines = [f"v {a:.6f} {b:.6f} {c:.6f}" for a, b, c in corners.reshape(-1, 3)]
    lines += [f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}" for i in range(count)]
    (bench.folder / "many.obj").write_text("\n".join(lines) + "\n")


def restir(bench):
    lights(bench)
    for label, light, wanted in [("LED wall 32 x 18", WALL, ">= 4"), ("100000 emitters", MANY, ">= 10")]:
        scene = bench.box("restir", light)
        truth = bench.reference(scene, 8 * bench.samples)
        plain = bench.cost(scene, truth, samples=bench.samples)
        for target in ("hero", "lanes"):
            resampled = bench.cost(scene, truth, "--restir", target, samples=bench.samples)
            bench.say(f"ReSTIR ({target}) against NEE, equal time, {label}", plain / resampled, wanted)


def lanes(bench):
    for label in ("chart under FL11", "chart under A", "prism"):
        truth = None
        for count in (1, 4, 8, 16):
            if label == "prism":
                scene = bench.write("lanes", PRISM.format(lanes=count))
            else:
                scene = bench.chart("lanes", label.split()[-1], lanes=count)
            if truth is None:
                truth = bench.reference(scene, 64 * bench.samples)
            bench.say(f"time x MSE, {label}, {count} lanes", bench.cost(scene, truth))


def memory(bench):
    scene = bench.write(
        "memory",
        CHART.format(width=1920, height=1080, lamp="FL11", lanes=4, depth=4).replace(
            "height: 1080", "height: 1080, bins: {from: 400, to: 775, step: 25}"),
    )
    _, _, peak = bench.render(scene, 10, "--guiding", "on", "--restir", "lanes")
    bench.say("peak memory in MiB, 1920 x 1080, guiding, ReSTIR, 16 bins", peak, "<= 2048")


def mitsuba(bench):
    for lamp in ("A", "FL11"):
        scene = bench.chart("peer", lamp)
        truth = bench.reference(scene)
        ours = min(bench.cost(scene, truth, "--guiding", mode) for mode in ("off", "on"))
        for variant in ("scalar_spectral", "llvm_ad_spectral"):
            output = bench.folder / "mitsuba.npz"
            program = [sys.executable, REPOSITORY / "tests/oracle/mitsuba_chart.py", lamp, *map(str, bench.size),
                       str(bench.samples), variant, output]
            # Apart: LLVM may take its whole program down where it does not know the processor.
            if subprocess.run(program, capture_output=True).returncode != 0:
                print(f"Mitsuba {variant} does not run here")
                continue
            result = np.load(output)
            theirs = float(result["seconds"]) * ((result["picture"] - truth) ** 2).mean()
            bench.say(f"time x MSE against Mitsuba {variant}, chart under {lamp}", ours / theirs, "<= 1/3")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", default=["guiding", "restir", "lanes", "memory", "mitsuba"])
    parser.add_argument("--size", default="96x64")
    parser.add_argument("--samples", type=int, default=64)
    arguments = parser.parse_args()
    parts = {"guiding": guiding, "restir": restir, "lanes": lanes, "memory": memory, "mitsuba": mitsuba}
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(Path(folder), tuple(int(side) for side in arguments.size.split("x")), arguments.samples)
        for part in arguments.parts:
            parts[part](bench)
    output = REPOSITORY / "out/bench_renderer.json"
    output.parent.mkdir(exist_ok=True)
    output.write_text(json.dumps(bench.figures, indent=2) + "\n")


if __name__ == "__main__":
    main()
