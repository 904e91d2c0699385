"""Checks of data/: its manifest, its numbers, and that it can be regenerated.

Run with ``python -m unittest tests/data/test_data_export.py``. Only the test
of regeneration needs the pinned packages; it is skipped without them.
"""

from __future__ import annotations

import csv
import hashlib
import importlib.util
import json
import math
import subprocess
import sys
import tempfile
import unittest
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "data"
SCRIPT = ROOT / "script" / "export_data.py"
HAND_WRITTEN = {"README.md", "sources/camera_fits.json"}
PINNED = {"colour-science": "0.4.7", "lighting-filters": "0.1.1"}

QUANTITIES = {
    "illuminants": "spectral power distribution",
    "daylight_basis": "spectral power distribution",
    "observers": "sensitivity",
    "filters": "transmittance",
    "reflectances": "reflectance",
    "rgb_spaces": "chromaticity",
}
OBSERVERS = {
    "CIE 1931 2",
    "CIE 1964 10",
    "CIE 2015 2",
    "CIE 2015 10",
    "CIE 2006 LMS 2",
    "CIE 2006 LMS 10",
    "Nikon D5100",
    "Sigma SDMerrill",
    "ACES RICD",
    "Canon EOS 5D Mark II",
    "Red Mysterium X (fit)",
    "Canon 1D MkIII (fit)",
    "Canon 5D MkII (fit)",
}
REFLECTANCE_COUNTS = {
    "colorchecker": 24,
    "colorchecker ohta": 24,
    "colorchecker iso 17321-1": 24,
    "pmc": 30,
    "tm30": 99,
    "cri": 15,
    "cqs": 15,
    "rawtoaces 190": 190,
    "skin": 4,
}
SPACES = {
    "ACEScg",
    "ACES2065-1",
    "Rec.709",
    "P3-D65",
    "Rec.2020",
    "ARRI Wide Gamut 3",
    "ARRI Wide Gamut 4",
    "S-Gamut3",
    "S-Gamut3.Cine",
    "V-Gamut",
    "REDWideGamutRGB",
    "Canon Cinema Gamut",
    "DaVinci Wide Gamut",
}
GRID = range(380, 781)

Column = dict[float, float]


def load_manifest() -> list[dict]:
    """Return the manifest's tables."""
    document = json.loads((DATA / "manifest.json").read_text(encoding="utf-8"))
    assert document["metamer_data"] == 1
    return document["tables"]


def read_table(file: str) -> dict[str, Column]:
    """Return the columns of a CSV table by name."""
    with (DATA / file).open(encoding="utf-8", newline="") as stream:
        header, *rows = csv.reader(stream)
    assert header[0] == "wavelength_nm", file
    assert all(len(row) == len(header) for row in rows), file
    return {
        name: {float(row[0]): float(row[k]) for row in rows}
        for k, name in enumerate(header)
        if k > 0
    }


def find(group: str, name: str) -> dict[str, Column]:
    """Return the columns behind a name: one of that name, or a set's."""
    for table in load_manifest():
        if table["group"] == group and name in table["names"]:
            columns = read_table(table["file"])
            return {name: columns[name]} if group in ("illuminants", "filters") else columns
    raise KeyError(f"{group}: {name}")


def at(column: Column, wavelength: float, hold: bool = False) -> float:
    """Interpolate linearly; outside, hold the end value or return zero."""
    low, high = min(column), max(column)
    if wavelength < low or wavelength > high:
        return column[low if wavelength < low else high] if hold else 0.0
    if wavelength in column:
        return column[wavelength]
    before = max(w for w in column if w < wavelength)
    after = min(w for w in column if w > wavelength)
    t = (wavelength - before) / (after - before)
    return (1 - t) * column[before] + t * column[after]


def xyz(light: list[float]) -> list[float]:
    """Return CIE 1931 tristimulus values of a light on GRID; E has Y = 1."""
    bars = find("observers", "CIE 1931 2")
    scale = sum(bars["Y"][w] for w in GRID)
    return [sum(bars[k][w] * s for w, s in zip(GRID, light)) / scale for k in "XYZ"]


