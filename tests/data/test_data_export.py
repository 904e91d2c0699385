# SPDX-License-Identifier: Apache-2.0
"""Checks of data/: its manifest, and that it can be regenerated.

Only the test of regeneration needs the pinned packages; it is skipped without them.
"""

from __future__ import annotations

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

from tables import DATA, find, load_manifest, PINNED, read_table, SCRIPT, SPACES

HAND_WRITTEN = {
    "README.md",
    "words.json",
    "sources/camera_fits.json",
    "sources/chromophore_fits.json",
    "sources/model_skins_100.csv",
    "sources/skin_network.json",
    "sources/skin_prior.json",
}
QUANTITIES = {
    "illuminants": "spectral power distribution",
    "daylight_basis": "spectral power distribution",
    "observers": "sensitivity",
    "filters": "transmittance",
    "reflectances": "reflectance",
    "rgb_spaces": "chromaticity",
    "pixels": "linear ACEScg",
    "chromophores": "molar extinction",
    "skin_prior": "distribution of parameters",
    "skin_network": "weights of networks",
    "uplifts": "basis of reflectances",
}
NO_SPECTRA = {"rgb_spaces", "pixels", "skin_prior", "skin_network", "uplifts"}
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
    "model skins": 100,
    "colorchecker": 24,
    "colorchecker ohta": 24,
    "colorchecker iso 17321-1": 24,
    "pmc": 30,
    "tm30": 99,
    "cri": 15,
    "cqs": 15,
    "rawtoaces 190": 190,
    "skin": 3,
    "virtual skins": 1000,
}


def pinned_packages() -> bool:
    """Return whether the pinned packages are installed."""
    try:
        return all(metadata.version(p) == v for p, v in [*PINNED.items(), ("scikit-image", "0.26.0")])
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
                self.assertEqual("shape" in t, t["group"] not in NO_SPECTRA)
                self.assertEqual("response" in t, t["group"] == "observers")

    def test_words(self) -> None:
        """Each light, filter and observer is described once; nothing else is."""
        document = json.loads((DATA / "words.json").read_text(encoding="utf-8"))
        self.assertTrue(document["source"].strip())
        described = [(e["group"], name) for e in document["entries"] for name in e["names"]]
        named = {
            (t["group"], name)
            for t in load_manifest()
            if t["group"] in ("illuminants", "filters", "observers")
            for name in t["names"]
        }
        self.assertEqual(len(described), len(set(described)))
        self.assertEqual(set(described), named)
        for entry in document["entries"]:
            self.assertTrue(entry["description"].strip() and entry["words"], entry["names"])

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
            if t["group"] in NO_SPECTRA:
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
                if t["group"] in ("illuminants", "daylight_basis", "filters", "chromophores"):
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


if __name__ == "__main__":
    unittest.main()
