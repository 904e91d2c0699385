# SPDX-License-Identifier: Apache-2.0
"""lutgen report's page in headless Chromium, with METAMER_LONG=1 where one is installed: no overflow at two
widths, no error, light and dark, and the slider moves."""

import html
import json
import os
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

import numpy as np
from PIL import Image

sys.path.append(str(Path(__file__).resolve().parents[1] / "playground"))
from devtools import Page as DrivenPage  # noqa: E402
from lutgen import LutgenTest  # noqa: E402
from test_report import QUICK  # noqa: E402

PLAYGROUND = Path(os.environ["METAMER_BIN"]).parent / "share" / "metamer" / "playground" / "metamer.html"
FIVE = {
    "sodium": "input: {illuminant: D65}\noutput: {illuminant: HP1, adaptation: 0.5}\n",
    "tungsten_to_day": "input: {illuminant: A}\noutput: {illuminant: D65, adaptation: 1}\nbalanced: camera\n",
    "rgb_led": "input: {illuminant: D65}\noutput: {illuminant: LED-RGB1, adaptation: 1}\nscene: {kind: skin}\n",
    "gel": "input: {illuminant: 3200 K}\noutput: {illuminant: D65, filters: [{name: Lee 201 Full C.T. Blue, density: 0.5}]}\n",
    "camera": "input: {illuminant: D65, observer: Canon EOS 5D Mark II}\noutput: {illuminant: D65, observer: Nikon D5100, adaptation: 1}\n",
}
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
# A frame as wide as the window that is tested: a browser's own window has a least width.
PROBE = """<!doctype html><body style="margin:0"><iframe id="page" style="width:{width}px;height:900px;border:0"></iframe><pre id="found"></pre>
<script>
const page = document.getElementById('page'), found = document.getElementById('found');
const say = text => found.append(text + '\\n');
page.onload = () => {{
  const inside = page.contentDocument, slider = inside.querySelector('.slide input'), pair = inside.querySelector('.pair');
  page.contentWindow.onerror = text => say('error ' + text);
  inside.addEventListener('securitypolicyviolation', event => say('error ' + event.violatedDirective));
  say('width ' + inside.documentElement.scrollWidth);
  const state = () => say('slider ' + slider.value + ' ' + pair.style.getPropertyValue('--at') + ' ' +
      page.contentWindow.getComputedStyle(pair.querySelector('.after')).clipPath + ' ' + slider.getAttribute('aria-valuetext'));
  state();
  slider.focus(); slider.stepUp(20); slider.dispatchEvent(new Event('input')); state();
  say('pictures ' + [...inside.images].every(one => one.complete && one.naturalWidth > 0));
  say('done');
}};
page.srcdoc = {page};
</script></body>"""


