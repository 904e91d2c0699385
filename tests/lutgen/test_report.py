# SPDX-License-Identifier: Apache-2.0
"""lutgen report: one page that is whole, says what the other commands say, and can be read by everybody."""

import base64
import hashlib
import html.parser
import io
import json
import os
import re
import shutil
import subprocess
import unittest
from pathlib import Path

import numpy as np
from PIL import Image

from lutgen import LINKED, LutgenTest
from test_compare import write_exr

ROOT = Path(__file__).resolve().parents[2]
NIGHT = "metamer: 1\nname: night\nspace: ACEScg\ninput: {illuminant: D65}\noutput: {illuminant: HP1, adaptation: 0.5}\n"
# Half the time, for what does not depend on the scene.
QUICK = NIGHT + "scene: {kind: smooth}\n"
VOID = {"meta", "img", "input", "br", "link"}


class Page(html.parser.HTMLParser):
    """The page as a tree that closes what it opens: tags with their attributes, and texts."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.open, self.tags, self.cells, self.faults = [], [], [], []
        self.feed(text)
        self.close()
        self.faults += [f"never closed: {tag}" for tag in self.open]

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))
        if tag not in VOID:
            self.open.append(tag)
        if tag in ("td", "th", "tr"):
            self.cells.append([tag, ""])

    def handle_startendtag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"closed out of turn: {tag}")

    def handle_data(self, text):
        if {"td", "th"} & set(self.open):
            self.cells[-1][1] += text

    def rows(self):
        """Tables' rows as lists of texts."""
        rows = []
        for tag, text in self.cells:
            rows.append([]) if tag == "tr" else rows[-1].append(text)
        return rows

    def named(self, *names):
        return [attributes for tag, attributes in self.tags if tag in names]


