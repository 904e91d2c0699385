# SPDX-License-Identifier: Apache-2.0
"""Non-negative least squares, with and without limits, against scipy on random problems, degenerate ones included."""

import unittest

import numpy as np
from scipy.optimize import linprog, lsq_linear, minimize, nnls

from metamer.stage import non_negative_least_squares

COUNT = 1000
# |A x - b|^2 in double precision has its rounding at a few eps |b|^2: where the fit is exact, only that is left.
ROUNDING = 1e-24


def solve(matrix, target, upper=None, power=None, budget=None):
    return non_negative_least_squares(matrix, target, upper=upper, power=power, power_budget=budget)[0]


def objective(matrix, target, x):
    return float(((matrix @ x - target) ** 2).sum())


def excess_over(theirs, ours, target):
    """Relative, beyond what rounding leaves of an exact fit."""
    return (ours - theirs - ROUNDING * float(target @ target)) / max(theirs, 1e-300)


def problem(random, index):
    """A random problem; nine kinds in turn, most of them degenerate in some way."""
    columns = int(random.integers(1, 17))
    rows = int(random.choice([1, 2, 3, columns, columns + 5, 72, 401]))
    matrix = random.uniform(0, 1, (rows, columns))
    target = matrix @ (random.uniform(-0.5, 1, columns)) + 0.1 * random.normal(size=rows)
    kind = index % 9
    if kind == 1:
        matrix = random.normal(size=(rows, columns))
    elif kind == 2:  # a dead column, and two that are the same
        matrix[:, 0] = 0
        matrix[:, -1] = matrix[:, columns // 2]
    elif kind == 3:  # a column that is a mixture of others
        matrix[:, -1] = matrix[:, : max(1, columns - 1)] @ random.uniform(0, 1, max(1, columns - 1))
    elif kind == 4:  # many orders of magnitude between columns
        matrix *= 10.0 ** random.integers(-6, 7, columns)
    elif kind == 5:  # exactly in reach, on a face
        x = np.maximum(random.uniform(-1, 1, columns), 0)
        target = matrix @ x
    elif kind == 6:  # nothing helps
        target = -np.abs(target)
    elif kind == 7:  # nearly collinear columns
        matrix = random.uniform(0, 1, (rows, 1)) + 1e-6 * random.uniform(0, 1, (rows, columns))
    elif kind == 8:  # narrow bands, as emitters have
        wavelength = np.linspace(0, 1, rows)[:, None]
        matrix = np.exp(-(((wavelength - random.uniform(0, 1, columns)) / 0.03) ** 2))
        target = 1 + wavelength[:, 0]
    return matrix, target


class NonNegative(unittest.TestCase):
    def test_objective(self):
        random = np.random.default_rng(5)
        worst = unsolved = 0.0
        for index in range(COUNT):
            matrix, target = problem(random, index)
            x = solve(matrix, target)
            self.assertTrue((x >= 0).all(), index)
            ours = objective(matrix, target, x)
            try:
                theirs = objective(matrix, target, nnls(matrix, target, maxiter=10000)[0])
            except RuntimeError:  # scipy's own loop gave up
                unsolved += 1
                continue
            excess = excess_over(theirs, ours, target)
            worst = max(worst, excess)
            self.assertLessEqual(excess, 1e-9, f"problem {index}: {ours} against {theirs}")
        print(f"{COUNT} problems: objective above scipy's by at most {worst:.1e} of it; scipy gave up on {unsolved:.0f}")

    def test_conditions(self):
        """Karush-Kuhn-Tucker, judged without another solver: no gradient on the free, none that helps on the others."""
        random = np.random.default_rng(6)
        worst = 0.0
        for index in range(COUNT):
            matrix, target = problem(random, index)
            x = solve(matrix, target)
            lengths = np.linalg.norm(matrix, axis=0)
            # The residual's own rounding grows with what cancels in it.
            size = max(np.linalg.norm(target) + lengths @ x, 1e-300)
            gradient = matrix.T @ (target - matrix @ x) / np.where(lengths > 0, lengths, 1) / size
            worst = max(worst, np.abs(gradient[x > 0]).max(initial=0), gradient.max())
        print(f"largest gradient {worst:.1e}")
        self.assertLessEqual(worst, 1e-11)  # columns that depend to 1e-12 count as dependent

    def test_shortest_of_several(self):
        """Three equations, more emitters: scipy's minimiser of |x| subject to the same residual is no shorter."""
        random = np.random.default_rng(7)
        worst = 0.0
        for _ in range(60):
            columns = int(random.integers(4, 12))
            matrix = random.uniform(0, 1, (3, columns))
            target = matrix @ np.maximum(random.uniform(-1, 1, columns), 0)
            if not target.any():
                continue
            x = solve(matrix, target)
            self.assertLessEqual(np.abs(matrix @ x - target).max(), 1e-12)
            reference = minimize(
                lambda v: v @ v, linprog(np.zeros(columns), A_eq=matrix, b_eq=target).x, jac=lambda v: 2 * v,
                bounds=[(0, None)] * columns, constraints={"type": "eq", "fun": lambda v, a=matrix, b=target: a @ v - b,
                                                           "jac": lambda v, a=matrix: a},
                method="SLSQP", options={"ftol": 1e-14, "maxiter": 500})
            if np.abs(matrix @ reference.x - target).max() > 1e-9:
                continue
            # SLSQP stops within its own tolerance of the equations: 1e-6 covers that.
            worst = max(worst, float(x @ x / (reference.x @ reference.x) - 1))
        print(f"squared norm above SLSQP's by at most {worst:.1e}")
        self.assertLessEqual(worst, 1e-6)

    def test_collinear_emitters_share(self):
        x = solve(np.array([[1.0, 1.0], [2.0, 2.0]]), np.array([3.0, 6.0]))
        np.testing.assert_allclose(x, [1.5, 1.5], rtol=1e-12)


class Limited(unittest.TestCase):
    def test_bounds(self):
        random = np.random.default_rng(8)
        worst = 0.0
        for index in range(300):
            matrix, target = problem(random, 0 if index % 2 else 8)
            columns = matrix.shape[1]
            if np.linalg.matrix_rank(matrix) < columns:
                continue
            upper = random.uniform(0.05, 1, columns)
            x = solve(matrix, target, upper)
            self.assertTrue((x >= 0).all() and (x <= upper).all())
            theirs = objective(matrix, target, lsq_linear(matrix, target, (0, upper), method="bvls", tol=1e-14).x)
            excess = excess_over(theirs, objective(matrix, target, x), target)
            worst = max(worst, excess)
        print(f"bounds: objective above scipy's by at most {worst:.1e}")
        self.assertLessEqual(worst, 1e-9)

    def test_power_budget(self):
        """Judged by the conditions: with mu the budget's multiplier, the gradient less mu p helps nowhere."""
        random = np.random.default_rng(9)
        worst = active = 0.0
        for _ in range(300):
            matrix, target = problem(random, 0)
            columns = matrix.shape[1]
            if np.linalg.matrix_rank(matrix) < columns:
                continue
            power = random.uniform(0.1, 2, columns)
            budget = 0.5 * float(power @ solve(matrix, target)) + 1e-3
            x = solve(matrix, target, None, power, budget)
            if not x.any():
                continue
            self.assertTrue((x >= 0).all())
            self.assertLessEqual(power @ x, budget * (1 + 1e-12))
            gradient = matrix.T @ (target - matrix @ x)
            free = x > 1e-9 * x.max()
            mu = float((power[free] @ gradient[free]) / (power[free] @ power[free]))
            size = np.linalg.norm(matrix) * np.linalg.norm(target)
            rest = (gradient - mu * power) / size
            active += power @ x > budget * (1 - 1e-9)
            self.assertGreaterEqual(mu, -1e-9 * size)
            worst = max(worst, np.abs(rest[free]).max(), rest.max())
        print(f"power budget: {active:.0f} of 300 active, largest reduced gradient {worst:.1e}")
        self.assertGreater(active, 100)
        self.assertLessEqual(worst, 1e-12)


if __name__ == "__main__":
    unittest.main()
