# SPDX-License-Identifier: Apache-2.0
"""Scenes that the renderer is measured on, and runs of it: processor seconds, so that a busy machine blurs less.

A picture's error is the mean square difference from a long render with another seed.
"""

import os
import subprocess
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np
import OpenEXR

WIDTH, HEIGHT = 192, 128

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
# Closed, with partitions and balls in it, lit by lamps close to its walls that face them.
ROOM = """metamer_scene: 1
film: {width: 192, height: 128}
camera: {origin: [0, 1.5, 3.8], target: [0, 1.3, 0], up: [0, 1, 0], fov_x: 70}
integrator: {max_depth: 6, wavelengths: 4}
spectra: {grey: {constant: 0.5}}
shapes:
  - mesh: room.obj
    emission: LED-B1
  - sphere: {center: [-1, 0.5, 1], radius: 0.5}
    diffuse: grey
  - sphere: {center: [1.2, 0.6, 0.6], radius: 0.6}
    diffuse: grey
"""
WALLS = [((0, 0, 0), (4, 0, 0), (0, 0, -4)), ((0, 3, 0), (4, 0, 0), (0, 0, 4)), ((0, 1.5, -4), (4, 0, 0), (0, 1.5, 0)),
         ((0, 1.5, 4), (-4, 0, 0), (0, 1.5, 0)), ((-4, 1.5, 0), (0, 0, -4), (0, 1.5, 0)), ((4, 1.5, 0), (0, 0, 4), (0, 1.5, 0))]
PARTITIONS = [(-2, -1), (0, -2), (2, -1)]
PRISM = """metamer_scene: 1
film: {{width: {width}, height: {height}}}
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


def chart(lamp, lanes=4, depth=2, width=WIDTH, height=HEIGHT, extra=""):
    return CHART.format(width=width, height=height, lamp=lamp, lanes=lanes, depth=depth) + extra


def box(lights, depth=2, width=WIDTH, height=HEIGHT):
    return BOX.format(width=width, height=height, depth=depth, lights=lights)


def room():
    """Of room.obj's 100,000 emitters; partitions have a front on either side."""
    sides = [((x, 1, z - back), (0.8 * sign, 0, 0), (0, 1, 0)) for x, z in PARTITIONS for sign, back in ((1, 0), (-1, 0.05))]
    return ROOM + "".join(f"  - rectangle: {{center: {list(c)}, half_u: {list(u)}, half_v: {list(v)}}}\n    diffuse: grey\n"
                          for c, u, v in WALLS + sides)


def prism(lanes):
    return PRISM.format(width=WIDTH, height=HEIGHT, lanes=lanes)


def write_triangles(path, corners):
    """@param corners  triangles x 3 x 3"""
    lines = [f"v {a:.6f} {b:.6f} {c:.6f}" for a, b, c in corners.reshape(-1, 3)]
    lines += [f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}" for i in range(len(corners))]
    path.write_text("\n".join(lines) + "\n")


def write_lights(folder):
    """wall.exr, 32 x 18 LEDs of different drives; many.obj and room.obj, 100,000 small emitting triangles each."""
    rng = np.random.default_rng(5)
    y, x = np.mgrid[0:18, 0:32] / np.array([18, 32])[:, None, None]
    picture = np.stack([np.exp(-8 * (x - 0.3) ** 2), 0.2 + x, np.exp(-9 * (y - 0.5) ** 2)], -1)
    picture = (picture * rng.uniform(0, 1, (18, 32, 1)) ** 3).astype(np.float32)
    OpenEXR.File({}, {"RGB": picture}).write(str(folder / "wall.exr"))
    # Near the back wall, facing it: those nearby light a point, and power says nothing of that. The camera sees their
    # black backs.
    count = 100_000
    centres = rng.uniform([-1.9, 0.05, -0.9], [1.9, 2.9, -0.6], (count, 1, 3))
    write_triangles(folder / "many.obj", centres + 3e-3 * np.array([[0, 0, 0], [0, 1, 0], [1, 0, 0]]))
    write_triangles(folder / "room.obj", wall_washers(count))


def wall_washers(count):
    """Small triangles 5 to 30 cm off the six walls of the room, each facing its wall: a point is lit by those near it."""
    rng = np.random.default_rng(11)
    least, most = np.array([-4.0, 0, -4]), np.array([4.0, 3, 4])
    wall, distance = rng.integers(0, 6, count), rng.uniform(0.05, 0.3, count)
    axis, is_far, each = wall // 2, wall % 2 == 1, np.arange(count)
    places = rng.uniform(least + 0.05, most - 0.05, (count, 3))
    places[each, axis] = np.where(is_far, most[axis] - distance, least[axis] + distance)
    normals = np.zeros((count, 3))
    normals[each, axis] = np.where(is_far, 1, -1)
    sides = np.eye(3)[(axis + 1) % 3]
    return np.stack([places, places + 3e-3 * sides, places + 3e-3 * np.cross(normals, sides)], 1)


