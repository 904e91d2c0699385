#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fetches a release that metamer links, as the pin beside this file names it by hash, into the user's cache.

    fetch.py opencolorio|openimageio [--print]    --print: only say where it lies, or is to lie

The folder holds include, lib and the licences; cmake/MetamerReleases.cmake knows its name. The libraries come out of the
release's wheel, which carries the same ones whatever Python it is for, the headers out of its source distribution. Needs
pip, and what pip asks for a source distribution's name and version: setuptools and scikit-build-core.
"""

import argparse
import hashlib
import os
import platform
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

LICENCES = ("LICENSE", "LICENSE.md", "THIRD-PARTY.md")
# The wheel is asked for by name, so that the same file is fetched whatever Python runs this.
WHEEL = ["--implementation", "cp", "--python-version", "3.11", "--abi", "cp311"]
MANYLINUX = ["2014", "_2_17", "_2_27", "_2_28"]


def opencolorio_header(template, version):
    """OpenColorABI.h, as the release's own build makes it."""
    major, minor, patch = version.split(".")
    return fill(template, {
        "OCIO_NAMESPACE": f"OpenColorIO_v{major}_{minor}",
        "OpenColorIO_VERSION": version,
        "OpenColorIO_VERSION_MAJOR": major,
        "OpenColorIO_VERSION_MINOR": minor,
        "OpenColorIO_VERSION_PATCH": patch,
        "OpenColorIO_VERSION_RELEASE_TYPE": "",
    })


def openimageio_header(template, version):
    """oiioversion.h, as the release's own build makes it; the wheels are C++17, with Imath inside."""
    major, minor, patch, tweak = version.split(".")
    template = re.sub(r"^#cmakedefine01 OIIO_TBB$", "#define OIIO_TBB 0", template, flags=re.MULTILINE)
    return fill(template, {
        "PROJECT_VERSION_MAJOR": major,
        "PROJECT_VERSION_MINOR": minor,
        "PROJECT_VERSION_PATCH": patch,
        "PROJECT_VERSION_TWEAK": tweak,
        "PROJECT_VERSION_RELEASE_TYPE": "",
        "PROJ_NAMESPACE": "OpenImageIO",
        "PROJ_VERSION_NAMESPACE": f"v{major}_{minor}",
        "OIIO_USE_COMPILED_FMT_VALUE": "0",
        "Imath_VERSION_MAJOR": "3",
        "Imath_VERSION_MINOR": "1",
        "CMAKE_CXX_STANDARD": "17",
    })


def fill(template, values):
    return re.sub(r"@(\w+)@", lambda match: values[match.group(1)], template)


@dataclass(frozen=True)
class Release:
    """What of a release's files is wanted, and where."""

    title: str  # the folder of its headers too
    libraries: str  # names inside the wheel
    headers: str  # folder inside the source distribution
    made: str  # the header that its build makes of a template, NAME.in
    make: Callable[[str, str], str]
    forwarded: tuple[str, ...]  # headers of fmt's that its own build puts beside its own
    remedy: str

    @property
    def name(self):
        return self.title.lower()

    @property
    def pin(self):
        return Path(__file__).with_name(f"{self.name}.txt")

    @property
    def version(self):
        return re.search(rf"^{self.name}==([0-9.]+)", self.pin.read_text(), re.MULTILINE | re.IGNORECASE).group(1)

    @property
    def folder(self):
        """Named for the release and for what pins it: another pin is another folder."""
        cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
        pin = hashlib.sha256(self.pin.read_bytes()).hexdigest()[:12]
        return cache / "metamer" / f"{self.name}-{self.version}-{pin}"


RELEASES = [
    Release("OpenColorIO", r"PyOpenColorIO/(libOpenColorIO\.so)", "include/OpenColorIO", "OpenColorABI.h", opencolorio_header, (),
            "build with a system OpenColorIO: cmake -DMETAMER_OCIO=system"),
    Release("OpenImageIO", r"OpenImageIO/lib/(libOpenImageIO(?:_Util)?\.so\.[0-9.]+)", "src/include/OpenImageIO", "oiioversion.h",
            openimageio_header, ("format.h", "ostream.h", "printf.h"),
            "build with a system OpenImageIO: cmake -DMETAMER_OIIO=system"),
]


def download(release, to, *arguments):
    """The one file that pip brings; pip checks its hash."""
    to.mkdir()
    subprocess.run(
        [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps", "--require-hashes",
         "--requirement", release.pin, "--dest", to, *arguments], check=True)
    [file] = to.iterdir()
    return file


def unpack_libraries(release, wheel, to):
    (to / "lib").mkdir()
    with zipfile.ZipFile(wheel) as archive:
        for name in archive.namelist():
            if match := re.fullmatch(release.libraries, name):
                (to / "lib" / match.group(1)).write_bytes(archive.read(name))


def unpack_headers(release, sources, to):
    folder = to / "include" / release.title
    with tarfile.open(sources) as archive:
        for member in archive.getmembers():
            _, _, name = member.name.partition("/")
            if name in LICENCES:
                (to / name).write_bytes(archive.extractfile(member).read())
            elif match := re.fullmatch(rf"{release.headers}/((?:\w+/)*\w+\.h(?:pp)?)", name):
                path = folder / match.group(1)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(archive.extractfile(member).read())
            elif name == f"{release.headers}/{release.made}.in":
                folder.mkdir(parents=True, exist_ok=True)
                (folder / release.made).write_text(release.make(archive.extractfile(member).read().decode(), release.version))
    for header in release.forwarded:
        path = folder / "detail" / "fmt" / header
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"#include <fmt/{header}>\n")


def fetch(release):
    to = release.folder
    to.parent.mkdir(parents=True, exist_ok=True)
    work = Path(tempfile.mkdtemp(prefix="fetching-", dir=to.parent))
    try:
        tags = [f"manylinux{tag}_{platform.machine()}" for tag in MANYLINUX]
        platforms = [word for tag in tags for word in ("--platform", tag)]
        wheel = download(release, work / "wheel", "--only-binary", ":all:", *WHEEL, *platforms)
        # pip takes a source distribution only together with its metadata, made by the build tool that is installed.
        sources = download(release, work / "sources", "--no-binary", ":all:", "--no-build-isolation")
        (work / "made").mkdir()
        unpack_libraries(release, wheel, work / "made")
        unpack_headers(release, sources, work / "made")
        shutil.rmtree(to, ignore_errors=True)
        (work / "made").rename(to)
    finally:
        shutil.rmtree(work)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("release", choices=[release.name for release in RELEASES])
    parser.add_argument("--print", action="store_true", help="say where it lies, or is to lie, and fetch nothing")
    arguments = parser.parse_args()
    [release] = [release for release in RELEASES if release.name == arguments.release]
    if not arguments.print and not release.folder.is_dir():
        try:
            fetch(release)
        except subprocess.CalledProcessError:
            sys.exit(f"script/releases/fetch.py: {release.title} {release.version} cannot be fetched for {platform.machine()}; "
                     f"{release.remedy}")
    print(release.folder)


if __name__ == "__main__":
    main()
