"""The smoothest-spectrum solver against quadprog, an independent quadratic programming library.

Run with ``METAMER_LIB=<build>/lib python tests/oracle/test_solver_against_quadprog.py``; skipped where the pinned
packages or the library are missing. Of the 2,000 problems of each light and band count, those that the solver's library
takes are all solved by it; quadprog judges a fixed share of them, as it takes up to some milliseconds for one. ``METAMER_LONG=1`` has it judge all.

quadprog works on the objective plus ten times the squared constraints (its matrix needs an inverse), which costs it some
digits. Its choice of active bands is therefore solved again,
densely and refined in extended precision, and that is what the solver is held against; where quadprog stops with an
error, the solver's own active bands are solved so, and their multipliers must have the right sign.
"""

from __future__ import annotations

import ctypes
import os
import sys
import time
import unittest
from pathlib import Path

try:
    import colour
    import numpy as np
    import quadprog
except ImportError as error:
    print(f"skipped: needs {error.name}")
    sys.exit(77)

LIBRARY = Path(os.environ.get("METAMER_LIB", "build/release/lib")) / "libmetamer_solver_door.so"
if not LIBRARY.is_file():
    print(f"skipped: no {LIBRARY}")
    sys.exit(77)

LIGHTS = ("D65", "A", "HP1", "FL11")
BAND_COUNTS = (41, 81, 201)
COUNT = 2000
JUDGED = {41: 500, 81: 150, 201: 20}
LONG = bool(os.environ.get("METAMER_LONG"))
# The engine keeps this part of the way from the locus to white.
MARGIN = 1e-3

DOOR = ctypes.CDLL(str(LIBRARY))
DOOR.metamerSolve.restype = ctypes.c_double


def pointer(array: np.ndarray | None) -> ctypes.c_void_p | None:
    """Return the address of an array's first value."""
    return None if array is None else array.ctypes.data_as(ctypes.c_void_p)


