# SPDX-License-Identifier: Apache-2.0
"""What script/release packed: unpacked and run, also where /proc is not mounted; complete, and the same when packed again.

script/release runs it: METAMER_OUT is the folder of packages, METAMER_TREE the install tree that they were made of, METAMER_OFX
the folder of the bundle for Linux that was packed alone.
"""

import hashlib
import json
import os
import plistlib
import re
import subprocess
import sys
import tarfile
import tempfile
import time
import unittest
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
OUT = Path(os.environ["METAMER_OUT"])
TREE = Path(os.environ["METAMER_TREE"])
OFX = Path(os.environ["METAMER_OFX"])
[CHANGES] = OUT.glob("metamer-*-changes.md")
VERSION = CHANGES.name.split("-")[1]
SECONDS = os.environ["SOURCE_DATE_EPOCH"]
FOLDERS = {"linux": "Linux-x86-64", "windows": "Win64", "macos": "MacOS"}
PLUGINS = {"linux": "/usr/OFX/Plugins", "windows": r"C:\Program Files\Common Files\OFX\Plugins", "macos": "/Library/OFX/Plugins"}
HOSTS = ("Resolve", "Nuke", "Fusion", "Flame", "Baselight")
RECIPE = "metamer: 1\nspace: ACEScct\ninput: {illuminant: D65}\noutput: {illuminant: HP1}\n"
# A folder of nothing over /proc, seen by the command alone.
WITHOUT_PROC = ["unshare", "--mount", "--map-root-user", "sh", "-c", 'mount -t tmpfs none /proc && exec "$@"', "sh"]