class Browser(LutgenTest):
    def chromium(self, *arguments):
        return subprocess.run([CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                               f"--user-data-dir={self.folder / 'profile'}", *arguments],
                              capture_output=True, text=True, timeout=120)

    def setUp(self):
        super().setUp()
        (self.folder / "night.yaml").write_text(QUICK)
        self.assertWorks("report", "night.yaml", "-o", "report.html")
        self.page = (self.folder / "report.html").read_text(encoding="utf-8")

    def found(self, width):
        text = json.dumps(self.page).replace("</", "<\\/")
        (self.folder / "probe.html").write_text(PROBE.format(width=width, page=text))
        run = self.chromium("--virtual-time-budget=5000", "--dump-dom", f"file://{self.folder / 'probe.html'}")
        said = re.search(r'<pre id="found">(.*?)</pre>', run.stdout, re.DOTALL)
        self.assertIsNotNone(said, run.stderr[-500:])
        return html.unescape(said[1]).strip().split("\n")

    def test_it_fits_and_the_slider_moves(self):
        for width in (390, 1280):
            found = self.found(width)
            self.assertEqual(found[-1], "done", found)
            self.assertEqual(found[0], f"width {width}")
            self.assertEqual(found[1], "slider 50 50% inset(0px 0px 0px 50%) 50 % before, 50 % after")
            self.assertEqual(found[2], "slider 70 70% inset(0px 0px 0px 70%) 70 % before, 30 % after")
            self.assertEqual(found[3:], ["pictures true", "done"])

    def test_five_recipes(self):
        """Lamps of every kind, a gel, a camera, skin: none overflows, throws, or passes 3 MB."""
        page = DrivenPage(self.folder / "five profile")
        self.addCleanup(page.close)
        for name, lines in FIVE.items():
            with self.subTest(name):
                (self.folder / f"{name}.yaml").write_text(f"metamer: 1\nname: {name}\nspace: ACEScg\n{lines}")
                before = os.times()
                self.assertWorks("report", f"{name}.yaml", "-o", f"{name}.html", "--quiet")
                taken = os.times()
                file = self.folder / f"{name}.html"
                self.assertLess(file.stat().st_size, 3_000_000)
                widths = []
                for width in (1280, 390):
                    page.resize(width, 900)
                    page.open(file.as_uri())
                    page.wait("document.readyState === 'complete'")
                    # A bar to scroll by takes some of it.
                    widths.append(page.evaluate("document.documentElement.scrollWidth") <= width)
                    if folder := os.environ.get("METAMER_SCREENSHOTS"):
                        page.screenshot(Path(folder) / f"{name}_{width}.png", whole=True)
                self.assertEqual(widths, [True, True])
                self.assertTrue(page.evaluate("[...document.images].every(one => one.complete && one.naturalWidth > 0)"))
                self.assertEqual(page.errors, [])
                seconds = taken.children_user + taken.children_system - before.children_user - before.children_system
                print(f"{name}: {file.stat().st_size:,} bytes, {taken.elapsed - before.elapsed:.1f} s by the clock, {seconds:.1f} s of processors")

    @unittest.skipUnless(PLAYGROUND.exists(), "script/playground was not run")
    def test_the_playground_runs_within(self):
        (self.folder / "live.yaml").write_text(QUICK.replace("D65", "A").replace("HP1", "FL11"))
        self.assertWorks("report", "live.yaml", "--live", "-o", "live.html")
        self.assertLess((self.folder / "live.html").stat().st_size, 3_000_000)
        page = DrivenPage(self.folder / "live profile")
        self.addCleanup(page.close)
        for width in (390, 1280):
            page.resize(width, 900)
            page.open((self.folder / "live.html").as_uri())
            page.wait("document.querySelector('.live')?.contentDocument?.documentElement?.dataset.state in {ready: 1, rest: 1}")
            self.assertLessEqual(page.evaluate("document.documentElement.scrollWidth"), width)
        inner = "document.querySelector('.live').contentDocument"
        self.assertEqual(page.evaluate(f"['in', 'out', 'adaptation'].map(id => {inner}.getElementById(id).value)"), ["A", "FL11", "0.5"])
        self.assertGreater(page.evaluate(f"{inner}.getElementById('swatches').children.length"), 0)
        page.evaluate(f"(() => {{ const c = {inner}.getElementById('out'); {inner}.documentElement.dataset.state = 'waiting';"
                      "c.value = 'D50'; c.dispatchEvent(new Event('input')); })()")
        page.wait(f"{inner}.documentElement.dataset.state === 'rest'")
        self.assertIn("D50", page.evaluate(f"{inner}.getElementById('recipe').textContent"))
        self.assertEqual(page.errors, [])

    def test_it_is_dark_where_the_reader_is(self):
        def lightness(*arguments):
            self.chromium("--window-size=800,600", f"--screenshot={self.folder / 'shot.png'}", *arguments,
                          f"file://{self.folder / 'report.html'}")
            return float(np.median(np.asarray(Image.open(self.folder / "shot.png").convert("L"))))

        self.assertGreater(lightness(), 200)
        self.assertLess(lightness("--force-dark-mode"), 60)


if __name__ == "__main__":
    if CHROMIUM is None or os.environ.get("METAMER_LONG") != "1":
        print("no Chromium is installed, or METAMER_LONG=1 is not set")
        sys.exit(77)
    unittest.main()
