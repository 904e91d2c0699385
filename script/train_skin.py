#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Trains the two encoder-decoders of section 3.6, by RGB and by spectra, and writes data/sources/skin_network.json.

    PYTHONPATH=build/release/python build/venv/bin/python script/train_skin.py [FILE]

NumPy alone on one thread: the same bits each time on one machine, in two minutes. script/export_data.py takes the file into data/.
The networks see what the estimator's table has as axes: (R - G) / M, (B - G) / M and ln M, M the mean of linear Rec.709 in daylight.
"""

import json
import os
import sys
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")

import numpy as np  # noqa: E402

import metamer  # noqa: E402
from metamer import skin  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent
HIDDEN = 32
DRAWS = 60_000
BATCH = 256
STEPS = 40_000
RATE = 4e-3
# Two fifths of the draws are people as the prior has them, two have its deviations doubled, as the estimator's table covers, and one
# lies evenly over table 3.2 by cube and fourth root, as the chapter's do.
WIDENING = 2.0
DARKEST = 0.02
# What the losses weigh, so that each term matters: L1 in RGB, and the spectral angle in radians.
RGB_WEIGHT, ANGLE_WEIGHT = 30.0, 30.0


class Layers:
    """A multilayer perceptron with tanh, and Adam's memory of it."""

    def __init__(self, sizes, random):
        self.weights = [random.normal(0, np.sqrt(1 / a), (a, b)) for a, b in zip(sizes, sizes[1:])]
        self.biases = [np.zeros(b) for b in sizes[1:]]
        self.moments = [[np.zeros_like(p), np.zeros_like(p)] for p in self.parameters()]

    def parameters(self):
        return [*self.weights, *self.biases]

    def forward(self, x):
        """The output, and what stands before each layer."""
        seen = [x]
        for k, (w, b) in enumerate(zip(self.weights, self.biases)):
            x = x @ w + b
            x = np.tanh(x) if k + 1 < len(self.weights) else x
            seen.append(x)
        return x, seen

    def backward(self, seen, slope):
        """The gradients by parameters(), and that by the input."""
        weights, biases = [], []
        for k in reversed(range(len(self.weights))):
            if k + 1 < len(self.weights):
                slope = slope * (1 - seen[k + 1] ** 2)
            weights.insert(0, seen[k].T @ slope)
            biases.insert(0, slope.sum(axis=0))
            slope = slope @ self.weights[k].T
        return [*weights, *biases], slope

    def step(self, gradients, rate, count):
        for p, g, (first, second) in zip(self.parameters(), gradients, self.moments):
            first += 0.1 * (g - first)
            second += 0.001 * (g * g - second)
            p -= rate * (first / (1 - 0.9**count)) / (np.sqrt(second / (1 - 0.999**count)) + 1e-8)


def features(rgb):
    mean = rgb.mean(axis=1)
    return np.column_stack([(rgb[:, 0] - rgb[:, 1]) / mean, (rgb[:, 2] - rgb[:, 1]) / mean, np.log(mean)])


def angle(spectra, truth):
    """The mean spectral angle, and its gradient by `spectra`."""
    size, true_size = np.linalg.norm(spectra, axis=1, keepdims=True), np.linalg.norm(truth, axis=1, keepdims=True)
    a, t = spectra / size, truth / true_size
    cosine = np.clip(np.sum(a * t, axis=1, keepdims=True), -1, 1 - 1e-9)
    slope = -(t - cosine * a) / size / np.sqrt(1 - cosine**2)
    return np.arccos(cosine).mean(), slope / len(spectra)


def train(kind, data, random):
    """Equation 3.5 (kind "rgb") or 3.6 ("spectral", its misprint mended: the angle is to the spectrum)."""
    x, target, rgb, spectra, weights = data["features"], data["coordinates"], data["rgb"], data["spectra"], data["weights"]
    encoder = Layers([3, HIDDEN, HIDDEN, 5], random)
    decoder = Layers([5, HIDDEN, HIDDEN, 3 if kind == "rgb" else spectra.shape[1]], random)
    for count in range(1, STEPS + 1):
        at = random.integers(0, len(x), BATCH)
        found, seen = encoder.forward(x[at])
        slope_of_found = 2 * (found - target[at]) / found.size
        raw, seen_truth = decoder.forward(target[at])
        cycled, seen_cycle = decoder.forward(found)
        if kind == "rgb":
            slope_truth = RGB_WEIGHT * np.sign(raw - rgb[at]) / raw.size
            slope_cycle = RGB_WEIGHT * np.sign(cycled - rgb[at]) / cycled.size
        else:
            slope_truth = ANGLE_WEIGHT * angle(raw, spectra[at])[1]
            seen_rgb = cycled @ weights.T
            slope_cycle = RGB_WEIGHT * (np.sign(seen_rgb - rgb[at]) / seen_rgb.size) @ weights
        of_truth, _ = decoder.backward(seen_truth, slope_truth)
        of_cycle, back = decoder.backward(seen_cycle, slope_cycle)
        of_encoder, _ = encoder.backward(seen, slope_of_found + back)
        rate = RATE * 0.5 * (1 + np.cos(np.pi * count / STEPS)) + 1e-6
        encoder.step(of_encoder, rate, count)
        decoder.step([a + b for a, b in zip(of_truth, of_cycle)], rate, count)
    return encoder, decoder


