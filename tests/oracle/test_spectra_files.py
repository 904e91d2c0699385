# SPDX-License-Identifier: Apache-2.0
"""Whites of lamps from files in the formats that meters and programs write, against colour-science."""

import tempfile
import unittest
from pathlib import Path

import numpy as np

import metamer
from spectra_formats import FORMATS, at_interval

try:
    import colour
except ImportError:
    colour = None

# What the project asks of files that were read right: rounding of their digits, and the 1 nm sum against the integral
# of finer tables, stay far below.
TOLERANCE = 2e-4
FOLDER = Path(__file__).parent / "spectra"


def white_of(spectrum):
    xyz = metamer.response(spectrum)
    return xyz[:2] / xyz.sum()


def colour_white(lamp):
    """Linear to 1 nm, then summed."""
    spectrum = colour.SpectralDistribution(dict(lamp))
    shape = colour.SpectralShape(380, 780, 1)
    spectrum = spectrum.interpolate(shape, interpolator=colour.LinearInterpolator).extrapolate(
        shape, extrapolator_kwargs={"method": "Constant", "left": 0, "right": 0})
    curves = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(shape)
    xyz = colour.sd_to_XYZ(spectrum, curves, method="Integration")
    return xyz[:2] / xyz.sum()


def integrated_white(lamp):
    """Of straight lines between the samples, in steps of a hundredth of a nanometre: for samples off whole nanometres."""
    fine = np.arange(380, 780.005, 0.01)
    curves = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    power = np.interp(fine, *np.array(lamp).T, left=0, right=0)
    xyz = np.array([power @ np.interp(fine, curves.wavelengths, curves.values[:, k]) for k in range(3)])
    return xyz[:2] / xyz.sum()


def lamps():
    """At 1 nm, 380 to 780 nm: a lamp of lines, a phosphor, a tungsten lamp."""
    shape = colour.SpectralShape(380, 780, 1)
    for name in ("FL11", "LED-B3", "A"):
        sampled = colour.SDS_ILLUMINANTS[name].copy().interpolate(shape, interpolator=colour.LinearInterpolator)
        yield name, [(int(nm), value * 1e-3) for nm, value in zip(sampled.wavelengths, sampled.values) if 380 <= nm <= 780]


@unittest.skipIf(colour is None, "colour-science is not installed")
class SpectraFiles(unittest.TestCase):
    def check(self, what, spectra, expected):
        self.assertEqual(len(spectra), 1, what)
        difference = np.abs(white_of(spectra[0]) - expected).max()
        self.assertLess(difference, TOLERANCE, what)
        return difference

    def test_formats(self):
        worst, count = 0, 0
        for name, lamp in lamps():
            for sampled in (lamp, at_interval(lamp, 5)):
                expected = colour_white(sampled)
                for write in FORMATS:
                    with tempfile.TemporaryDirectory() as folder:
                        file, data = write(sampled)
                        (Path(folder) / file.split(":")[0]).write_bytes(data)
                        spectra = metamer.Spectrum.read(f"{folder}/{file}", quantity="power")
                    worst = max(worst, self.check(f"{write.__name__}, {name}", spectra, expected))
                    count += 1
        print(f"{count} files in {len(FORMATS)} formats: xy within {worst:.1e} of colour-science")

    def test_published_samples(self):
        uprtek = colour.SpectralDistribution_UPRTek(str(FOLDER / "uprtek_cv600.xls")).read()
        sekonic = colour.SpectralDistribution_Sekonic(str(FOLDER / "sekonic_c7000.csv")).read()
        spdx = colour.SpectralDistribution_IESTM2714(str(FOLDER / "fluorescent.spdx")).read()
        for file, theirs in (("uprtek_cv600.xls", uprtek), ("sekonic_c7000.csv", sekonic), ("fluorescent.spdx", spdx)):
            lamp = list(zip(theirs.wavelengths, theirs.values))
            expected = integrated_white(lamp) if file.endswith(".spdx") else colour_white(lamp)
            self.check(file, metamer.Spectrum.read(FOLDER / file, quantity="power"), expected)
        theirs = colour.read_sds_from_xrite_file(str(FOLDER / "xrite_measuretool.txt"))
        ours = metamer.Spectrum.read(FOLDER / "xrite_measuretool.txt", quantity="reflectance")
        self.assertEqual([spectrum.name for spectrum in ours], list(theirs))
        for spectrum in ours:
            np.testing.assert_array_equal(spectrum.values, theirs[spectrum.name].values)

    def test_what_the_meters_say(self):
        """The figures in the files themselves, to the digits they are given in."""
        for file, figures in (("uprtek_cv600.xls", (0.339663, 0.345975)), ("sekonic_c7000.csv", (0.4159, 0.3889))):
            white = white_of(metamer.Spectrum.read(FOLDER / file, quantity="power")[0])
            self.assertLess(np.abs(white - figures).max(), TOLERANCE, file)


if __name__ == "__main__":
    unittest.main()
