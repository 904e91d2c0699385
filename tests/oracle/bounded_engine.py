"""The spectral transform a second time, with dense algebra and numpy alone: nothing of it comes from metamer.

The tables are those of data/. One engine is a pair of pipelines with 81 bands, or as many as asked for: the smoothest spectrum with a soft
bound below (course notes, section 5.5), the deviations of measured surfaces interpolated over chromaticity (section
5.4), the limit round plain adaptation, and the degree of adaptation (section 5.6).
"""

from __future__ import annotations

import csv
import json
from functools import cache
from pathlib import Path
from typing import Iterator

import numpy as np

DATA = Path(__file__).resolve().parents[2] / "data"
DOMAIN = np.arange(380.0, 781.0)
BANDS = 81
# Price of a band below zero, for bands one nanometre apart.
BOUND_PRICE = 0.2
# The kernel's reach in standard deviations, and the noise of samples over its 1: twice that at a mean of DARK.
REACH, NOISE, SKIN_NOISE, DARK = 2.0, 0.2, 0.1, 0.05
LEAST_VARIANCE = 1e-4
# Samples that stand for all.
SEEDS = 160
TWIN_RMS = 0.02
# Up, down and aside, of a colour's luminance (aside: or an eighth of X or Z), and the most that they are raised to.
LEAST_REACH = np.array([3.0, 0.8, 4.0])
MOST_REACH = np.array([3.5, 0.95, 12.0])
# Of X and Z, what may be lost.
MOST_LOSS = 0.9
SURFACE_SETS = (
    "colorchecker",
    "colorchecker_iso_17321_1",
    "colorchecker_ohta",
    "cqs",
    "cri",
    "pmc",
    "rawtoaces_190",
    "skin",
    "tm30",
)
HUNT_POINTER_ESTEVEZ = np.array(
    [[0.40024, 0.70760, -0.08081], [-0.22630, 1.16532, 0.04570], [0.0, 0.0, 0.91822]]
)
CAMERA = "Nikon D5100"
EYE = "CIE 1931 2"
PAIRS = (
    ("D65", "A", EYE),
    ("D65", "HP1", EYE),
    ("D65", "LED-RGB1", EYE),
    ("FL11", "D50", EYE),
    ("A", "D65", EYE),
    ("D65", "A", CAMERA),
)
COLUMNS = "input,output,observer,scene,red,green,blue,full red,full green,full blue,none red,none green,none blue"


def read_table(path: Path, *, holds_ends: bool) -> dict[str, np.ndarray]:
    """Return the columns of a table on the domain; outside it they hold their end values, or are zero."""
    with path.open(encoding="utf-8", newline="") as stream:
        header, *rows = list(csv.reader(stream))
    columns = {}
    for k, name in enumerate(header[1:], start=1):
        points = [(float(row[0]), float(row[k])) for row in rows if k < len(row) and row[k].strip()]
        wavelengths, values = np.array(points).T
        ends = {} if holds_ends else {"left": 0.0, "right": 0.0}
        columns[name] = np.interp(DOMAIN, wavelengths, values, **ends)
    return columns


@cache
def illuminant(name: str) -> np.ndarray:
    """Return the power of a lamp on the domain."""
    for path in sorted((DATA / "illuminants").glob("*.csv")):
        table = read_table(path, holds_ends=False)
        if name in table:
            return table[name]
    raise KeyError(name)


@cache
def observer(name: str) -> np.ndarray:
    """Return the three curves of an observer, 401 x 3."""
    path = DATA / "observers" / (name.lower().replace(" ", "_") + ".csv")
    return np.stack(list(read_table(path, holds_ends=False).values()), axis=1)


@cache
def measured_surfaces() -> np.ndarray:
    """Return all measured reflectances less twins, n x 401."""
    kept: list[np.ndarray] = []
    for name in SURFACE_SETS:
        for sample in read_table(DATA / "reflectances" / f"{name}.csv", holds_ends=True).values():
            if all(np.sqrt(np.mean((other - sample) ** 2)) >= TWIN_RMS for other in kept):
                kept.append(sample)
    return np.array(kept)


@cache
def model_skins() -> np.ndarray:
    """Return the modelled skins, n x 401."""
    return np.array(list(read_table(DATA / "reflectances" / "model_skins.csv", holds_ends=True).values()))


@cache
def hats(bands: int) -> np.ndarray:
    """Return the share of each sample of the domain in each band, 401 x bands."""
    return np.maximum(0.0, 1.0 - np.abs((DOMAIN[:, None] - 380.0) * (bands - 1) / 400.0 - np.arange(bands)))