class Report(LutgenTest):
    def page(self, *arguments, recipe=NIGHT):
        (self.folder / "night.yaml").write_text(recipe)
        self.assertRegex(self.assertWorks("report", "night.yaml", "-o", "report.html", *arguments), r"report.html: \d pictures")
        self.text = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertEqual([path.name for path in self.folder.glob("*report*")], ["report.html"])
        return Page(self.text)

    def readable(self, page):
        """What a browser without a network, and a reader without eyes, need."""
        self.assertEqual(page.faults, [])
        self.assertNotRegex(self.text, r"https?:|(src|href)=\"(?!data:|#)|@import|url\(")
        self.assertLess(len(self.text), 3_000_000)
        self.assertNotIn("{{", self.text)
        self.assertNotIn(str(self.folder), self.text)
        for picture in page.named("img"):
            self.assertTrue(picture.get("alt"), "a picture without words")
        for drawing in page.named("svg"):
            self.assertEqual(drawing["role"], "img")
            self.assertTrue(drawing["aria-label"])
        labels = {label["for"] for label in page.named("label")}
        for slider in page.named("input"):
            self.assertEqual(slider["type"], "range")
            self.assertIn(slider["id"], labels)
        identifiers = [attributes["id"] for _, attributes in page.tags if "id" in attributes]
        self.assertEqual(len(identifiers), len(set(identifiers)))
        self.assertEqual(len(page.named("table")), len(page.named("caption")))
        self.assertEqual([tag for tag, _ in page.tags if tag == "h1"], ["h1"])
        levels = [int(tag[1]) for tag, _ in page.tags if re.fullmatch("h[1-6]", tag)]
        self.assertTrue(all(after - before <= 1 for before, after in zip(levels, levels[1:])))
        self.assertNotRegex(re.sub(r"base64,[^\"]*", "", self.text), r"\b(nan|inf)\b")

    def pictures(self, page):
        return [np.asarray(Image.open(io.BytesIO(base64.b64decode(one["src"].split(",")[1]))), float) for one in page.named("img")]

    def test_it_says_what_the_other_commands_say(self):
        page = self.page()
        self.readable(page)
        rows = {row[0]: row[1:] for row in page.rows()}
        hashes = []
        for at, (name, *options) in enumerate((("night.ctf", "--certify", "full"), ("night.cube",))):
            self.assertWorks("bake", "night.yaml", "-o", name, *options)
            certificate = json.loads((self.folder / f"{name}.json").read_text())
            self.assertWorks("compare", "night.yaml", name, "--json", "compared.json")
            compared = json.loads((self.folder / "compared.json").read_text())["error"]
            for row, figure in (("mean", "mean"), ("99 of 100 within (p99)", "p99"), ("worst, looked for", "max")):
                self.assertEqual(rows[row][at], f"{certificate['error'][figure]:.4f}", name)
            self.assertEqual(rows["lutgen compare: mean, p99, max"][at],
                             ", ".join(f"{compared[figure]:.4f}" for figure in ("mean", "p99", "max")))
            command = " ".join(["lutgen bake night.yaml", *options, "-o", name])
            self.assertEqual(rows[command], [hashlib.sha256((self.folder / name).read_bytes()).hexdigest()])
            hashes.append(certificate["transform"]["sha256"])
            if options:
                for entry in certificate["surfaces"]["sets"]:
                    figures = [f"{entry[key]:.3f}" for key in ("engine", "plain_adaptation", "root_polynomial")]
                    self.assertEqual(rows[entry["set"]], [str(entry["count"]), *figures])
                for entry in certificate["inputs"]:
                    self.assertEqual(rows[entry["role"]][1], entry["sha256"])
        self.assertEqual(len(set(hashes)), 2)
        before, after = self.pictures(page)[:2]
        self.assertEqual(before.shape, after.shape)
        self.assertGreater(abs(before - after).mean(), 10)
        # The page's own photographs come back as they are.
        own = ROOT / "lutgen" / "pictures" / "report" / "page" / "astronaut.jpg"
        there = np.asarray(Image.open(own).convert("RGB"), float)
        self.assertEqual(before.shape, there.shape)
        self.assertLess(np.abs(before - there).mean(), 2)
        self.assertIn("'s view, which rolls highlights off", html.unescape(self.text))

    def test_a_picture_of_ones_own(self):
        (self.folder / "still.png").write_bytes(self.still())
        page = self.page("--picture", "still.png", "--picture", "still.png", "--picture-space", "sRGB", recipe=QUICK)
        self.readable(page)
        pictures = self.pictures(page)
        self.assertEqual(len(pictures), 4)
        shown = np.asarray(Image.open(self.folder / "still.png"), float)
        # JPEG alone comes between, on a smooth picture.
        self.assertLess(abs(pictures[0] - shown).max(), 12)
        self.assertWorks("apply", "night.yaml", "still.png", "night.png", "--picture-space", "sRGB")
        applied = np.asarray(Image.open(self.folder / "night.png"), float)
        self.assertLess(abs(pictures[1] - applied).mean(), 2)
        self.assertGreater(abs(pictures[1] - shown).mean(), 10)

    @unittest.skipIf(LINKED < (2, 5), "the linked OpenColorIO has ACES 1, which rolls off later")
    def test_scenes_roll_off(self):
        """Light beyond a screen's white is told apart."""
        grey = np.repeat(np.repeat(np.float32([[0.18, 1, 2, 8]]), 16, 0), 16, 1)
        write_exr(self.folder / "steps.exr", np.repeat(grey[..., None], 3, axis=2))
        shown = self.pictures(self.page("--picture", "steps.exr", "--picture-space", "ACEScg", recipe=QUICK))[0][8, 8::16, 0]
        self.assertTrue(np.all(np.diff(shown) > 10), shown)
        self.assertLess(shown[-1], 250)
        self.assertTrue(75 < shown[0] < 125, shown)

    def test_live(self):
        """The playground in the page: a stand-in for it here, and what is told where there is none."""
        install = self.folder / "install"
        (install / "bin").mkdir(parents=True)
        for program in ("lutgen", "lutgen-pictures"):
            shutil.copy(Path(os.environ["METAMER_BIN"]) / program, install / "bin")
        (self.folder / "gel.yaml").write_text(QUICK.replace("adaptation: 0.5", 'filters: [{name: "Lee 204 Full C.T. Orange", density: 0.5}], adaptation: 0.25'))

        def run():
            return subprocess.run([install / "bin" / "lutgen", "report", "gel.yaml", "--live", "-o", "live.html", "--quiet", *self.small()],
                                  cwd=self.folder, capture_output=True, text=True, timeout=300)

        missing = run()
        self.assertEqual((missing.returncode, missing.stderr.count("\n")), (1, 1), missing.stderr)
        self.assertIn("script/playground", missing.stderr)
        self.assertFalse((self.folder / "live.html").exists())
        page = install / "share" / "metamer" / "playground" / "metamer.html"
        page.parent.mkdir(parents=True)
        page.write_text('<!doctype html>\n<html lang="en">\n<p title="it\'s">&amp; <b>here</b></p></html>', encoding="utf-8")
        made = run()
        self.assertEqual((made.returncode, made.stderr), (0, ""))
        self.text = (self.folder / "live.html").read_text(encoding="utf-8")
        report = Page(self.text)
        self.readable(report)
        frame, = report.named("iframe")
        self.assertTrue(frame["title"])
        inner = Page(frame["srcdoc"])
        self.assertEqual(inner.named("html"), [{"lang": "en", "data-start-in": "D65", "data-start-out": "HP1", "data-start-adaptation": "0.25",
                                                "data-start-gel": "Lee 204 Full C.T. Orange", "data-start-density": "0.5"}])
        self.assertEqual(inner.named("p"), [{"title": "it's"}])
        self.assertIn("wasm-unsafe-eval", report.named("meta")[3]["content"])
        self.page(*self.small(), recipe=QUICK)
        self.assertNotIn("wasm-unsafe-eval", self.text)

    def small(self):
        """Options: a small picture in place of the page's own photographs, for what does not depend on pictures."""
        (self.folder / "still.png").write_bytes(self.still())
        return "--picture", "still.png", "--picture-space", "sRGB"

    @staticmethod
    def still():
        x, y = np.meshgrid(np.linspace(0, 1, 96), np.linspace(0, 1, 64))
        file = io.BytesIO()
        Image.fromarray((60 + 120 * np.stack([x, y, 1 - x], -1)).astype(np.uint8)).save(file, "PNG")
        return file.getvalue()

    def test_noise_stays_small_and_names_are_escaped(self):
        noise = np.random.default_rng(1).integers(0, 256, (430, 700, 3), np.uint8)
        Image.fromarray(noise).save(self.folder / "<b>&.png")
        count = 8 if os.environ.get("METAMER_LONG") else 2
        page = self.page(*["--picture", "<b>&.png"] * count, "--picture-space", "sRGB", recipe=QUICK.replace("night", "a<b>"))
        self.readable(page)
        self.assertEqual(len(self.pictures(page)), 2 * count)
        self.assertLess(len(self.text) / count, 3_000_000 / 8)
        self.assertEqual(max(self.pictures(page)[0].shape), 640)
        self.assertNotIn("<b>&", self.text)
        self.assertIn("<h1>a&lt;b&gt;</h1>", self.text)

    def test_a_recipe_that_does_nothing_and_one_with_filters(self):
        nothing = "metamer: 1\nname: nothing\nspace: ACEScct\ninput: {illuminant: D65}\noutput: {illuminant: D65}\n"
        self.readable(self.page(*self.small(), recipe=nothing))
        self.assertIn("the transform does nothing", self.text)
        filters = "input: {illuminant: A, filters: [{name: Lee 201, density: 0.5}]}\noutput: {illuminant: D65, observer: Nikon D5100}\n"
        names = self.assertWorks("list", "filters", "201").split("\n")[0]
        self.assertTrue(names)
        filters = filters.replace("Lee 201", re.split(r"\s{2,}|\t", names)[0])
        page = self.page(*self.small(), recipe=QUICK.split("input")[0] + filters + "scene: {kind: smooth}\n")
        self.readable(page)
        self.assertEqual(self.text.count("What the filters let through"), 1)
        self.assertIn("What sees it after: Nikon D5100", self.text)

    def test_bad_input_is_one_line_and_no_file(self):
        (self.folder / "night.yaml").write_text(QUICK)
        (self.folder / "bad.yaml").write_text(QUICK.replace("HP1", "HP9"))
        (self.folder / "still.png").write_bytes(self.still())
        (self.folder / "torn.png").write_text("no picture")
        report = ("report", "night.yaml", "-o", "report.html")
        self.assertFails("report", "gone.yaml", "-o", "report.html", says=["gone.yaml"])
        self.assertFails("report", "bad.yaml", "-o", "report.html", says=["HP9", "HP1"])
        self.assertFails("report", "night.yaml", "-o", "nowhere/report.html", says=["nowhere"])
        self.assertFails("report", "night.yaml", code=2, says=["--output"])
        self.assertFails(*report, "--picture", "gone.png", says=["gone.png"])
        self.assertFails(*report, "--picture", "torn.png", "--picture-space", "sRGB", says=["torn.png"])
        self.assertFails(*report, "--picture", "still.png", "--picture-space", "sRGBB", says=["sRGBB", "--picture-space"])
        self.assertFails(*report, "--picture-space", "sRGB", code=2, says=["--picture"])
        self.assertFails(*report, *["--picture", "still.png"] * 9, code=2, says=["9 are given", "8 at most"])


if __name__ == "__main__":
    unittest.main()
