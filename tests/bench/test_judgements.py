# SPDX-License-Identifier: Apache-2.0
"""What the benchmark says of its own figures: defaults that are beaten, targets that are missed, builds that differ."""

import copy
import json
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from PIL import Image

REPOSITORY = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(REPOSITORY / "bench"))

import defaults  # noqa: E402
import render_scenes  # noqa: E402
import report  # noqa: E402
import targets  # noqa: E402
from sections import compilers  # noqa: E402


def row(label, family, size, nanoseconds, p99, noise=0.01):
    error = {"mean": p99 / 4, "p99": p99, "max": 4 * p99}
    return {"pair": "D65->A", "label": label, "family": family, "bytes": size, "nanoseconds_per_pixel": nanoseconds,
            "noise": noise, "error": {"all": error, "inside": error}}


ROWS = [row("map 0.03", "homogeneous map", 3e6, 6, 0.05), row("map 0.09", "homogeneous map", 2e6, 5, 0.08),
        row("map 0.3", "homogeneous map", 1e6, 4.5, 0.2), row("exact engine 81", "exact engine", 0, 5000, 0.3),
        row("exact engine 251", "exact engine", 0, 9000, 0.02), row("matrix", "matrix", 36, 2.5, 8),
        row("chain 33, 2.6.0", "chain, 2.6.0", 2e6, 80, 0.4), row("chain 65, 2.6.0", "chain, 2.6.0", 1.2e7, 85, 0.2),
        row("fitted 1-D shaper + cube 33, 2.6.0", "fitted 1-D shaper + cube, 2.6.0", 1.1e6, 24, 0.7),
        row("fitted cube 17, 2.6.0", "fitted cube, 2.6.0", 1e5, 20, 5),
        row("fitted cube 33, 2.6.0", "fitted cube, 2.6.0", 1e6, 22, 2),
        row("sampled cube 65, 2.6.0", "sampled cube, 2.6.0", 8e6, 30, 1.9)]


def changed(label, **fields):
    rows = copy.deepcopy(ROWS)
    next(r for r in rows if r["label"] == label).update(fields)
    return rows


class Defaults(unittest.TestCase):
    def test_none_is_beaten_where_error_costs_time(self):
        self.assertEqual(defaults.beaten(ROWS), [])

    def test_a_cheaper_and_more_accurate_choice_is_named(self):
        rows = changed("sampled cube 65, 2.6.0", nanoseconds_per_pixel=20, bytes=1e6)
        self.assertEqual(defaults.beaten(rows), [("D65->A", "fitted cube 33, 2.6.0", "sampled cube 65, 2.6.0")])
        self.assertIn("sampled cube 65, 2.6.0 than fitted cube 33", defaults.markdown(rows)[0])

    def test_a_larger_one_is_told_apart(self):
        rows = changed("sampled cube 65, 2.6.0", nanoseconds_per_pixel=20)
        self.assertEqual(defaults.beaten(rows), [])
        self.assertIn("8.0 times its size", defaults.markdown(rows)[2])
        self.assertEqual(len(defaults.markdown(ROWS)), 1)

    def test_noise_is_no_cheapness(self):
        def quick(nanoseconds):
            return changed("map 0.03", nanoseconds_per_pixel=nanoseconds, noise=0.05, bytes=2e6)

        self.assertEqual(defaults.beaten(quick(4.9)), [])
        self.assertEqual(len(defaults.beaten(quick(4.5))), 1)


class Targets(unittest.TestCase):
    def results(self, seconds):
        return {"build": {"figures": [{"pair": "a", "seconds": 0.1}, {"pair": "b", "seconds": seconds}]}}

    def test_reached_missed_and_not_measured(self):
        self.assertIn("| yes |", targets.markdown(self.results(0.4), ["build"])[-1])
        missed = targets.markdown(self.results(0.6), ["build"])[-1]
        self.assertIn("| 0.6 | **no** | " + targets.BUILD, missed)
        self.assertIn("| not measured |", targets.markdown({}, ["build"])[-1])

    def test_what_is_no_number_is_not_reached(self):
        self.assertIn("**no**", targets.markdown(self.results(float("nan")), ["build"])[-1])

    def test_every_target_finds_its_figure(self):
        """Of the published sections; a renamed key must not turn a target silent."""
        results = json.loads((REPOSITORY / "docs" / "bench.json").read_text(encoding="utf-8"))
        for target in targets.TARGETS:
            if target.section in results:
                with self.subTest(target.what):
                    self.assertIsNotNone(target.measured(results[target.section]["figures"]))
        self.assertGreater(len([t for t in targets.TARGETS if t.section in results]), 15)


class Compilers(unittest.TestCase):
    def test_one_bit_is_found(self):
        one = np.array([[1.0, 2.0, 4.0], [0.5, np.nan, 1.0]])
        self.assertEqual(compilers.compare(one, one.copy()), (0, 0.0))
        other = one.copy()
        other[0, 1] = np.nextafter(2.0, 3.0)
        different, largest = compilers.compare(one, other)
        self.assertEqual(different, 1)
        self.assertAlmostEqual(largest, np.spacing(2.0) / 4.0, delta=1e-18)

    def test_other_bytes_are_found(self):
        self.assertEqual(compilers.compare(np.array("aa"), np.array("aa")), (0, None))
        self.assertEqual(compilers.compare(np.array("aa"), np.array("ab")), (1, None))


class Races(unittest.TestCase):
    def test_the_best_of_ours_over_the_better_mitsuba(self):
        def curve(seconds, error):
            return [{"processor": 9, "error": [None, 9, None]}, {"processor": seconds, "error": [None, error, None]}]

        curves = {"uniform": curve(2, 0.1), "guided": curve(1, 0.1), "Mitsuba a": curve(1, 0.4), "Mitsuba b": curve(2, 0.5)}
        self.assertAlmostEqual(render_scenes.over_mitsuba({"curves": curves}), 0.25)
        self.assertIsNone(render_scenes.over_mitsuba({"curves": {"uniform": curves["uniform"]}}))

    def test_errors_count_over_what_is_there(self):
        truth = np.array([1.0, 3.0])
        self.assertAlmostEqual(render_scenes.relative_error(truth * 1.1, truth), 0.01, delta=3e-4)
        self.assertGreater(render_scenes.relative_error(truth + 0.1, truth), render_scenes.relative_error(truth * 1.05, truth))


class Fronts(unittest.TestCase):
    def test_a_panel_a_scene(self):
        points = [{"processor": 1, "error": [0.2, 0.1, 0.2]}, {"processor": 4, "error": [0.1, 0.02, 0.1]}]
        noise = [{"scene": scene, "curves": {"uniform": points, "guided": points}} for scene in ("chart", "box")]
        results = {"transforms": {"figures": ROWS}}
        with tempfile.TemporaryDirectory() as folder:
            heights = []
            for extra in ({}, {"renderer": {"figures": {"noise": noise}}}):
                path = Path(folder) / "fronts.png"
                self.assertTrue(report.fronts.draw(results | extra, path))
                with Image.open(path) as picture:
                    heights.append(picture.size[1])
        self.assertGreater(heights[1], 1.3 * heights[0])
        self.assertEqual(report.fronts.sources({}), {})


if __name__ == "__main__":
    unittest.main()
