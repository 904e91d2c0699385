# SPDX-License-Identifier: Apache-2.0
"""The playground: its engine's numbers beside lutgen's, and its page in headless Chromium, from a file and from a server.
Skipped where script/playground was not run, unless METAMER_LONG=1 is set and emscripten is there."""

import functools
import http.server
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image

from devtools import CHROMIUM, Page

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
FOLDER = Path(os.environ.get("METAMER_PLAYGROUND", ROOT / "build" / "playground"))
ENGINE = FOLDER / "engine" / "playground"
PAGE = FOLDER / "metamer.html"
LUTGEN = Path(os.environ["METAMER_BIN"]) / "lutgen"
RECIPES = {
    "sodium": "input: {illuminant: D65}\noutput: {illuminant: HP1, adaptation: 0.5}\nbalanced: camera\n",
    "gel": "input: {illuminant: A}\noutput: {illuminant: D65, filters: [{name: Lee 201 Full C.T. Blue, density: 0.7}], "
           "adaptation: 1}\nbalanced: none\n",
    "tube": "input: {illuminant: FL11}\noutput: {illuminant: D50, adaptation: 0}\nscene: {kind: smooth}\n",
    "bulb": "input: {illuminant: 2700 K}\noutput: {illuminant: LED-B3}\nscene: {kind: skin}\n",
}


def colours():
    """Linear pixels of every kind: photographs', saturated, negative, black, very bright, not numbers."""
    chance = np.random.default_rng(1)
    ordinary = chance.uniform(0, 1, (4000, 3)) ** 2.2
    wide = ordinary[:2000] * 10 ** chance.uniform(-4, 4, (2000, 1)) - 0.05 * (chance.uniform(0, 1, (2000, 1)) < 0.2)
    odd = [[0, 0, 0], [1, 1, 1], [0, 0, 1], [-1, 0.5, 0.2], [65504, 1, 0], [np.nan, 1, 1], [np.inf, 0, 0]]
    rgb = np.concatenate([ordinary, wide, np.array(odd)]).astype(np.float32)
    return np.concatenate([rgb, np.full((len(rgb), 1), 0.25, np.float32)], axis=1)


class Folder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)


