# SPDX-License-Identifier: Apache-2.0
"""The published uplifts against colour-science's, on seeded colours. METAMER_LONG=1: 10,000 for each method."""

import os
import unittest
import warnings

import numpy as np

import metamer

warnings.simplefilter("ignore")
import colour  # noqa: E402
from colour.recovery import jakob2019, meng2015, otsu2018  # noqa: E402

LONG = os.environ.get("METAMER_LONG") == "1"
ALL = 10_000
SAME = 1e-6
SHAPE = colour.SpectralShape(380, 780, 5)
# Made by primaries: their Y is a luminance, and all lie in Rec.709.
COLOURS = np.random.default_rng(20260).uniform(size=(ALL, 3))


def sums(shape):
    """colour-science's observer and light at samples, and what each sample counts for there."""
    cmfs = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(shape)
    light = colour.SDS_ILLUMINANTS["D65"].copy().align(shape)
    weights = cmfs.values * light.values[:, None]
    return cmfs, light, weights / weights[:, 1].sum()


class AgainstColourScience(unittest.TestCase):
    def report(self, what, count, largest, bound):
        print(f"{what}: {count} colours, largest difference {largest:.2e}, allowed {bound:.0e}")
        self.assertLessEqual(largest, bound)

    def test_smits(self):
        count = ALL if LONG else 100
        found = metamer.Uplift("smits")(COLOURS[:count])
        theirs = [colour.recovery.RGB_to_sd_Smits1999(rgb).values for rgb in COLOURS[:count]]
        self.report("Smits", count, np.abs(found - theirs).max(), SAME)

    def test_mallett(self):
        count = ALL if LONG else 500
        found = metamer.Uplift("mallett")(COLOURS[:count])
        theirs = [colour.recovery.RGB_to_sd_Mallett2019(rgb).values for rgb in COLOURS[:count]]
        self.report("Mallett", count, np.abs(found - theirs).max(), SAME)

    def test_otsu(self):
        count = ALL if LONG else 60
        shape = otsu2018.SPECTRAL_SHAPE_OTSU2018
        # Theirs sums by ASTM E308: what one sample counts for is the tristimulus of a spectrum that has no other.
        units = [colour.SpectralDistribution(row, shape.wavelengths) for row in np.eye(len(shape.wavelengths))]
        cmfs, light, _ = sums(shape)
        weights = np.array([colour.sd_to_XYZ(unit, cmfs, light) / 100 for unit in units])
        uplift = metamer.Uplift("otsu", weights=weights)
        found = uplift(COLOURS[:count])
        theirs = [colour.recovery.XYZ_to_sd_Otsu2018(xyz).values for xyz in COLOURS[:count] @ uplift.xyz_from_rgb.T]
        self.report("Otsu", count, np.abs(found - theirs).max(), SAME)

    def test_jakob(self):
        count = ALL if LONG else 12
        cmfs, light, weights = sums(SHAPE)
        uplift = metamer.Uplift("jakob", weights=weights)
        xyz = COLOURS[:count] @ uplift.xyz_from_rgb.T
        spectra = uplift(COLOURS[:count])
        white = colour.XYZ_to_xy(weights.sum(axis=0))
        ours = np.linalg.norm(colour.XYZ_to_Lab(spectra @ weights, white) - colour.XYZ_to_Lab(xyz, white), axis=-1)
        theirs = np.array([jakob2019.find_coefficients_Jakob2019(colour_, cmfs, light)[1] for colour_ in xyz])
        print(f"Jakob: {count} colours, CIE 1976 difference left, mean and largest: {ours.mean():.1e} {ours.max():.1e}, "
              f"colour-science {theirs.mean():.1e} {theirs.max():.1e}")
        self.assertTrue(np.all(ours <= theirs), f"worse by {(ours - theirs).max()} at {COLOURS[np.argmax(ours - theirs)]}")

    def test_meng(self):
        count = 100 if LONG else 2
        cmfs, light, weights = sums(SHAPE)
        uplift = metamer.Uplift("meng", weights=weights)
        xyz = COLOURS[:count] @ uplift.xyz_from_rgb.T
        ours = uplift(COLOURS[:count])
        theirs = np.array([meng2015.XYZ_to_sd_Meng2015(c, cmfs, light).values for c in xyz])

        def roughness(spectra):
            return np.sum(np.diff(spectra) ** 2, axis=-1)

        excess = (roughness(ours) - roughness(theirs)).max()
        print(f"Meng: {count} colours, sum of squared differences above colour-science's by {excess:.1e} at most, "
              f"spectra apart by {np.abs(ours - theirs).max():.1e}, XYZ missed by {np.abs(ours @ weights - xyz).max():.1e}, "
              f"colour-science {np.abs(theirs @ weights - xyz).max():.1e}")
        self.assertLessEqual(np.abs(ours @ weights - xyz).max(), 1e-10)
        self.assertGreaterEqual(ours.min(), 0)
        self.assertLessEqual(excess, 0)
        # Where ours is the least, what theirs has more says how far theirs can be: by the least curvature among spectra of
        # one colour. All that is apart is then where its optimiser ended.
        curvature = np.diff(np.eye(len(weights)), axis=0)
        free = np.linalg.svd(weights.T)[2][3:]
        least = np.linalg.eigvalsh(free @ curvature.T @ curvature @ free.T)[0]
        apart = np.sum((ours - theirs) ** 2, axis=-1)
        self.assertTrue(np.all(least * apart <= roughness(theirs) - roughness(ours) + 1e-12))
        self.assertLessEqual((roughness(theirs) - roughness(ours)).max(), 1e-5)


if __name__ == "__main__":
    unittest.main()
