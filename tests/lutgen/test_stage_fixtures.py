# SPDX-License-Identifier: Apache-2.0
"""Environments, selection, linearity and model emitters: lutgen stage environment, select, linearity, emitter."""

import csv
import itertools
import json
import subprocess
import unittest

import numpy as np
import OpenEXR
from scipy.optimize import nnls

from lutgen import LUTGEN, LutgenTest, lutgen
from stage_physics import WAVELENGTHS, camera, chart, form_factor, led, light, model, spectra, write_chart, write_spectrum

EMITTERS = ["led:628:14", "led:525:24", "led:460:16", "led:500:22", "led:595:12", "phosphor:450:20:560:120:0.8"]
WHITE = 18


class EnvironmentTest(LutgenTest):
    def setUp(self):
        super().setUp()
        self.names, reflectances = chart()
        sensitivities = camera()
        self.charts = [reflectances * model(text) @ sensitivities / 100 for text in EMITTERS]
        self.files = []
        for index, rgb in enumerate(self.charts):
            write_chart(self.folder / f"e{index}.csv", self.names, rgb)
            self.files.append(self.folder / f"e{index}.csv")
        self.scenes = {name: reflectances * light(name) @ sensitivities / 1000 for name in ("A", "D65")}
        for name, rgb in self.scenes.items():
            write_chart(self.folder / f"{name}.csv", self.names, rgb)
        random = np.random.default_rng(2)
        self.picture = random.uniform(0, 1, (16, 32, 3)) ** 3 * 4
        self.picture[3, 4] = 0
        self.write()

    def write(self):
        OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage},
                     {"RGB": self.picture.astype(np.float32)}).write(str(self.folder / "env.exr"))

    def drive(self, *arguments, scene=("D65.csv",), output="drives.exr"):
        self.assertWorks("stage", "environment", self.folder / "env.exr", "-o", self.folder / output,
                         "--emitter-charts", *self.files, "--scene-chart", *(self.folder / name for name in scene),
                         *arguments)
        part = OpenEXR.File(str(self.folder / output), separate_channels=True).parts[0]
        names = [f"e{index}" for index in range(len(EMITTERS))]
        self.assertEqual(sorted(part.channels), names)
        return np.stack([part.channels[name].pixels for name in names], axis=-1).astype(float)

    def expected(self, pixel, scene):
        target = scene / scene[WHITE] * np.float32(pixel)
        return nnls(np.stack([rgb.ravel() for rgb in self.charts], axis=1), target.ravel(), maxiter=1000)[0]

    def test_every_pixel_against_scipy(self):
        ours = self.drive()
        theirs = np.array([[self.expected(pixel, self.scenes["D65"]) for pixel in row] for row in self.picture])
        self.assertLessEqual(np.abs(ours - theirs).max(), 1e-6 * theirs.max())  # the file is float32
        self.assertGreaterEqual(ours.min(), 0)
        self.assertEqual(np.abs(ours[3, 4]).max(), 0)

    def test_charts_in_two_directions(self):
        """At each chart's own direction its colours, between them a mixture, each tinted to the pixel."""
        ours = self.drive(scene=("D65.csv@0,0,1", "A.csv@0,0,-1"))
        for row, column in ((7, 15), (8, 0), (2, 9)):
            longitude = 2 * np.pi * (0.5 - (column + 0.5) / 32)
            latitude = np.pi * (0.5 - (row + 0.5) / 16)
            z = np.cos(longitude) * np.cos(latitude)
            weights = 1 / (1 - z + 1e-6), 1 / (1 + z + 1e-6)
            mixed = sum(weight * self.scenes[name] / self.scenes[name][WHITE]
                        for weight, name in zip(weights, ("D65", "A"))) / sum(weights)
            mixed = np.vstack([mixed[:WHITE], np.ones(3), mixed[WHITE + 1 :]])
            theirs = self.expected(self.picture[row, column], mixed)
            self.assertLessEqual(np.abs(ours[row, column] - theirs).max(), 1e-5 * theirs.max())

    def test_the_renderer_has_it_the_same_way_round(self):
        """Drives of the half of a panorama towards +x, its left: they light what faces +x, not what faces away."""
        self.picture[:, 16:] = 0
        self.write()
        self.drive()
        light = {}
        for side in (1, -1):
            scene = self.folder / "plate.yaml"
            scene.write_text(
                "metamer_scene: 1\nfilm: {width: 2, height: 2}\n"
                f"camera: {{origin: [{9 * side}, 0, 0], target: [0, 0, 0], fov_x: 4}}\n"
                f"lights: [{{environment: {{picture: drives.exr, emitters: [1, 1, 1, 1, 1, 1]}}}}]\n"
                f"shapes: [{{rectangle: {{center: [0, 0, 0], half_u: [0, 0, {-side}], half_v: [0, 1, 0]}}, diffuse: 1}}]\n")
            film = self.folder / "film.exr"
            subprocess.run([LUTGEN.with_name("spectral_ref"), "render", scene, "-o", film, "--spp", "16"], check=True)
            light[side] = np.mean(OpenEXR.File(str(film), separate_channels=True).parts[0].channels["G"].pixels)
        self.assertGreater(light[1], 0)
        self.assertEqual(light[-1], 0)

    def test_threads_change_nothing(self):
        one = self.drive("--threads", 1, scene=("D65.csv@0,0,1", "A.csv@0,1,0"))
        four = self.drive("--threads", 4, scene=("D65.csv@0,0,1", "A.csv@0,1,0"), output="four.exr")
        np.testing.assert_array_equal(one, four)

    def test_odd_pixels(self):
        """Negative and not finite values count as black, are counted, and stay where they are."""
        clean = self.drive()
        self.picture[5, 6] = [np.nan, 1, np.inf]
        self.picture[7, 8] = [-1, 2, 0.5]
        self.write()
        run = lutgen("stage", "environment", self.folder / "env.exr", "-o", self.folder / "odd.exr", "--emitter-charts",
                     *self.files, "--scene-chart", self.folder / "D65.csv", "--progress")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("3 values", run.stdout)
        self.assertIn("100 %", run.stderr)
        ours = self.read("odd.exr")
        changed = np.abs(ours - clean).max(axis=-1) > 0
        self.assertEqual(sorted(zip(*np.nonzero(changed))), [(5, 6), (7, 8)])
        np.testing.assert_allclose(ours[7, 8], self.expected([0, 2, 0.5], self.scenes["D65"]), atol=1e-6)

    def read(self, name):
        part = OpenEXR.File(str(self.folder / name), separate_channels=True).parts[0]
        return np.stack([part.channels[f"e{k}"].pixels for k in range(len(EMITTERS))], axis=-1).astype(float)

    def test_black_environment(self):
        self.picture[:] = 0
        self.write()
        self.assertEqual(np.abs(self.drive()).max(), 0)

    def test_square_and_limits(self):
        whole, square = self.drive(), self.drive("--square", 1, 1, 1, output="square.exr")
        np.testing.assert_allclose(square, whole * form_factor(1, 1, 1), rtol=1e-5, atol=1e-7)
        bound = 0.3 * whole.max()
        limited = self.drive("--limits", bound, output="limited.exr")
        self.assertLessEqual(limited.max(), bound * (1 + 1e-6))
        within = whole.max(axis=-1) <= bound
        np.testing.assert_array_equal(limited[within], whole[within])

    def test_lights(self):
        """Two lights share an even environment; each stands for its half."""
        self.picture[:] = [0.2, 0.4, 0.1]
        self.picture[8:] = [0.1, 0.1, 0.3]
        self.write()
        (self.folder / "lights.csv").write_text("name,x,y,z\ntop,0,3,0\nbottom,0,-2,0\n")
        self.drive("--lights", self.folder / "lights.csv", "--lights-output", self.folder / "lights_out.csv")
        with open(self.folder / "lights_out.csv", newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        self.assertEqual([row["name"] for row in rows], ["top", "bottom"])
        for row, colour in zip(rows, ([0.2, 0.4, 0.1], [0.1, 0.1, 0.3])):
            self.assertAlmostEqual(float(row["solid_angle"]), 2 * np.pi, places=6)
            drives = [float(row[f"e{k}"]) for k in range(len(EMITTERS))]
            np.testing.assert_allclose(drives, self.expected(colour, self.scenes["D65"]), rtol=1e-5, atol=1e-9)

    def test_bad_input(self):
        base = ["stage", "environment", "env.exr", "-o", "d.exr", "--emitter-charts", *self.files]
        self.assertFails(*base, "--scene-chart", "D65.csv@0,0", says=["D65.csv@0,0", "FILE@x,y,z"])
        self.assertFails(*base, "--scene-chart", "D65.csv", "--white-patch", "whit3", says=["--white-patch", "whit3"])
        (self.folder / "lights.csv").write_text("name,x,y,z\na,0,0,0\n")
        self.assertFails(*base, "--scene-chart", "D65.csv", "--lights", "lights.csv", "--lights-output", "l.csv",
                         says=["lights.csv:2", "middle"])


class SelectTest(LutgenTest):
    POOL = ["led:628:14", "led:525:24", "led:460:16", "led:500:22", "led:595:12", "phosphor:450:20:600:80:0.01"]

    def select(self, *arguments):
        self.assertWorks("stage", "select", "--json", self.folder / "s.json", *arguments)
        return json.loads((self.folder / "s.json").read_text())

    def test_against_every_subset(self):
        eye = np.stack(list(spectra("observers/cie_1931_2.csv").values())[:3], axis=1)
        grass = spectra("reflectances/pmc.csv", hold=True)["Summer Grass"]
        _, reflectances = chart()
        columns = np.stack([model(text) for text in self.POOL], axis=1)
        cases = []
        for sensitivities in (eye, camera()):
            seen = np.concatenate([(reflectance[:, None] * sensitivities).T for reflectance in reflectances])
            for name in ("A", "D65"):
                for bounce in (1, grass):
                    cases.append((seen @ columns, seen @ (light(name) * bounce)))
        ours = self.select("--targets", "A", "D65", "--bounce", "pmc:Summer Grass", "--emitters", *self.POOL,
                           "--observers", "CIE 1931 2", "Canon EOS 5D Mark II")
        self.assertEqual(len(ours["cases"]), 8)
        errors = []
        for best in ours["best"]:
            count = best["count"]
            every = {}
            for subset in itertools.combinations(range(len(self.POOL)), count):
                every[subset] = np.sqrt(np.mean([nnls(matrix[:, subset], target)[1] ** 2 / (target @ target)
                                                 for matrix, target in cases]))
            champion = min(every, key=every.get)
            self.assertEqual(tuple(best["indices"]), champion)
            self.assertAlmostEqual(best["error"], every[champion], delta=1e-9)
            errors.append(best["error"])
        self.assertEqual(errors, sorted(errors, reverse=True))

    def test_kept(self):
        ours = self.select("--targets", "A", "--emitters", *self.POOL, "--keep", self.POOL[0], self.POOL[3], "--most", 4)
        faces = self.select("--targets", "A", "--emitters", *self.POOL, "--keep", self.POOL[0], self.POOL[3], "--most", 4,
                            "--priority", "skin:20")
        self.assertEqual([faces["virtual_skin"], ours["virtual_skin"]["weight"]], [{"count": 200, "weight": 20}, 0])
        for plain, skin in zip(ours["best"], faces["best"], strict=True):
            self.assertLessEqual(skin["skin_dE"]["mean"], plain["skin_dE"]["mean"] + 1e-9)
        self.assertFails("stage", "select", "--json", "s.json", "--targets", "A", "--emitters", *self.POOL, "--method", "mim",
                         "--priority", "skin", says=["--priority", "mrm alone"])
        self.assertEqual([best["count"] for best in ours["best"]], [2, 3, 4])
        self.assertTrue(all({0, 3} <= set(best["indices"]) for best in ours["best"]))
        self.assertFails("stage", "select", "--json", "s.json", "--targets", "A", "--emitters", *self.POOL, "--keep",
                         "red", says=["--keep", "red"])
        self.assertFails("stage", "select", "--json", "s.json", "--targets", "A", "--emitters", *self.POOL, "--bounce",
                         "pmc:Sand", says=["Sand", "pmc", "none of the measured tables", "give a file"])

    def test_bounces(self):
        """Grass is measured; sand is not, and comes from a file. A word is told where it stands, or that it does not."""
        base = ["stage", "select", "--json", "s.json", "--targets", "D65", "--emitters", *self.POOL[:3], "--bounce"]
        self.assertFails(*base, "grass", says=["'grass'", "SET:PATCH", "pmc:Summer Grass"])
        self.assertFails(*base, "sand", says=["'sand'", "none of the measured tables", "give a file"])
        self.assertFails(*base, "colorchecker", says=["holds 24", "SET:PATCH"])
        write_spectrum(self.folder / "sand.csv", np.linspace(0.1, 0.5, 401), "sand")
        ours = self.select("--targets", "D65", "--emitters", *self.POOL[:4], "--bounce", "PMC:summer grass",
                           self.folder / "sand.csv")
        self.assertEqual([case.split(",")[0] for case in ours["cases"]], ["D65", "D65 off Summer Grass", "D65 off sand"])
        alone = self.select("--targets", "D65", "--emitters", *self.POOL[:4])
        self.assertNotAlmostEqual(ours["best"][2]["error"], alone["best"][2]["error"], places=6)


class PanelTest(LutgenTest):
    def series(self, exponent, black=0.002):
        drives = np.linspace(0, 1, 11)
        colour = np.array([0.8, 0.1, 0.02])
        write_chart(self.folder / "series.csv", [repr(float(drive)) for drive in drives],
                    drives[:, None] ** exponent * colour + black)

    def test_linear(self):
        self.series(1)
        printed = self.assertWorks("stage", "linearity", self.folder / "series.csv", "--json", self.folder / "l.json")
        ours = json.loads((self.folder / "l.json").read_text())
        self.assertTrue(ours["linear"])
        self.assertAlmostEqual(ours["exponent"], 1, places=9)
        self.assertAlmostEqual(ours["gain"], 0.8, places=9)
        self.assertAlmostEqual(ours["black"], 0.002, places=9)
        self.assertIn("linear", printed)

    def test_curved(self):
        self.series(2.4)
        run = lutgen("stage", "linearity", self.folder / "series.csv")
        self.assertEqual(run.returncode, 1)
        self.assertIn("exponent 2.400", run.stderr)

    def test_bad_series(self):
        write_chart(self.folder / "two.csv", ["0", "1"], [[0, 0, 0], [1, 1, 1]])
        self.assertFails("stage", "linearity", "two.csv", says=["at least three"])
        write_chart(self.folder / "falls.csv", ["0", "0.5", "1"], [[1, 1, 1], [0.5, 0.5, 0.5], [0, 0, 0]])
        self.assertFails("stage", "linearity", "falls.csv", says=["does not rise"])


class EmitterTest(LutgenTest):
    def test_model(self):
        """Against colour-science's own function."""
        import colour
        self.assertWorks("stage", "emitter", "led:620:18", "-o", self.folder / "led.csv")
        with open(self.folder / "led.csv", newline="", encoding="utf-8") as stream:
            lines = [row for row in csv.reader(stream)]
        self.assertIn("model", lines[0][0])
        nm, values = np.array([[float(cell) for cell in row] for row in lines[2:]]).T
        shape = colour.SpectralShape(360, 830, 1)
        theirs = colour.sd_single_led(620, shape=shape, method="Ohno 2005", half_spectral_width=18)
        np.testing.assert_array_equal(nm, theirs.wavelengths)
        np.testing.assert_allclose(values, theirs.values, atol=1e-9)
        np.testing.assert_allclose(np.interp(WAVELENGTHS, nm, values), led(620, 18), atol=1e-9)

    def test_bad_model(self):
        for text in ("led:620", "led:6:18", "led:620:x", "phosphor:450:20", "lamp"):
            self.assertFails("stage", "emitter", text, "-o", "x.csv", says=[text.split(":")[0]])


if __name__ == "__main__":
    unittest.main()
