# SPDX-License-Identifier: Apache-2.0
"""Spot checks of the tables in data/ against published numbers."""

from __future__ import annotations

import json
import math
import unittest

from tables import (
    at,
    camera_fits,
    chromaticity,
    DATA,
    find,
    fit,
    GRID,
    illuminant,
    load_manifest,
    native_chromaticity,
    peak_and_width,
    planck,
    read_table,
    SPACES,
    xyz,
)


class Numbers(unittest.TestCase):
    """Spot checks against published numbers."""

    def near(self, found: tuple[float, float], wanted: tuple[float, float], within: float) -> None:
        """Check a pair of chromaticity coordinates."""
        self.assertLessEqual(math.dist(found, wanted), within, f"{found} for {wanted}")

    def test_standard_observers(self) -> None:
        """Peaks and sums of the colour-matching functions (CIE 015)."""
        y2 = find("observers", "CIE 1931 2")["Y"]
        y10 = find("observers", "CIE 1964 10")["Y"]
        self.assertEqual(y2[555], 1.0)
        self.assertAlmostEqual(sum(y2[w] for w in range(360, 831)), 106.857, delta=0.001)
        self.assertAlmostEqual(sum(y10[w] for w in range(360, 831)), 116.662, delta=0.001)
        for name in ("CIE 2006 LMS 2", "CIE 2006 LMS 10"):
            for column in find("observers", name).values():
                self.assertAlmostEqual(max(column.values()), 1.0, delta=1e-4)

    def test_ricd_is_aces_of_1931(self) -> None:
        """RICD is CIE 1931 in ACES2065-1 primaries, each channel of unit sum."""
        bars = find("observers", "CIE 1931 2")
        ricd = find("observers", "ACES RICD")
        to_aces = (  # SMPTE ST 2065-1
            ("R", (1.0498110175, 0.0, -0.0000974845)),
            ("G", (-0.4959030231, 1.3733130458, 0.0982400361)),
            ("B", (0.0, 0.0, 0.9912520182)),
        )
        for channel, row in to_aces:
            plain = {w: sum(m * bars[k][w] for m, k in zip(row, "XYZ")) for w in bars["X"]}
            total = sum(plain.values())
            for w, value in plain.items():
                self.assertAlmostEqual(value / total, ricd[channel][w], delta=1e-7)

    def test_illuminants(self) -> None:
        """Normalisation, and chromaticities printed in CIE 015:2018."""
        for name in ("A", "D65", "D50"):
            self.assertAlmostEqual(find("illuminants", name)[name][560], 100.0, delta=1e-9)
        printed = {
            "A": (0.44758, 0.40745),
            "C": (0.31006, 0.31616),
            "D50": (0.34567, 0.35851),
            "D65": (0.31272, 0.32903),
            "FL2": (0.3721, 0.3751),
            "FL11": (0.3805, 0.3769),
            "HP1": (0.5330, 0.4150),
            "HP2": (0.4778, 0.4158),
            "LED-B3": (0.3756, 0.3723),
            "LED-RGB1": (0.4557, 0.4211),
        }
        for name, xy in printed.items():
            with self.subTest(name):
                self.near(native_chromaticity(name), xy, 1e-4)  # printed to four places

    def test_sodium(self) -> None:
        """HP1 carries 31 % of its energy at 585 to 595 nm, HP2 next to none."""

        def share(name: str) -> float:
            column = find("illuminants", name)[name]
            return sum(column[w] for w in (585, 590, 595)) / sum(column.values())

        self.assertAlmostEqual(share("HP1"), 0.31, delta=0.005)
        self.assertLess(share("HP2"), 0.002)
        lps = find("illuminants", "LPS")["LPS"]
        self.assertEqual([w for w, v in lps.items() if v > 0], [590])
        self.near(native_chromaticity("LPS"), (0.5752, 0.4242), 1e-4)

    def test_camera_fits(self) -> None:
        """Peak and width of each fitted curve, the repaired one included."""
        wanted = {
            "Red Mysterium X (fit)": ((617, 66), (545, 74), (472, 87)),
            "Canon 1D MkIII (fit)": ((606, 73), (503, 81), (465, 86)),
            "Canon 5D MkII (fit)": ((594, 73), (531, 105), (469, 86)),
        }
        parameters = camera_fits()
        for name, curves in wanted.items():
            columns = find("observers", name)
            for channel, (peak, width) in zip("RGB", curves):
                with self.subTest(name + " " + channel):
                    values = parameters[name, channel]
                    self.assertEqual(peak_and_width(values), (peak, width))
                    for w, value in columns[channel].items():
                        self.assertAlmostEqual(value / fit(values, w), 1.0, delta=6e-6)

    def test_camera_fit_repair(self) -> None:
        """As printed, the 1D MkIII's blue is far too narrow; repaired it is not."""
        key = ("Canon 1D MkIII (fit)", "B")
        self.assertLess(peak_and_width(camera_fits(corrected=False)[key])[1], 20)
        self.assertAlmostEqual(camera_fits()[key][1], 0.08549 / 464.867, delta=1e-12)
        self.assertAlmostEqual(max(find("observers", key[0])["B"].values()), 0.794, delta=0.001)

    def test_camera_matrices(self) -> None:
        """Each published matrix sends D65 as the camera sees it near D65."""
        light = illuminant("D65")
        for table in load_manifest():
            if "to_xyz" not in table:
                continue
            columns = read_table(table["file"])
            raw = [sum(at(columns[k], w) * s for w, s in zip(GRID, light)) for k in "RGB"]
            values = [sum(m * c for m, c in zip(row, raw)) for row in table["to_xyz"]]
            with self.subTest(table["names"][0]):
                self.near(chromaticity(values), (0.31272, 0.32903), 0.006)

    def test_gels(self) -> None:
        """Gels match the tristimulus values that Lee prints for 3200 K."""
        printed = {
            "Lee 106 Primary Red": (0.693, 0.305, 12.8),
            "Lee 139 Primary Green": (0.212, 0.717, 10.1),
            "Lee 201 Full C.T. Blue": (0.330, 0.339, 35.0),
            "Lee 204 Full C.T. Orange": (0.510, 0.420, 62.8),
            "Lee 209 0.3ND": (0.423, 0.404, 50.0),
            "Lee 244 Plus Green": (0.421, 0.447, 74.0),
            "Lee 247 Minus Green": (0.457, 0.359, 60.0),
            "Lee 299 1.2ND": (0.417, 0.405, 5.8),
        }
        lamp = planck(3200)
        white = xyz(lamp)[1]
        for name, (x, y, luminance) in printed.items():
            with self.subTest(name):
                gel = find("filters", name)[name]
                values = xyz([s * at(gel, w, hold=True) for w, s in zip(GRID, lamp)])
                self.near(chromaticity(values), (x, y), 0.006)
                self.assertAlmostEqual(100 * values[1] / white, luminance, delta=2.5)

    def test_charts(self) -> None:
        """The grey scale of the charts is flat, in order and at its density."""
        densities = {
            "white 9.5 (.05 D)": 0.05,
            "neutral 8 (.23 D)": 0.23,
            "neutral 6.5 (.44 D)": 0.44,
            "neutral 5 (.70 D)": 0.70,
            "neutral 3.5 (1.05 D)": 1.05,
            "black 2 (1.5 D)": 1.5,
        }
        for chart in ("colorchecker", "colorchecker ohta", "colorchecker iso 17321-1"):
            columns = find("reflectances", chart)
            for patch, density in densities.items():
                with self.subTest(chart + " " + patch):
                    self.assertAlmostEqual(-math.log10(columns[patch][560]), density, delta=0.03)

    def test_skin(self) -> None:
        """Skin samples are the ones of their sets, brighter in the red."""
        skin = find("reflectances", "skin")
        self.assertEqual(list(skin), ["CES15", "CES18", "TCS15"])
        tm30, cri = find("reflectances", "tm30"), find("reflectances", "cri")

        def haemoglobin(column: dict[float, float]) -> float:
            """Return how far the middle of its W rises over its two dips."""
            return (2 * column[560] - column[540] - column[580]) / column[560]

        for name, column in skin.items():
            self.assertEqual(column, (tm30 | cri)[name])
            self.assertGreater(column[650], 1.4 * column[550])
            self.assertGreater(haemoglobin(column), -0.02, name)
        # A paint of skin's colour.
        self.assertLess(haemoglobin(cri["TCS13"]), -0.05)

    def test_spaces(self) -> None:
        """The spaces' primaries and whites, the three best known in numbers."""
        document = json.loads((DATA / "rgb_spaces.json").read_text(encoding="utf-8"))
        spaces = {s["name"]: s for s in document["spaces"]}
        self.assertEqual(set(spaces), SPACES)
        for s in spaces.values():
            self.assertEqual(set(s), {"name", "primaries", "white", "white_name"})
            self.assertEqual([len(p) for p in s["primaries"]], [2, 2, 2])
            self.assertEqual(len(s["white"]), 2)
        self.assertEqual(
            spaces["ACEScg"]["primaries"], [[0.713, 0.293], [0.165, 0.83], [0.128, 0.044]]
        )
        self.assertEqual(spaces["ACEScg"]["white"], [0.32168, 0.33767])
        self.assertEqual(
            spaces["Rec.709"]["primaries"], [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06]]
        )
        self.assertEqual(
            spaces["Rec.2020"]["primaries"], [[0.708, 0.292], [0.17, 0.797], [0.131, 0.046]]
        )
        self.assertEqual(spaces["Rec.709"]["white"], [0.3127, 0.329])


if __name__ == "__main__":
    unittest.main()