def at_bands(reflectances: np.ndarray, bands: int) -> np.ndarray:
    """Return reflectances (n x 401) at the band centres."""
    return reflectances[:, :: (len(DOMAIN) - 1) // (bands - 1)]


@cache
def laplacian(bands: int) -> np.ndarray:
    """Return the matrix of the sum of squared differences of neighbours."""
    differences = np.diff(np.eye(bands), axis=0)
    return differences.T @ differences


class Pipeline:
    """One side: a light and an observer, scaled so that the perfect reflector has Y = 1 (camera: mean 1)."""

    def __init__(self, light: str, eye: str) -> None:
        self.curves = observer(eye)
        power = illuminant(light)
        response = power @ self.curves
        self.light = power / (response.mean() if eye == CAMERA else response[1])
        self.white = self.light @ self.curves
        self.xyz_from_response = np.eye(3)
        if eye == CAMERA:
            lit = measured_surfaces() * self.light
            solved = np.linalg.lstsq(lit @ self.curves, lit @ observer(EYE), rcond=None)[0].T
            self.xyz_from_response = solved / (solved @ self.white)[1]
        self.white_xyz = self.xyz_from_response @ self.white

    def weights(self, bands: int) -> np.ndarray:
        """Return the response of each band, 3 x bands."""
        return (self.curves * self.light[:, None]).T @ hats(bands)


def solve_bordered(matrix: np.ndarray, weights: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Minimise with `matrix` as the quadratic form under `weights @ x = c`; `right` is the gradient, then c."""
    count = matrix.shape[0]
    system = np.block([[matrix, weights.T], [weights, np.zeros((3, 3))]])
    solution = np.linalg.solve(system, right)
    solution += np.linalg.solve(system, right - system @ solution)
    return solution[:count]


class BoundedSmooth:
    """The smooth spectrum of a white-normalised response, softly bounded below."""

    def __init__(self, weights: np.ndarray) -> None:
        self.weights = weights
        self.bands = weights.shape[1]
        self.price = BOUND_PRICE * (400 / (self.bands - 1)) ** 2
        right = np.vstack([np.zeros((self.bands, 3)), np.eye(3)])
        self.unclamped = solve_bordered(laplacian(self.bands), weights, right)

    def cost(self, spectrum: np.ndarray, prior: np.ndarray) -> float:
        """Return what is minimised."""
        below = np.minimum(spectrum, 0.0)
        return float(np.sum(np.diff(spectrum - prior) ** 2) + self.price * below @ below)

    def solve(self, response: np.ndarray, prior: np.ndarray) -> np.ndarray:
        """Return the spectrum by Newton's method on the set of bands below zero."""
        spectrum = prior + self.unclamped @ (response - self.weights @ prior)
        for _ in range(60):
            clamped = spectrum < 0.0
            form = laplacian(self.bands)
            matrix = form + self.price * np.diag(clamped.astype(float))
            whole = solve_bordered(matrix, self.weights, np.concatenate([form @ prior, response]))
            if np.array_equal(whole < 0.0, clamped):
                return whole
            step = 1.0
            while step > 1e-9 and self.cost(spectrum + step * (whole - spectrum), prior) > self.cost(spectrum, prior):
                step *= 0.5
            spectrum = spectrum + step * (whole - spectrum)
        raise ArithmeticError("Newton's method does not settle")


class MeasuredScene:
    """What measured spectra deviate from their own smooth spectrum, as a Gaussian process over chromaticity."""

    def __init__(self, smooth: BoundedSmooth, curves: np.ndarray) -> None:
        spectra = np.vstack([np.ones((1, len(DOMAIN))), measured_surfaces(), model_skins()])
        samples = at_bands(spectra, smooth.bands)
        noise = np.concatenate(
            [[0.0], np.full(len(measured_surfaces()), NOISE), np.full(len(model_skins()), SKIN_NOISE)]
        )
        centroids = (curves * DOMAIN[:, None]).sum(axis=0) / curves.sum(axis=0)
        self.order = np.argsort(centroids)
        self.whitening = np.eye(2)
        responses = samples @ smooth.weights.T
        covariance = np.cov(self.place(responses[1:]).T, bias=True)
        values, vectors = np.linalg.eigh(covariance)
        self.whitening = vectors @ np.diag(np.maximum(values, LEAST_VARIANCE) ** -0.5) @ vectors.T
        self.places = self.place(responses)
        deviations = (samples - responses @ smooth.unclamped.T) / responses.mean(axis=1, keepdims=True)
        noise = noise * (1.0 + (DARK / responses.mean(axis=1)) ** 2)
        seeds = self.seeds()
        taken = self.kernel(self.places)[:, seeds]
        # In features whose sum of squares is the roughness of a sum of seeds. The first is the perfect reflector's,
        # whose deviation is zero.
        triangle = np.linalg.cholesky(taken[seeds])
        features = np.linalg.solve(triangle, taken.T).T[1:, 1:]
        fit = features.T / noise[1:]
        shares = np.linalg.solve(fit @ features + np.eye(len(seeds) - 1), fit @ deviations[1:])
        self.places = self.places[seeds]
        self.coefficients = np.linalg.solve(triangle.T, np.vstack([np.zeros((1, shares.shape[1])), shares]))

    def seeds(self) -> list[int]:
        """Return the samples that stand for all: the perfect reflector, then always the one least said by those before."""
        kernel = self.kernel(self.places)
        chosen = [0]
        while len(chosen) < SEEDS:
            said = np.linalg.solve(kernel[np.ix_(chosen, chosen)], kernel[chosen])
            unsaid = 1.0 - np.sum(kernel[chosen] * said, axis=0)
            unsaid[chosen] = 0.0
            chosen.append(int(np.argmax(unsaid)))
        return chosen

    def place(self, responses: np.ndarray) -> np.ndarray:
        """Return the whitened chromaticities of responses (n x 3)."""
        short, middle, long = self.order
        differences = np.stack(
            [responses[:, short] - responses[:, middle], responses[:, long] - responses[:, middle]], axis=1
        )
        return differences / responses.mean(axis=1, keepdims=True) @ self.whitening

    def kernel(self, places: np.ndarray) -> np.ndarray:
        """Return Matern's kernel of order 3/2 between places and the samples."""
        distances = np.linalg.norm(places[:, None] - self.places[None], axis=2) * np.sqrt(3.0) / REACH
        return (1.0 + distances) * np.exp(-distances)

    def prior(self, response: np.ndarray) -> np.ndarray:
        """Return the deviation of a response."""
        mean = response.mean()
        if mean <= 1e-4 * np.abs(response).max():
            return np.zeros(self.coefficients.shape[1])
        return mean * (self.kernel(self.place(response[None])) @ self.coefficients)[0]


class Engine:
    """One pair of lights, one scene, the working space ACEScg, von Kries adaptation. No pair here is relaxed."""

    def __init__(self, light_in: str, light_out: str, eye: str, scene: str, bands: int = BANDS) -> None:
        spaces = json.loads((DATA / "rgb_spaces.json").read_text(encoding="utf-8"))["spaces"]
        space = next(s for s in spaces if s["name"] == "ACEScg")
        primaries = np.array([[x, y, 1.0 - x - y] for x, y in space["primaries"]]).T
        x, y = space["white"]
        self.white = np.array([x / y, 1.0, (1.0 - x - y) / y])
        self.xyz_from_rgb = primaries @ np.diag(np.linalg.solve(primaries, self.white))
        self.input, self.output = Pipeline(light_in, eye), Pipeline(light_out, EYE)
        self.smooth = BoundedSmooth(self.input.weights(bands) / self.input.white[:, None])
        self.output_weights = self.output.weights(bands)
        self.scene = MeasuredScene(self.smooth, self.input.curves) if scene == "natural" else None
        response_from_xyz = np.linalg.inv(self.input.xyz_from_response * self.input.white)
        self.response_from_rgb = response_from_xyz @ self.adapt(self.white, self.input.white_xyz) @ self.xyz_from_rgb
        self.relative_from_rgb = self.xyz_from_rgb / self.white[:, None]
        self.relative_from_output = self.adapt(self.output.white_xyz, self.white) / self.white[:, None]
        self.reach = self.reach_for_surfaces()

    @staticmethod
    def adapt(white_from: np.ndarray, white_to: np.ndarray) -> np.ndarray:
        """Return full adaptation of XYZ from one white to another."""
        cones = HUNT_POINTER_ESTEVEZ
        return np.linalg.solve(cones, ((cones @ white_to) / (cones @ white_from))[:, None] * cones)

    def difference(self, response: np.ndarray, relative: np.ndarray) -> np.ndarray:
        """Return what the spectral result differs by from plain adaptation, in XYZ over white."""
        prior = np.zeros(self.smooth.bands) if self.scene is None else self.scene.prior(response)
        spectrum = self.smooth.solve(response, prior)
        return self.relative_from_output @ (self.output_weights @ spectrum) - relative

    @staticmethod
    def sizes(relative: np.ndarray) -> tuple[float, float]:
        """Return the size of a colour that its Y, and that its X and Z, may differ by."""
        luminance = max(relative[1], 0.0)
        return luminance, max(luminance, abs(relative[0]) / 8.0, abs(relative[2]) / 8.0)

    def reach_for_surfaces(self) -> np.ndarray:
        """Return twice the 98th percentile of what measured surfaces take, within bounds."""
        relative_from_response = self.relative_from_rgb @ np.linalg.inv(self.response_from_rgb)
        taken = []
        for surface in measured_surfaces():
            response = (surface * self.input.light) @ self.input.curves / self.input.white
            relative = relative_from_response @ response
            d = self.difference(response, relative)
            luminance, aside = self.sizes(relative)
            taken.append(
                [max(d[1], 0.0) / luminance, max(-d[1], 0.0) / luminance, max(abs(d[0]), abs(d[2])) / aside]
            )
        return np.clip(2.0 * np.percentile(taken, 98, axis=0), LEAST_REACH, MOST_REACH)

    def limited(self, relative: np.ndarray, d: np.ndarray) -> np.ndarray:
        """Return the colour with as much of the difference as the limit leaves."""
        up, down, sides = self.reach
        most = max(d[1] / up, -d[1] / down, abs(d[0]) / sides, abs(d[2]) / sides)
        luminance, aside = (min(2.0, size / most) if most > 0.0 else 2.0 for size in self.sizes(relative))
        left = np.array([aside, luminance, aside])
        for k in (0, 2):
            if d[k] < 0.0:
                left[k] = min(left[k], MOST_LOSS * max(relative[k], 0.0) / -d[k])
        return relative + (left - left**2 / 4.0) * d

    def apply(self, rgb: np.ndarray, adaptation: float) -> np.ndarray:
        """Return the result of one colour at a degree of adaptation."""
        largest = np.abs(rgb).max()
        if largest == 0.0:
            return np.zeros(3)
        exposure = 2.0 ** np.floor(np.log2(largest))
        scaled = rgb / exposure
        relative = self.relative_from_rgb @ scaled
        result = self.limited(relative, self.difference(self.response_from_rgb @ scaled, relative))
        cones = HUNT_POINTER_ESTEVEZ
        gain = adaptation + (1.0 - adaptation) * (cones @ self.output.white_xyz) / (cones @ self.input.white_xyz)
        xyz = np.linalg.solve(cones, gain * (cones @ (self.white * result)))
        return exposure * np.linalg.solve(self.xyz_from_rgb, xyz)


def colours(engine: Engine, random: np.random.Generator) -> np.ndarray:
    """Return surfaces, saturated colours, noise below zero, near-monochromatic lights, and extremes."""
    chosen = random.permutation(len(measured_surfaces()))[:8]
    responses = (measured_surfaces()[chosen] * engine.input.light) @ engine.input.curves / engine.input.white
    surfaces = responses @ np.linalg.inv(engine.response_from_rgb).T
    saturated = [[0.9, 0.02, 0.01], [0.02, 0.8, 0.03], [0.01, 0.02, 0.7], [0.6, 0.01, 0.5], [1, 1, 0.001]]
    noise = [[-0.0053, 0.0093, 0.014], [0.01, -0.004, 0.002], [-0.002, -0.003, 0.001], [0.02, 0.01, -0.015],
             [-0.5, 0.2, 0.1], [-0.1, -0.2, -0.3], [0.3, -0.05, 0.02]]
    lights = []
    for wavelength in (450, 475, 500, 520, 545, 575, 600, 640):
        xyz = observer(EYE)[wavelength - 380]
        lights.append(np.linalg.solve(engine.xyz_from_rgb, 0.3 * xyz / xyz.sum()))
    extremes = [[0, 0, 0], [1, 1, 1], [1e-30, 3e-30, 2e-30], [3e30, 1e30, 2e30], [65504, 12000, 300]]
    return np.vstack([surfaces, saturated, noise, lights, extremes])


def rows(random: np.random.Generator) -> Iterator[list]:
    """Yield a row of COLUMNS for each colour of each pair and scene."""
    for light_in, light_out, eye in PAIRS:
        for scene in ("smooth", "natural"):
            engine = Engine(light_in, light_out, eye, scene)
            for rgb in colours(engine, random):
                full, none = engine.apply(rgb, 1.0), engine.apply(rgb, 0.0)
                yield [light_in, light_out, eye, scene, *rgb, *full, *none]