def training_set(random):
    prior = json.loads((ROOT / "data/sources/skin_prior.json").read_text(encoding="utf-8"))
    mean, deviation = np.array(prior["mean"]), np.array(prior["standard_deviation"])
    root = np.linalg.cholesky(np.array(prior["correlation"]) * np.outer(deviation, deviation))
    draws = random.normal(size=(DRAWS, 5))
    fifth = DRAWS // 5
    draws[2 * fifth:] *= WIDENING
    low = np.array([0.001 ** (1 / 3), 0.001 ** 0.25, 10, 0.001, 0.001])
    high = np.array([0.999, 0.999, 350, 0.999, 0.999])
    coordinates = np.clip(mean + draws @ root.T, low, high)
    coordinates[4 * fifth:] = random.uniform(low, high, size=(DRAWS - 4 * fifth, 5))
    skins = coordinates.copy()
    skins[:, 0], skins[:, 1] = coordinates[:, 0] ** 3, coordinates[:, 1] ** 4
    spectra = skin.albedo(skins)
    weights = rgb_weights()
    rgb = spectra @ weights.T
    # Below, a colour is that of a brighter skin times a gain.
    keep = rgb.mean(axis=1) > DARKEST
    return {"features": features(rgb[keep]), "rgb": rgb[keep], "spectra": spectra[keep], "weights": weights,
            "coordinates": coordinates[keep]}


def rgb_weights():
    """Linear Rec.709 of reflectances in daylight: 3 x 41, the perfect reflector (1, 1, 1)."""
    wavelengths = np.arange(380, 781, 10)
    xyz = np.array([metamer.tristimulus(dict(zip(wavelengths, hat)), "D65", "CIE 1931 2") for hat in np.eye(41)]).T
    spaces = json.loads((ROOT / "data/rgb_spaces.json").read_text(encoding="utf-8"))["spaces"]
    space = next(one for one in spaces if one["name"] == "Rec.709")
    columns = np.array([[x / y, 1, (1 - x - y) / y] for x, y in space["primaries"]]).T
    x, y = space["white"]
    to_rgb = np.linalg.inv(columns * np.linalg.solve(columns, [x / y, 1, (1 - x - y) / y]))
    weights = to_rgb @ xyz
    return weights / weights.sum(axis=1, keepdims=True)


def rounded(layers):
    return [{"weights": [[float(f"{v:.6g}") for v in row] for row in w.T], "biases": [float(f"{v:.6g}") for v in b]}
            for w, b in zip(layers.weights, layers.biases)]


def main():
    file = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "data/sources/skin_network.json"
    data = training_set(np.random.default_rng(1))
    scales = {}
    for name in ("features", "coordinates"):
        raw = data[name]
        scales[name] = {"mean": raw.mean(axis=0), "deviation": raw.std(axis=0)}
        data[name] = (raw - scales[name]["mean"]) / scales[name]["deviation"]
    networks = {}
    for kind in ("rgb", "spectral"):
        encoder, decoder = train(kind, data, np.random.default_rng(2))
        networks[kind] = {"encoder": rounded(encoder), "decoder": rounded(decoder)}
        found, _ = encoder.forward(data["features"][:5000])
        print(kind, "rms of normalised coordinates:", np.sqrt(np.mean((found - data["coordinates"][:5000]) ** 2, axis=0)).round(3))
        out, _ = decoder.forward(found)
        seen = out if kind == "rgb" else out @ data["weights"].T
        print(kind, "cycle, L1 of RGB:", np.abs(seen - data["rgb"][:5000]).mean().round(5))
    document = {
        "source": "script/train_skin.py of metamer: encoder-decoders of section 3.6 of the SIGGRAPH 2022 course on spectral imaging, trained on "
                  "skins drawn from data/skin_prior.json and solved by metamer::skin",
        "illuminant": "D65", "observer": "CIE 1931 2", "space": "Rec.709",
        **{name: {key: [float(f"{v:.9g}") for v in values] for key, values in scale.items()} for name, scale in scales.items()},
        "networks": networks,
    }
    file.write_text(json.dumps(document, indent=None, separators=(",", ":")) + "\n", encoding="utf-8")
    print(f"{file}: {file.stat().st_size} bytes")


if __name__ == "__main__":
    main()