def relative_error(picture, truth):
    """Mean square of a picture's error over what is there, with a hundredth of the mean to divide black by."""
    return float((((picture - truth) / (truth + 0.01 * truth.mean())) ** 2).mean())


class Run(NamedTuple):
    """Of a whole program, its start included."""

    picture: np.ndarray  # X, Y and Z
    user: float  # seconds
    mebibytes: float  # at most, in memory
    processor: float  # user and system seconds
    wall: float


class Runs:
    """Runs of one program in a folder of its own."""

    def __init__(self, bin_folder):
        self.program = bin_folder / "spectral_ref"
        self._folder = tempfile.TemporaryDirectory()
        self.folder = Path(self._folder.name)

    def render(self, scene, samples, *options, seed=1):
        (self.folder / "scene.yaml").write_text(scene)
        output = self.folder / "picture.exr"
        start = time.perf_counter()
        process = subprocess.Popen([self.program, "render", "scene.yaml", "-o", output, "--spp", str(samples), "--seed",
                                    str(seed), *options], cwd=self.folder)
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            raise RuntimeError(f"spectral_ref: exit status {process.returncode}")
        channels = OpenEXR.File(str(output), separate_channels=True).channels()
        picture = np.stack([channels[name].pixels.astype(float) for name in ("R", "G", "B")])
        return Run(picture, usage.ru_utime, usage.ru_maxrss / 1024, usage.ru_utime + usage.ru_stime, wall)

    def costs(self, scene, truth, samples, variants, seeds=3, large=None, pictures=1):
        """Of each variant, {name: options}: MSE of X, Y and Z, mean over seeds, and the seconds of a run beyond a start
        of the program, which reads the scene. Variants take turns, now one first and now the other, and each turn has a
        start of its own: what a busy machine adds falls on both. Seconds are the first variant's median, times the
        median of the turns' ratios. Where a picture takes too short a time for that, `large` is the same scene with
        as many pixels as `pictures` have: seconds are then a share of its."""
        timed = large or scene
        errors = {name: [] for name in variants}
        seconds = {name: [] for name in variants}
        for seed in range(1, seeds + 1):
            start = self.render(timed, 1).user
            for name, options in list(variants.items())[::1 if seed % 2 else -1]:
                picture, spent = self.render(scene, samples, *options, seed=seed)[:2]
                errors[name].append(((picture - truth) ** 2).mean(axis=(1, 2)))
                if timed != scene:
                    spent = self.render(timed, samples, *options, seed=seed).user
                seconds[name].append(max(spent - start, 1e-3) / pictures)
        base = np.array(seconds[next(iter(variants))])
        return {name: {"samples": samples, "mse": [float(v) for v in np.mean(errors[name], axis=0)],
                       "seconds": float(np.median(base) * np.median(seconds[name] / base))} for name in variants}


    def race(self, scene, truth, samples, variants, seeds=2):
        """Of each variant, {name: options}: the relative error of X, Y and Z, mean over seeds; processor and wall seconds of
        the whole program and beyond a start of it, medians. Variants take turns."""
        runs = {name: [] for name in variants}
        starts = []
        for seed in range(1, seeds + 1):
            starts.append(self.render(scene, 1))
            for name, options in variants.items():
                runs[name].append(self.render(scene, samples, *options, seed=seed))

        def median(of, field):
            return float(np.median([getattr(run, field) for run in of]))

        rows = {}
        for name, of in runs.items():
            errors = [[relative_error(x, t) for x, t in zip(run.picture, truth)] for run in of]
            rows[name] = {"samples": samples, "error": [float(e) for e in np.mean(errors, axis=0)],
                          "processor": median(of, "processor"), "wall": median(of, "wall")}
            for field in ("processor", "wall"):
                rows[name][f"{field}_beyond_start"] = max(rows[name][field] - median(starts, field), 1e-3)
        return rows


def price(cost, channel=1):
    """Time x MSE, which does not depend on how long one renders: noise falls with the time spent."""
    return cost["seconds"] * cost["mse"][channel]


def race_price(point, seconds="processor", channel=1):
    """The same of a race's figures: seconds of a kind, and the relative error."""
    return point[seconds] * point["error"][channel]


def over_mitsuba(row, seconds="processor"):
    """Price of our best method over that of Mitsuba's better variant, the most samples each; None without it."""
    ours, theirs = ([race_price(points[-1], seconds) for name, points in row["curves"].items()
                     if name.startswith("Mitsuba") == is_theirs] for is_theirs in (False, True))
    return min(ours) / min(theirs) if theirs else None
