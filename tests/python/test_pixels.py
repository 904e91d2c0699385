# SPDX-License-Identifier: Apache-2.0
"""Arrays in and out: shapes, types, places in memory, other threads."""

import threading
import time
import unittest

import numpy as np

import metamer


def colours(*shape, seed=1):
    """Colours inside and outside the gamut, black and bright, with a NaN and an infinity."""
    pixels = np.random.default_rng(seed).normal(0.2, 0.3, shape).astype(np.float32)
    pixels[..., :3] *= np.random.default_rng(seed + 1).choice([1e-3, 1, 100], shape[:-1] + (1,))
    flat = pixels.reshape(-1, shape[-1])
    flat[0, :3], flat[1, 0], flat[2, 1] = 0, np.nan, np.inf
    return pixels.astype(np.float32)


class Pixels(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.transform = metamer.Transform(metamer.Recipe("D65", "HP1"))
        cls.map = cls.transform.map()

    def both(self):
        yield "exact", self.transform
        yield "map", self.map

    def test_every_layout_gives_the_same_bits(self):
        rgba = colours(40, 60, 4)
        for name, function in self.both():
            expected = function(rgba)
            layouts = {
                "RGB": np.ascontiguousarray(rgba[..., :3]),
                "a slice of RGBA": rgba[..., :3],
                "rows": rgba.reshape(-1, 4),
                "Fortran order": np.asfortranarray(rgba),
                "planes": np.ascontiguousarray(rgba.transpose(2, 0, 1)).transpose(1, 2, 0),
                "upside down": rgba[::-1],
                "mirrored": rgba[:, ::-1],
                "every third": rgba[:, ::3],
                "read only": np.frombuffer(rgba.tobytes(), np.float32).reshape(rgba.shape),
                "one pixel": rgba[7, 7],
                "frames": rgba.reshape(2, 20, 60, 4),
            }
            wanted = {"RGB": expected[..., :3], "a slice of RGBA": expected[..., :3], "rows": expected.reshape(-1, 4),
                      "upside down": expected[::-1], "mirrored": expected[:, ::-1], "every third": expected[:, ::3],
                      "one pixel": expected[7, 7], "frames": expected.reshape(2, 20, 60, 4)}
            for layout, pixels in layouts.items():
                with self.subTest(function=name, layout=layout):
                    before = pixels.copy()
                    result = function(pixels)
                    self.assertEqual(result.dtype, np.float32)
                    self.assertTrue(result.flags.c_contiguous)
                    np.testing.assert_array_equal(result, wanted.get(layout, expected))
                    np.testing.assert_array_equal(pixels, before, "the input has changed")

    def test_alpha_goes_along(self):
        rgba = colours(10, 4)
        np.testing.assert_array_equal(self.transform(rgba)[:, 3], rgba[:, 3])
        doubles = rgba.astype(np.float64)
        np.testing.assert_array_equal(self.transform(doubles)[:, 3], doubles[:, 3])

    def test_not_finite_comes_back(self):
        rgba = colours(10, 4)
        for _, function in self.both():
            np.testing.assert_array_equal(function(rgba)[1:3], rgba[1:3])
            self.assertTrue(np.isfinite(function(rgba)[3:]).all())

    def test_empty(self):
        for shape in ((0, 3), (0, 4), (0, 5, 3), (5, 0, 4)):
            for dtype in (np.float32, np.float64):
                result = self.transform(np.empty(shape, dtype))
                self.assertEqual((result.shape, result.dtype), (shape, dtype))

    def test_in_place(self):
        for channels in (3, 4):
            for dtype in (np.float32, np.float64):
                for _, function in self.both():
                    pixels = colours(30, 50, channels).astype(dtype)
                    expected = function(pixels)
                    self.assertIs(function(pixels, out=pixels), pixels)
                    np.testing.assert_array_equal(pixels, expected)

    def test_into_another(self):
        pixels = colours(30, 50, 3)
        frame = np.zeros((30, 50, 4), np.float32)
        self.transform(pixels, out=frame[..., :3])
        np.testing.assert_array_equal(frame[..., :3], self.transform(pixels))
        self.assertFalse(frame[..., 3].any())

    def test_doubles(self):
        """float64 is solved in float64: the engine's own numbers, and near what float32 gives."""
        pixels = np.abs(colours(200, 3, seed=3)).astype(np.float64)[3:]
        before = pixels.copy()
        result = self.transform(pixels)
        self.assertEqual(result.dtype, np.float64)
        np.testing.assert_array_equal(pixels, before)
        for colour, there in zip(pixels[:20], result):
            np.testing.assert_allclose(self.transform.linearise(colour)[0], there, rtol=1e-12)
        # float32 rounds what goes in and out.
        size = np.abs(result).max(axis=1, keepdims=True)
        self.assertLess(np.abs(self.transform(pixels.astype(np.float32)) - result).max() / size.min(), np.inf)
        np.testing.assert_allclose(self.transform(pixels.astype(np.float32)) / size, result / size, atol=2e-5)

    def test_numbers(self):
        result = self.transform([0.2, 0.5, 0.3])
        self.assertEqual(result.dtype, np.float64)
        np.testing.assert_array_equal(result, self.transform(np.array([0.2, 0.5, 0.3])))
        self.assertEqual(self.transform([[0.2, 0.5, 0.3], [1, 1, 1]]).shape, (2, 3))

    def test_refused(self):
        transform, pixels = self.transform, colours(10, 20, 3)
        readonly = np.zeros_like(pixels)
        readonly.flags.writeable = False
        line = np.zeros(64, np.float32)
        for what, call, message in (
            ("five channels", lambda: transform(np.zeros((4, 5), np.float32)), "last axis"),
            ("no axes", lambda: transform(np.zeros((), np.float32)), "last axis"),
            ("bytes", lambda: transform(np.zeros((4, 3), np.uint8)), "uint8"),
            ("half", lambda: transform(np.zeros((4, 3), np.float16)), "float16"),
            ("other byte order", lambda: transform(np.zeros((4, 3), ">f4")), "byte order"),
            ("out of another type", lambda: transform(pixels, out=pixels.astype(np.float64)), "float32"),
            ("out of another type", lambda: transform(pixels.astype(np.float64), out=pixels), "float64"),
            ("out of another shape", lambda: transform(pixels, out=np.zeros((10, 20, 4), np.float32)), "shape"),
            ("out that cannot be written", lambda: transform(pixels, out=readonly), "writable"),
            ("out over the input", lambda: transform(line[:30].reshape(10, 3), out=line[3:33].reshape(10, 3)), "over"),
            ("out for a list", lambda: transform([0.1, 0.2, 0.3], out=np.zeros(3)), "out"),
        ):
            with self.subTest(what):
                with self.assertRaisesRegex(ValueError, message):
                    call()

    def test_other_threads_run(self):
        """A Python thread counts while another is in the engine: it could not, were the GIL held."""
        pixels = np.abs(colours(300_000, 3, seed=5))
        counted, stop = [0], threading.Event()

        def count():
            while not stop.is_set():
                counted[0] += 1
                time.sleep(0)

        thread = threading.Thread(target=count)
        thread.start()
        try:
            before = counted[0]
            self.transform(pixels)
            during = counted[0] - before
        finally:
            stop.set()
            thread.join()
        # With the GIL held it counts a few at the borders of the call.
        self.assertGreater(during, 100)

    def test_shared_between_threads(self):
        pixels = colours(2000, 4)
        expected = self.transform(pixels)
        results = [None] * 4

        def work(index):
            results[index] = self.transform(pixels)

        threads = [threading.Thread(target=work, args=(index,)) for index in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for result in results:
            np.testing.assert_array_equal(result, expected)


if __name__ == "__main__":
    unittest.main()