@unittest.skipIf(shutil.which("node") is None, "node is not installed")
class Numbers(Folder):
    def recipe(self, name):
        file = self.folder / f"{name}.yaml"
        file.write_text(f"metamer: 1\nspace: Rec.709\n{RECIPES[name]}")
        return file

    def run_engine(self, recipe, *order):
        run = subprocess.run(["node", HERE / "numbers.js", ENGINE, recipe, *map(str, order)], capture_output=True, text=True,
                             timeout=120)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout

    def through_lutgen(self, recipe, pixels, engine):
        channels = {name: np.ascontiguousarray(pixels[None, :, k]) for k, name in enumerate("RGBA")}
        with OpenEXR.File({"type": OpenEXR.scanlineimage}, channels) as file:
            file.write(str(self.folder / "in.exr"))
        run = subprocess.run([LUTGEN, "apply", recipe, "in.exr", "out.exr", "--engine", engine, "--picture-space", "Rec.709"],
                             capture_output=True, text=True, cwd=self.folder, timeout=120)
        self.assertEqual(run.returncode, 0, run.stderr)
        with OpenEXR.File(str(self.folder / "out.exr"), separate_channels=True) as file:
            return np.stack([file.channels()[name].pixels[0] for name in "RGBA"], axis=1)

    def test_they_are_lutgens(self):
        pixels = colours()
        for name in RECIPES:
            for engine, tolerance in (("exact", 0), ("map", 0.06)):
                with self.subTest(recipe=name, engine=engine):
                    recipe = self.recipe(name)
                    (self.folder / "pixels").write_bytes(pixels.tobytes())
                    findings = json.loads(self.run_engine(recipe, self.folder / "pixels", tolerance))
                    ours = np.frombuffer((self.folder / "pixels").read_bytes(), np.float32).reshape(-1, 4)
                    theirs = self.through_lutgen(recipe, pixels, engine)
                    np.testing.assert_array_equal(np.isfinite(ours), np.isfinite(theirs))
                    finite = np.isfinite(ours).all(axis=1)
                    self.assertGreater(np.abs(theirs[finite, :3] - pixels[finite, :3]).max(), 0.1)
                    # Relative to a pixel's largest channel. The same bits are meant. Of the C library's powers and exponentials a last
                    # bit may differ, but a sum in another order already cuts other patches of a map: 1e-3 and more.
                    size = np.maximum(np.abs(theirs[finite, :3]).max(axis=1, keepdims=True), 1e-30)
                    off = (np.abs(ours[finite] - theirs[finite]) / size).max(axis=1)
                    print(f"{name}, {engine}: largest difference {off.max():.2g}, {np.mean(off > 0):.3%} of pixels differ")
                    self.assertLess(off.max(), 1e-6)
                    self.assertEqual(len(findings["lights"]), 2)
                    self.assertEqual(len(findings["surfaces"]), 27)

    def test_a_draft_is_near(self):
        pixels = colours()[:4000]
        for name in RECIPES:
            with self.subTest(recipe=name):
                recipe, results = self.recipe(name), []
                for tolerance in (0, self.while_moving()):
                    (self.folder / "pixels").write_bytes(pixels.tobytes())
                    self.run_engine(recipe, self.folder / "pixels", tolerance)
                    results.append(np.frombuffer((self.folder / "pixels").read_bytes(), np.float32).reshape(-1, 4))
                off = np.abs(results[1] - results[0]).max(axis=1) / np.abs(results[0][:, :3]).max(axis=1)
                print(f"{name}, draft: off by {off.mean():.2%} of a pixel in the mean, 99 % within {np.quantile(off, 0.99):.2%}")
                self.assertGreater(off.max(), 1e-5)
                self.assertLess(off.mean(), 0.02)
                self.assertLess(np.quantile(off, 0.99), 0.15)

    def while_moving(self):
        return re.search(r"whileMoving = (\d+)", (ROOT / "playground" / "page" / "page.js").read_text())[1]

    def test_a_cube_is_the_recipe(self):
        recipe = self.recipe("sodium")
        (self.folder / "ours.cube").write_text(self.run_engine(recipe, "--cube", "ACEScct", 33))
        wide = self.folder / "wide.yaml"
        wide.write_text(recipe.read_text().replace("Rec.709", "ACEScg"))
        run = subprocess.run([LUTGEN, "compare", wide, self.folder / "ours.cube", "--shaper", "ACEScct"],
                             capture_output=True, text=True, timeout=300)
        self.assertEqual(run.returncode, 0, run.stderr)
        mean = re.search(r"CIEDE2000: mean ([0-9.]+)", run.stdout)
        # What 33 plain nodes a side are good for: a wrong curve or order of nodes is off by 10 and more.
        self.assertLess(float(mean[1]), 1.0, run.stdout)

    def test_it_is_fast(self):
        tolerance = self.while_moving()
        changed = []
        for k, light in enumerate(("A", "A", "FL2", "D75", "LED-B5")):
            for adaptation in (0.2, 0.4, 0.6):
                file = self.folder / f"{k}_{adaptation}.yaml"
                file.write_text("metamer: 1\nspace: Rec.709\ninput: {illuminant: " + light + "}\noutput: {illuminant: HP1, "
                                f"adaptation: {adaptation}}}\nbalanced: camera\n")
                changed.append(file)
        taken = json.loads(self.run_engine(self.recipe("sodium"), "--times", tolerance, *changed))
        first, *times = taken["times"]
        moved = min(times[k] for k in range(len(times)) if k % 3 > 0)
        shot = min(times[k] for k in range(6, len(times), 3))
        print(f"processor time, ms: first {first:.0f}, with the compiler beside it {taken['firstOfAll']:.0f}; "
              f"output or adaptation {moved:.0f}, light of the shot {shot:.0f}")
        # docs/playground.md says half; who shares a core with others takes up to twice as long.
        self.assertLess(first, 800)
        self.assertLess(taken["firstOfAll"], 2000)
        self.assertLess(moved, 100)
        self.assertLess(shot, 200)

    def test_a_bad_recipe_is_told(self):
        (self.folder / "bad.yaml").write_text("metamer: 1\ninput: {illuminant: D66}\noutput: {illuminant: A}\n")
        run = subprocess.run(["node", HERE / "numbers.js", ENGINE, self.folder / "bad.yaml", "--cube", "sRGB", "17"],
                             capture_output=True, text=True, timeout=120)
        self.assertEqual(run.returncode, 1)
        self.assertIn("D65", run.stderr)


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *words):
        pass