def run(*words, **options):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, **options)


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)

    def unpacked(self):
        """The tree of the archive, in a folder that nobody thought of."""
        to = self.folder / "some where" / self.id().rsplit(".", 1)[1]
        to.mkdir(parents=True)
        [archive] = OUT.glob(f"metamer-{VERSION}-linux-*.tar.gz")
        with tarfile.open(archive) as members:
            members.extractall(to, filter="tar")
        [tree] = to.iterdir()
        return tree

    def succeed(self, *words, **options):
        ended = run(*words, **options)
        self.assertEqual((ended.returncode, ended.stderr), (0, ""), words)
        return ended.stdout

    def test_the_tree_runs_where_it_is_unpacked_with_and_without_proc(self):
        tree = self.unpacked()
        own = {"PATH": os.environ["PATH"], "LC_ALL": "C.UTF-8"}
        recipe = self.folder / "look.yaml"
        recipe.write_text(RECIPE, encoding="utf-8")
        link = self.folder / "lutgen"
        link.symlink_to(tree / "bin/lutgen")
        made = []
        for name, prefix, program in (("plain", [], tree / "bin/lutgen"), ("link", [], link), ("bare", WITHOUT_PROC, tree / "bin/lutgen"),
                                      ("bare link", WITHOUT_PROC, link), ("relative", WITHOUT_PROC, os.path.relpath(link, "/"))):
            cube = self.folder / f"{name}.cube"
            self.succeed(*prefix, program, "bake", recipe, "-o", cube, "--size", "17", cwd="/", env=own)
            self.assertIn("HP1", self.succeed(*prefix, program, "list", "illuminants", cwd="/", env=own))
            still = tree / "share/metamer/demo/files/still.png"
            self.succeed(*prefix, program, "apply", "--quiet", recipe, still, self.folder / f"{name}.png", cwd="/", env=own)
            self.assertGreater((self.folder / f"{name}.png").stat().st_size, 1000)
            made.append(cube.read_bytes())
        self.assertGreater(len(made[0]), 17**3 * 10)
        self.assertEqual(set(made), {made[0]})
        # The programs that lutgen starts, and their libraries.
        for prefix in ([], WITHOUT_PROC):
            table = self.succeed(*prefix, tree / "bin/lutgen", "compare", self.folder / "plain.cube", self.folder / "link.cube", env=own)
            self.assertRegex(table, r"\b0\.0")
            self.assertIn("usage", self.succeed(*prefix, tree / "bin/spectral_ref", "render", "--help", env=own).lower())

    def test_its_manual_leads_to_files_that_are_there(self):
        manual = self.unpacked() / "share/metamer"
        pages = [manual / "README.md", *sorted((manual / "docs").rglob("*.md"))]
        self.assertGreater(len(pages), 25)
        lost = []
        for page in pages:
            text = re.sub(r"^ *```.*?^ *```$", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
            for link in re.findall(r"\]\(([^)\s#]+)", text):
                if not re.match(r"[a-z]+:", link) and not (page.parent / link).exists():
                    lost.append(f"{page.relative_to(manual)}: {link}")
        self.assertEqual(lost, [])

    def test_the_ten_minute_starts_run_with_it_as_printed(self):
        """The lines by which README.md unpacks it, then those of each start, by the test of pages."""
        [archive] = OUT.glob(f"metamer-{VERSION}-linux-*.tar.gz")
        folder = self.folder / "a reader's"
        folder.mkdir()
        (folder / archive.name).symlink_to(archive)
        [lines] = re.findall(r"^```sh\n(tar xzf metamer-.*?)^```$", (ROOT / "README.md").read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
        told = self.succeed("bash", "-euo", "pipefail", "-c", lines + "command -v lutgen; pwd", cwd=folder).split("\n")
        tree = folder / archive.name.removesuffix(".tar.gz")
        self.assertEqual(told[-3:], [str(tree / "bin/lutgen"), str(tree / "try"), ""])
        names = [page.stem for page in sorted((tree / "share/metamer/docs/start").glob("*.md")) if page.stem != "README"]
        self.assertEqual(len(names), 4)
        own = dict(os.environ, METAMER_BIN=str(tree / "bin"), PYTHONPATH=str(tree / "python"))
        ended = run(sys.executable, "-B", ROOT / "tests/docs/test_pages.py", *(f"Pages.test_{name}" for name in names), env=own)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        self.assertIn("Ran 4 tests", ended.stderr)

    def test_a_system_without_proc_is_really_without(self):
        self.assertEqual(self.succeed(*WITHOUT_PROC, "ls", "/proc"), "")

    def test_looks_come_with_every_table_that_they_name(self):
        with tarfile.open(OUT / f"metamer-{VERSION}-configs.tar.gz") as archive:
            names = set(archive.getnames())
            configs = [name for name in names if name.endswith(".ocio")]
            self.assertTrue(configs)
            for name in configs:
                text = archive.extractfile(name).read().decode()
                paths = re.findall(r"^search_path: (.*)$", text, re.MULTILINE)
                folders = [name.rpartition("/")[0] + "/" + path for path in (paths[0].split(":") if paths else [""])]
                tables = set(re.findall(r"src: ([^\s,}]+)", text))
                self.assertTrue(tables)
                missing = [table for table in tables if not any(os.path.normpath(f"{at}/{table}") in names for at in folders)]
                self.assertEqual(missing, [])

    def test_bundles_come_with_notes_and_a_library(self):
        zips = {path.stem.rsplit("-", 1)[1]: path for path in OUT.glob(f"metamer-{VERSION}-ofx-*.zip")}
        self.assertIn(set(zips), ({"linux"}, set(FOLDERS)))
        for system, path in zips.items():
            with self.subTest(system), zipfile.ZipFile(path) as archive:
                self.assertIsNone(archive.testzip())
                library = archive.getinfo(f"metamer.ofx.bundle/Contents/{FOLDERS[system]}/metamer.ofx")
                self.assertEqual(library.external_attr >> 16, 0o100755)
                notes = archive.read("INSTALL.txt").decode()
                for word in (f"metamer {VERSION}", PLUGINS[system], *HOSTS):
                    self.assertIn(word, notes)
                if system == "linux":
                    versions = re.findall(r"Name: GLIBC_2\.(\d+)", self.succeed("readelf", "--version-info", "--wide",
                                                                               OFX / "metamer.ofx.bundle/Contents/Linux-x86-64/metamer.ofx"))
                    self.assertIn(f"Needs glibc 2.{max(map(int, versions))} or newer", notes)
                elif system == "macos":
                    self.assertIn("xattr -dr com.apple.quarantine /Library/OFX/Plugins/metamer.ofx.bundle", notes)
                facts = plistlib.loads(archive.read("metamer.ofx.bundle/Contents/Info.plist"))
                self.assertEqual(facts["CFBundleVersion"], VERSION)
                self.assertEqual([info.filename for info in archive.infolist() if info.date_time != archive.infolist()[0].date_time], [])

    def test_the_package_of_tools_holds_what_runs(self):
        [deb] = OUT.glob(f"metamer-tools_{VERSION}_*.deb")
        names = set(re.findall(r"\./(\S+?)(?: -> \S+)?$", self.succeed("dpkg-deb", "--contents", deb), re.MULTILINE))
        self.assertLessEqual({"usr/bin/lutgen", "opt/metamer/bin/lutgen", "opt/metamer/libexec/lutgen-pictures",
                              "opt/metamer/share/metamer/data/manifest.json"}, names)
        self.assertIn(f"Version: {VERSION}", self.succeed("dpkg-deb", "--info", deb))

    def test_readme_names_the_libraries_that_the_archive_finds_on_no_bare_system(self):
        [deb] = OUT.glob(f"metamer-tools_{VERSION}_*.deb")
        needed = {word.split()[0] for word in self.succeed("dpkg-deb", "--field", deb, "Depends").split(",")}
        [named] = re.findall(r"`apt-get install ([^`]+)`", (ROOT / "README.md").read_text(encoding="utf-8"))
        self.assertEqual(needed - {"libc6", "libgcc-s1", "libstdc++6", "zlib1g"}, set(named.split()))

    def test_the_playground_lies_in_the_tree_too(self):
        for page in OUT.glob(f"metamer-{VERSION}-playground.html"):
            self.assertEqual((self.unpacked() / "share/metamer/playground/metamer.html").read_bytes(), page.read_bytes())

    def test_the_lists_fit_the_files(self):
        sums = dict(line.split()[::-1] for line in (OUT / "SHA256SUMS").read_text().splitlines())
        self.assertEqual(set(sums), {path.name for path in OUT.glob("metamer*")})
        for name, wanted in sums.items():
            self.assertEqual(hashlib.sha256((OUT / name).read_bytes()).hexdigest(), wanted, name)
        self.assertTrue(CHANGES.read_text(encoding="utf-8").startswith(f"## [{VERSION}]"))
        parts = json.loads((OUT / f"metamer-{VERSION}.cdx.json").read_text(encoding="utf-8"))
        self.assertEqual(parts["metadata"]["component"]["version"], VERSION)
        self.assertEqual(parts["metadata"]["timestamp"], time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(int(SECONDS))))
        self.assertLessEqual({"opencolorio", "openimageio", "libeigen3-dev", "ziglang"}, {part["name"] for part in parts["components"]})

    def test_packed_again_it_is_the_same_byte_for_byte(self):
        again = self.folder / "again"
        self.succeed(ROOT / "script/releases/pack", TREE, again, VERSION, SECONDS, OFX)
        names = sorted(path.name for path in again.iterdir())
        self.assertGreaterEqual(len(names), 7)
        self.assertEqual([name for name in names if (again / name).read_bytes() != (OUT / name).read_bytes()], [])


if __name__ == "__main__":
    unittest.main()
