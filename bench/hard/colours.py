# SPDX-License-Identifier: Apache-2.0
"""Colours that no reflectance makes, and values that are hardly numbers."""

import numpy as np
import PyOpenColorIO as ocio

import peers
from door import Engine, Map

PIXELS = {"black": (0, 0, 0), "negative": (-0.1, 0.2, 0.3), "all negative": (-1, -2, -3), "denormal": (1e-40, 2e-40, 1e-41),
          "largest half": (65504, 65504, 65504), "1e30": (1e30, 2e29, 1e29), "1e-30": (1e-30, 2e-31, 1e-31),
          "beyond the locus": (1, -0.5, -0.5), "NaN": (np.nan, 0.2, 0.3), "infinity": (np.inf, 0.2, 0.3),
          "-infinity": (0.1, -np.inf, 0.3)}
# Ways from white, the locus at 1, and the step along them.
LOCUS_PLACES = (0.9, 0.97, 1.0, 1.03, 1.5, 3.0)
LOCUS_STEP = 1e-4


def pixels(b):
    engine = Engine(b.door, "D65", "HP1", 251)
    table = Map(engine, 0.09)
    source = np.ones((3 * len(PIXELS), 4), np.float32)
    source[:, :3] = 0.18
    source[1::3, :3] = list(PIXELS.values())  # ordinary neighbours on both sides
    output = np.empty_like(source)
    table.run(source, output)
    alone = np.full((1, 4), 0.18, np.float32)
    alone[0, 3] = 1
    expected = np.empty_like(alone)
    table.run(alone, expected)
    neighbours = np.delete(output, np.s_[1::3], axis=0)
    untouched = all(np.array_equal(output[3 * i + 1], source[3 * i + 1], equal_nan=True)
                    for i, rgb in enumerate(PIXELS.values()) if not np.isfinite(rgb).all())
    finite = all(np.isfinite(output[3 * i + 1]).all() for i, rgb in enumerate(PIXELS.values()) if np.isfinite(rgb).all())
    same = bool((neighbours == expected).all())
    return int(not (untouched and finite and same)), (
        f"{', '.join(PIXELS)}: finite in, finite out: {finite}; NaN and infinities come back as they are: {untouched}; "
        f"neighbours unchanged: {same}")


def _rim():
    """XYZ of spectral colours, every 5 nm, and of the purple line; sum 1. And white's."""
    import colour

    curves = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    spectral = np.array([curves[w] for w in range(400, 691, 5)])
    spectral /= spectral.sum(axis=1, keepdims=True)
    share = np.linspace(0, 1, 17)[1:-1, None]
    purple = (1 - share) * spectral[0] + share * spectral[-1]
    x, y = colour.RGB_COLOURSPACES["ACEScg"].whitepoint
    return np.concatenate([spectral, purple]), np.array([x, y, 1 - x - y])


def locus(b):
    """On, at and beyond the spectral locus and the purple line, by the engine and by the map."""
    import colour

    rim, white = _rim()
    rgb_from_xyz = colour.RGB_COLOURSPACES["ACEScg"].matrix_XYZ_to_RGB
    engine = Engine(b.door, "D65", "HP1", 251)
    table = Map(engine, 0.09)
    gain = engine.diagnostics()["matrix_gain"]

    def colours(way):
        return (white + way * (rim - white)) @ rgb_from_xyz.T

    finite, worst_map = True, 0.0
    for way in LOCUS_PLACES:
        source = np.ones((len(rim), 4), np.float32)
        source[:, :3] = colours(way)
        expected, _ = engine.apply(source[:, :3].astype(np.float64))
        for exposure in (2.0 ** -20, 1.0, 2.0 ** 20):
            lit = source * np.float32(exposure)
            output = np.empty_like(lit)
            table.run(lit, output)
            finite = finite and bool(np.isfinite(output).all() and np.isfinite(expected).all())
            difference = np.abs(output[:, :3] / exposure - expected).max(axis=1) / np.abs(expected).max(axis=1)
            worst_map = max(worst_map, float(difference.max()))

    def largest_jump(step):
        ways = np.arange(0.95, 1.05, step)
        results = np.stack([engine.apply(colours(way))[0] for way in ways])
        moved = np.abs(np.diff(np.stack([colours(way) for way in ways]), axis=0)).max(axis=2)
        return float((np.abs(np.diff(results, axis=0)).max(axis=2) / moved).max() / gain)

    # A jump would be steeper the shorter the step; a slope is not.
    slopes = [largest_jump(step) for step in (LOCUS_STEP, LOCUS_STEP / 4)]
    good = finite and slopes[1] <= 2 * slopes[0]
    return int(not good), (
        f"{len(rim)} chromaticities of the locus and the purple line, {', '.join(map(str, LOCUS_PLACES))} of the way out, "
        f"±20 stops: finite: {finite}; steepest step across, over the matrix's gain: {slopes[0]:.1f} at {LOCUS_STEP:g} of the "
        f"way, {slopes[1]:.1f} at a quarter of that (no jump); map against engine within {worst_map:.2f} of the pixel")


def twice_and_back(b):
    code, _ = b.run("bake", "--illuminant-in", "D65", "--illuminant-out", "A", "-o", "look.ctf")
    picture = peers.photograph("coffee")[::8, ::8].copy()

    def through(*inverses):
        group = ocio.GroupTransform()
        for inverse in inverses:
            group.appendTransform(ocio.FileTransform(
                str(b.folder / "look.ctf"), interpolation=ocio.INTERP_TETRAHEDRAL,
                direction=ocio.TRANSFORM_DIR_INVERSE if inverse else ocio.TRANSFORM_DIR_FORWARD))
        output = np.empty_like(picture)
        peers.run_ocio(peers.cpu_processor(group), picture, output)
        return output

    try:
        back = np.abs(through(0, 1) - picture).max()
        twice, undone = through(0, 0), through(0, 0, 1)
        change = np.abs(undone - through(0)).max()
    except ocio.Exception as error:
        return 1, f"OCIO refuses: {str(error).splitlines()[0]}"
    good = bool(np.isfinite(twice).all()) and max(back, change) < 0.01
    return code or int(not good), (f"once and its inverse: largest change {back:.4f} of a picture up to {picture.max():.2f}; twice: "
                                   f"finite: {bool(np.isfinite(twice).all())}; twice and the inverse against once: {change:.4f}")