def solve(weights: np.ndarray, tristimuli: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Return the library's spectra, rounds (-1: none found, + 1000: second method) and seconds."""
    weights = np.ascontiguousarray(weights)
    tristimuli = np.ascontiguousarray(tristimuli)
    spectra = np.zeros((len(tristimuli), weights.shape[1]))
    rounds = np.zeros(len(tristimuli), np.int32)
    seconds = DOOR.metamerSolve(pointer(weights), weights.shape[1], 0, pointer(tristimuli), len(tristimuli), None,
                                pointer(spectra), pointer(rounds))
    return spectra, rounds, seconds


def band_weights(light: str, bands: int) -> np.ndarray:
    """Return 3 x bands: integrals of the hat functions, rows summing to one."""
    wavelengths = np.arange(380, 781)
    power = colour.SDS_ILLUMINANTS[light]
    cmfs = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    curves = np.stack([np.interp(wavelengths, cmfs.wavelengths, cmfs.values[:, k]) for k in range(3)])
    samples = curves * np.interp(wavelengths, power.wavelengths, power.values)
    position = (wavelengths - 380) * (bands - 1) / 400
    hats = np.maximum(0, 1 - np.abs(position[:, None] - np.arange(bands)))
    return samples @ hats / samples.sum(1, keepdims=True)


def feasible_tristimuli(weights: np.ndarray, count: int) -> np.ndarray:
    """Return mixtures of blocks of bands, many close to the locus, drawn in to white by MARGIN."""
    random = np.random.default_rng(1)
    bands = weights.shape[1]
    found: list[np.ndarray] = []
    while len(found) < count:
        spectrum = np.full(bands, random.choice([0, 1e-4, 1e-2, 0.1]))
        for _ in range(random.integers(1, 6)):
            middle, half = random.integers(0, bands), random.choice([0, 1, 3, 10])
            spectrum[max(0, middle - half) : middle + half + 1] += random.random()
        tristimulus = weights @ spectrum
        # What only the last bands of the range make is darker than the engine considers.
        if tristimulus.sum() > 1e-6:
            found.append((1 - MARGIN) * tristimulus / tristimulus.sum() + MARGIN / 3)
    return np.array(found)


def roughness(spectrum: np.ndarray) -> float:
    """Return what the solver minimises."""
    return float((np.diff(spectrum) ** 2).sum())


def difference(spectrum: np.ndarray, reference: np.ndarray) -> float:
    """Return how far two objectives lie apart, relative; next to grey, to the least that rounding leaves of one."""
    return abs(roughness(spectrum) - roughness(reference)) / max(roughness(reference), 1e-12 * reference.max() ** 2)


class Problem:
    """One set of weights, with the matrices that quadprog and the dense solve need."""

    def __init__(self, weights: np.ndarray) -> None:
        self.weights = weights
        bands = weights.shape[1]
        self.hessian = np.diff(np.eye(bands), axis=0).T @ np.diff(np.eye(bands), axis=0)
        self.penalised = self.hessian + 10 * weights.T @ weights
        self.constraints = np.hstack([weights.T, np.eye(bands)])

    def quadprog(self, tristimulus: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return quadprog's spectrum, and which bands it holds at zero."""
        bands = self.weights.shape[1]
        bounds = np.concatenate([tristimulus, np.zeros(bands)])
        result = quadprog.solve_qp(self.penalised, 10 * self.weights.T @ tristimulus, self.constraints, bounds, 3)
        held = np.zeros(bands, bool)
        held[[i - 4 for i in result[5] if i > 3]] = True
        return result[0], held

    def dense(self, tristimulus: np.ndarray, held: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the spectrum with these bands at zero and the multipliers of the bounds, refined in long double."""
        free = np.flatnonzero(~held)
        n = len(free)
        matrix = np.zeros((n + 3, n + 3))
        matrix[:n, :n] = self.hessian[np.ix_(free, free)]
        matrix[:n, n:] = self.weights[:, free].T
        matrix[n:, :n] = self.weights[:, free]
        right = np.concatenate([np.zeros(n), tristimulus]).astype(np.longdouble)
        exact = matrix.astype(np.longdouble)
        solution = np.zeros(n + 3, np.longdouble)
        for _ in range(4):
            solution += np.linalg.solve(matrix, (right - exact @ solution).astype(float))
        spectrum = np.zeros(len(held))
        spectrum[free] = solution[:n]
        return spectrum, self.hessian @ spectrum + self.weights.T @ solution[n:].astype(float)


class AgainstQuadprog(unittest.TestCase):
    def test_worked_example(self) -> None:
        """Course notes, eq. 5.2-5.4: seven bands."""
        weights = np.array([[0.008, 0.183, 0.003, 0.214, 0.479, 0.115, 0.004],
                            [0, 0.02, 0.165, 0.476, 0.275, 0.042, 0.001],
                            [0.031, 0.835, 0.124, 0.004, 0, 0, 0]])
        tristimulus = np.array([[0.311, 0.197, 0.284]])
        spectra, rounds, _ = solve(weights, tristimulus)
        reference, _ = Problem(weights).quadprog(tristimulus[0])
        distance = np.abs(spectra[0] - reference).max()
        residual = np.abs(weights @ spectra[0] - tristimulus[0]).max()
        print(f"worked example: {distance:.1e} from quadprog's spectrum, tristimulus within {residual:.1e}")
        self.assertGreaterEqual(rounds[0], 0)
        self.assertLessEqual(distance, 1e-6)
        self.assertLessEqual(residual, 1e-9)

    def test_random_tristimuli(self) -> None:
        """Every light and band count: no failure, the same optimum, the same active bands."""
        for light in LIGHTS:
            for bands in BAND_COUNTS:
                with self.subTest(light=light, bands=bands):
                    self.judge(light, bands)

    def judge(self, light: str, bands: int) -> None:
        """Solve and compare COUNT problems of one light and band count; print the figures."""
        problem = Problem(band_weights(light, bands))
        tristimuli = feasible_tristimuli(problem.weights, COUNT)
        spectra, rounds, seconds = solve(problem.weights, tristimuli)
        self.assertEqual((rounds < 0).sum(), 0, "problems without a spectrum")
        self.assertEqual((spectra < 0).sum(), 0)
        residual = np.abs(spectra @ problem.weights.T - tristimuli).max()
        judged = COUNT if LONG else JUDGED[bands]
        begun = time.perf_counter()
        worst = raw_worst = 0.0
        stopped = other_set = not_optimal = 0
        for tristimulus, spectrum in zip(tristimuli[:judged], spectra[:judged]):
            held = spectrum == 0
            try:
                raw, quadprog_held = problem.quadprog(tristimulus)
            except ValueError:
                stopped += 1
                quadprog_held = held
            else:
                raw_worst = max(raw_worst, difference(spectrum, raw))
            expected, multipliers = problem.dense(tristimulus, quadprog_held)
            size = np.abs(expected).max()
            # An active set that quadprog got wrong (a bound broken, a multiplier of the wrong sign) judges nobody.
            if expected.min() < -1e-9 * size or multipliers[quadprog_held].min(initial=0) < -1e-9 * size:
                not_optimal += 1
                expected, multipliers = problem.dense(tristimulus, held)
                size = np.abs(expected).max()
                self.assertGreaterEqual(expected.min(), -1e-9 * size)
                self.assertGreaterEqual(multipliers[held].min(initial=0), -1e-9 * size)
            elif (held != quadprog_held).any():
                other_set += 1
            worst = max(worst, difference(spectrum, expected))
        print(f"{light} {bands} bands: {COUNT} solved in {seconds / COUNT * 1e6:.1f} us each (second method "
              f"{(rounds >= 1000).sum()}, most rounds {(rounds % 1000).max()}), tristimulus within {residual:.1e}; "
              f"{judged} judged in {time.perf_counter() - begun:.0f} s: objective within {worst:.1e} ({raw_worst:.1e} "
              f"of quadprog's raw answer); quadprog stopped {stopped}, broke a condition {not_optimal}; "
              f"other active bands {other_set}", flush=True)
        self.assertLessEqual(residual, 1e-9)
        self.assertLessEqual(worst, 1e-9)
        self.assertEqual(other_set, 0)


if __name__ == "__main__":
    unittest.main()