def chromaticity(values: list[float]) -> tuple[float, float]:
    """Return x and y of tristimulus values."""
    return values[0] / sum(values), values[1] / sum(values)


def illuminant(name: str) -> list[float]:
    """Return an illuminant on GRID."""
    column = find("illuminants", name)[name]
    return [at(column, w) for w in GRID]


def native_chromaticity(name: str) -> tuple[float, float]:
    """Return x and y of an illuminant, summed at its own samples as the CIE does."""
    column = find("illuminants", name)[name]
    bars = find("observers", "CIE 1931 2")
    return chromaticity([sum(bars[k].get(w, 0.0) * v for w, v in column.items()) for k in "XYZ"])


def planck(kelvin: float) -> list[float]:
    """Return a black body's relative spectrum on GRID."""
    return [w**-5 / (math.exp(1.4388e7 / (w * kelvin)) - 1) for w in GRID]


def camera_fits(corrected: bool = True) -> dict[tuple[str, str], list[float]]:
    """Return the parameters of the camera fits by camera and channel."""
    published = json.loads((DATA / "sources/camera_fits.json").read_text(encoding="utf-8"))
    out = {}
    for camera in published["cameras"]:
        for channel, values in camera["printed"].items():
            out[camera["name"], channel] = list(values)
        for fix in camera["corrections"] if corrected else []:
            place = "abcdefghij".index(fix["parameter"])
            out[camera["name"], fix["curve"]][place] = fix["used"]
    return out


def fit(parameters: list[float], x: float) -> float:
    """Return the value of a camera fit at a wavelength."""
    a, b, c, d, e, f, g, h, i, j = parameters
    first = a * math.exp(-b * x * math.pow((x - c) / d, i))
    return first + e * math.exp(-f * x * math.pow((x - g) / h, j))


def peak_and_width(parameters: list[float]) -> tuple[int, int]:
    """Return a fit's peak, and the span not below half of it, in whole nm."""
    values = {x: fit(parameters, x) for x in GRID}
    peak = max(values, key=values.__getitem__)
    above = [x for x in GRID if values[x] >= values[peak] / 2]
    return peak, above[-1] - above[0]


def pinned_packages() -> bool:
    """Return whether the pinned packages are installed."""
    try:
        return all(metadata.version(p) == v for p, v in PINNED.items())
    except metadata.PackageNotFoundError:
        return False


class Regeneration(unittest.TestCase):
    """The folder holds what the script writes, and nothing else."""

    @unittest.skipUnless(pinned_packages(), "the pinned packages are not installed")
    def test_byte_for_byte(self) -> None:
        """A fresh export equals the checked-in folder."""
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, str(SCRIPT), "--output", folder], check=True)
            fresh = {
                p.relative_to(folder).as_posix(): p.read_bytes()
                for p in Path(folder).rglob("*")
                if p.is_file()
            }
        kept = {
            p.relative_to(DATA).as_posix(): p.read_bytes() for p in DATA.rglob("*") if p.is_file()
        }
        self.assertEqual(sorted(fresh), sorted(set(kept) - HAND_WRITTEN))
        for name, content in fresh.items():
            self.assertTrue(content == kept[name], f"{name} differs from a fresh export")

    def test_other_version_is_refused(self) -> None:
        """Another version of a package is refused in one clear line."""
        sys.path.insert(0, str(SCRIPT.parent))
        self.addCleanup(sys.path.remove, str(SCRIPT.parent))
        spec = importlib.util.spec_from_file_location("export_data", SCRIPT)
        module = importlib.util.module_from_spec(spec)
        sys.modules["export_data"] = module
        spec.loader.exec_module(module)
        module.PINNED = {"colour-science": "0.0.1"}
        complaint = module.missing_package()
        self.assertIn("colour-science 0.0.1 is needed", complaint)
        self.assertNotIn("\n", complaint)

    def test_no_strays(self) -> None:
        """Every file is in the manifest, a licence, or written by hand."""
        listed = {t["file"] for t in load_manifest()} | {"manifest.json"} | HAND_WRITTEN
        listed |= {f"licences/{p}.txt" for p in PINNED}
        present = {p.relative_to(DATA).as_posix() for p in DATA.rglob("*") if p.is_file()}
        self.assertEqual(present, listed)