@unittest.skipIf(CHROMIUM is None, "Chromium is not installed")
class InBrowser(Folder):
    def setUp(self):
        super().setUp()
        self.page = Page(self.folder / "profile")
        self.addCleanup(self.page.close)

    def data(self, name):
        return self.page.evaluate(f"document.documentElement.dataset.{name}")

    def opened(self, address):
        self.page.open(address)
        self.page.wait("['ready', 'rest'].includes(document.documentElement?.dataset.state)")

    def settle(self):
        self.page.wait("document.documentElement.dataset.state === 'rest'")

    def change(self, script):
        """Changes controls, and waits until the page has shown it. Milliseconds, from the change to the picture."""
        return self.page.evaluate(f"""(async () => {{
            document.documentElement.dataset.state = 'waiting';
            const began = performance.now();
            {script};
            while (document.documentElement.dataset.state === 'waiting') await new Promise(done => setTimeout(done, 1));
            return performance.now() - began;
        }})()""")

    def pixels(self):
        return np.array(self.page.evaluate(
            "(() => { const c = document.getElementById('after');"
            "return [...c.getContext('2d').getImageData(0, 0, c.width, c.height).data]; })()"), np.uint8)

    SET = "const set = (id, value) => { const c = document.getElementById(id); c.value = value; c.dispatchEvent(new Event('input')); };"

    def test_from_a_file(self):
        self.opened(PAGE.as_uri())
        first = float(self.data("first"))
        before = self.pixels()
        self.assertEqual(self.page.evaluate("document.getElementById('swatches').children.length"), 27)
        self.assertEqual(self.page.evaluate("document.querySelectorAll('#spectra polyline').length"), 2)
        # A picture of the size that is promised for, through the page's own input.
        large = np.random.default_rng(2).integers(0, 256, (54, 96, 3), np.uint8)
        Image.fromarray(large).resize((960, 540), Image.Resampling.BICUBIC).save(self.folder / "large.png")
        self.page.call("DOM.enable")
        root = self.page.call("DOM.getDocument")["root"]["nodeId"]
        node = self.page.call("DOM.querySelector", nodeId=root, selector="#file")["nodeId"]
        self.page.call("DOM.setFileInputFiles", nodeId=node, files=[str(self.folder / "large.png")])
        self.page.wait("document.getElementById('after').width === 960")
        self.settle()
        self.assertNotEqual(self.pixels().size, before.size)
        changes = {
            "adaptation": ("adaptation", [0.8, 0.3, 0.6, 0.1, 0.9]),
            "gel": ("gel", ["Lee 204 Full C.T. Orange", "Lee 201 Full C.T. Blue", "Lee 205 Half C.T. Orange", "", "Lee 206 Quarter C.T. Orange"]),
            "density": ("density", [0.4, 0.6, 0.8, 1.1, 1.6]),
            "light": ("out", ["LED-RGB1", "A", "FL11", "LED-B3", "D50"]),
            "shot": ("in", ["A", "FL2", "D75", "LED-B5", "FL7"]),
            "balanced": ("balanced", ["none", "camera", "none", "camera", "none"]),
        }
        times = {kind: min(self.change(f"{self.SET} set('{place}', '{value}')") for value in values)
                 for kind, (place, values) in changes.items()}
        print(f"first result {first:.0f} ms; changes, ms:", {name: round(value) for name, value in times.items()})
        # By the clock, however many others work on this machine; Numbers.test_it_is_fast is stricter.
        self.assertLess(first, 5000)
        for name, value in times.items():
            self.assertLess(value, 1000, name)
        self.settle()
        self.assertLess(float(self.page.evaluate("document.documentElement.dataset.tolerance")), 0.31)
        self.page.evaluate("document.getElementById('save-cube').click()")
        self.page.wait("document.documentElement.dataset.cube > 500000")
        self.assertEqual(self.page.errors, [])

    def test_it_begins_with_what_a_report_asks_for(self):
        for asked, shown in (("A", "A"), ("no such light", "D65")):
            with self.subTest(asked):
                page = self.folder / "asked.html"
                page.write_text(PAGE.read_text(encoding="utf-8").replace("<html", f'<html data-start-in="{asked}"', 1), encoding="utf-8")
                self.opened(page.as_uri())
                self.assertEqual(self.page.evaluate("document.getElementById('in').value"), shown)
                self.assertEqual(self.page.evaluate("document.getElementById('status').textContent"), "")
                self.assertEqual(self.page.errors, [])

    def test_from_a_server(self):
        handler = functools.partial(Quiet, directory=PAGE.parent)
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        self.addCleanup(server.server_close)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.shutdown)
        self.opened(f"http://127.0.0.1:{server.server_port}/{PAGE.name}")
        self.assertEqual(self.page.errors, [])

    def test_it_fits_by_keyboard_light_and_dark(self):
        self.opened(PAGE.as_uri())
        self.settle()
        shades = {}
        for width in (390, 1280):
            self.page.resize(width, 900)
            for scheme in ("light", "dark"):
                self.page.prefer(scheme)
                time.sleep(0.1)
                self.assertLessEqual(self.page.evaluate("document.documentElement.scrollWidth"), width)
                shades[scheme] = self.page.evaluate("getComputedStyle(document.body).backgroundColor")
        self.assertEqual(shades, {"light": "rgb(251, 250, 248)", "dark": "rgb(23, 23, 23)"})
        before = self.pixels()
        reached = []
        for _ in range(12):
            self.page.press("Tab", 9)
            reached.append(self.page.evaluate("document.activeElement.id"))
            if reached[-1] == "adaptation":
                self.page.evaluate("document.documentElement.dataset.state = 'waiting'")
                for _ in range(20):
                    self.page.press("ArrowRight", 39)
        self.assertLessEqual({"split", "file", "in", "balanced", "out", "gel", "adaptation", "space"}, set(reached))
        self.settle()
        self.assertEqual(self.page.evaluate("document.getElementById('adaptation').value"), "0.7")
        self.assertGreater(np.mean(self.pixels() != before), 0.2)
        self.assertEqual(self.page.errors, [])

    def test_a_picture_may_come_while_one_is_shown(self):
        self.opened(PAGE.as_uri())
        failed = self.page.evaluate(f"""(async () => {{
            {self.SET}
            const status = document.getElementById('status'), failed = [];
            new MutationObserver(() => status.classList.contains('error') && failed.push(status.textContent))
                .observe(status, {{attributes: true, childList: true}});
            for (let k = 0; k < 10; ++k) {{
                const canvas = new OffscreenCanvas(64 + k, 48);
                canvas.getContext('2d').fillRect(0, 0, 64 + k, 48);
                const file = new File([await canvas.convertToBlob({{type: 'image/png'}})], 'black.png');
                set('in', k % 2 === 0 ? 'FL2' : 'D65');
                await new Promise(done => setTimeout(done, 15 * k));
                await takeFile(file);
            }}
            return failed;
        }})()""")
        self.settle()
        self.assertEqual(failed, [])
        self.assertEqual(self.pixels()[:4].tolist(), [0, 0, 0, 255])
        self.assertEqual(self.pixels().size, 4 * 73 * 48)

    def test_what_is_no_picture_is_told(self):
        self.opened(PAGE.as_uri())
        self.page.evaluate("takeFile(new File(['words'], 'words.txt'))")
        self.assertIn("words.txt is no picture", self.page.evaluate("document.getElementById('status').textContent"))


def is_there():
    if not PAGE.exists() and os.environ.get("METAMER_LONG") == "1" and shutil.which("emcc"):
        subprocess.run([ROOT / "script" / "playground", "--no-tests"], check=True)
    return PAGE.exists()


if __name__ == "__main__":
    if not is_there():
        print("script/playground was not run")
        sys.exit(77)
    unittest.main()