class Manifest(unittest.TestCase):
    """Every table is described in full and as it is."""

    def test_fields(self) -> None:
        """Required fields are present and well formed."""
        for t in load_manifest():
            with self.subTest(t["file"]):
                self.assertEqual(t["quantity"], QUANTITIES[t["group"]])
                for key in ("unit", "source", "licence", "retrieved", "sha256"):
                    self.assertTrue(t[key].strip(), key)
                self.assertRegex(t["retrieved"], r"^\d{4}-\d\d-\d\d$")
                self.assertTrue(t["names"])
                content = (DATA / t["file"]).read_bytes()
                self.assertEqual(t["sha256"], hashlib.sha256(content).hexdigest())
                self.assertNotIn(b"\r", content)
                self.assertEqual("shape" in t, t["group"] != "rgb_spaces")
                self.assertEqual("response" in t, t["group"] == "observers")

    def test_names_are_unique(self) -> None:
        """No name occurs twice in a group, whatever its case."""
        seen = set()
        for t in load_manifest():
            for name in t["names"]:
                self.assertNotIn((t["group"], name.casefold()), seen)
                seen.add((t["group"], name.casefold()))

    def test_tables(self) -> None:
        """Columns, shapes and values are as the manifest says."""
        for t in load_manifest():
            if t["group"] == "rgb_spaces":
                continue
            with self.subTest(t["file"]):
                columns = read_table(t["file"])
                shape = t["shape"]
                count = round((shape["end_nm"] - shape["start_nm"]) / shape["interval_nm"]) + 1
                expected = [shape["start_nm"] + k * shape["interval_nm"] for k in range(count)]
                for column in columns.values():
                    self.assertEqual(list(column), expected)
                    self.assertTrue(all(math.isfinite(v) for v in column.values()))
                    if t["group"] != "daylight_basis":
                        self.assertTrue(all(v >= 0 for v in column.values()))
                if t["group"] in ("illuminants", "daylight_basis", "filters"):
                    self.assertEqual(list(columns), t["names"])
                else:
                    self.assertEqual(len(t["names"]), 1)
                if t["group"] == "observers":
                    header = {"xyz": "XYZ", "lms": "LMS", "camera": "RGB"}[t["response"]]
                    self.assertEqual(list(columns), list(header))
                    for row in t.get("to_xyz", []):
                        self.assertEqual(len(row), 3)
                if t["group"] == "filters":
                    self.assertTrue(all(v <= 1 for c in columns.values() for v in c.values()))

    def test_contents(self) -> None:
        """The promised names are there."""
        names = {g: set() for g in QUANTITIES}
        for t in load_manifest():
            names[t["group"]] |= set(t["names"])
        self.assertEqual(names["observers"], OBSERVERS)
        self.assertEqual(names["reflectances"], set(REFLECTANCE_COUNTS))
        self.assertEqual(names["rgb_spaces"], SPACES)
        self.assertEqual(len(names["illuminants"]), 115)
        for name, count in REFLECTANCE_COUNTS.items():
            self.assertEqual(len(find("reflectances", name)), count, name)
        for name in ("Lee 201 Full C.T. Blue", "Lee 204 Full C.T. Orange", "Lee 299 1.2ND"):
            self.assertIn(name, names["filters"])


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
        self.assertEqual(list(skin), ["CES15", "CES18", "TCS13", "TCS15"])
        tm30, cri = find("reflectances", "tm30"), find("reflectances", "cri")
        for name, column in skin.items():
            self.assertEqual(column, (tm30 | cri)[name])
            self.assertGreater(column[650], 1.4 * column[550])

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
