#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fetches the OpenColorIO that metamer links, as script/opencolorio.txt pins it by hash, into the user's cache.

    fetch_opencolorio.py [--print]    --print: only say where it lies, or is to lie

The folder holds include/OpenColorIO, lib/libOpenColorIO.so and the licences; cmake/MetamerOpenColorIO.cmake knows its
name. Needs pip and setuptools, which pip asks for a source distribution's name and version.
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
from pathlib import Path

PIN = Path(__file__).with_name("opencolorio.txt")
LIBRARY = "libOpenColorIO.so"
LICENCES = ("LICENSE", "THIRD-PARTY.md")
# The wheel is asked for by name, so that the same file is fetched whatever Python runs this.
WHEEL = ["--implementation", "cp", "--python-version", "3.11", "--abi", "cp311"]
MANYLINUX = ["2014", "_2_17", "_2_27", "_2_28"]


def version():
    return re.search(r"^OpenColorIO==([0-9.]+)", PIN.read_text(), re.MULTILINE).group(1)


def folder():
    """Named for the release and for what pins it: another pin is another folder."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    pin = hashlib.sha256(PIN.read_bytes()).hexdigest()[:12]
    return cache / "metamer" / f"opencolorio-{version()}-{pin}"


def download(to, *arguments):
    """The one file that pip brings; pip checks its hash."""
    to.mkdir()
    subprocess.run(
        [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps", "--require-hashes",
         "--requirement", PIN, "--dest", to, *arguments], check=True)
    [file] = to.iterdir()
    return file


def abi_header(template):
    """OpenColorABI.h, as the release's own build makes it."""
    major, minor, patch = version().split(".")
    values = {
        "OCIO_NAMESPACE": f"OpenColorIO_v{major}_{minor}",
        "OpenColorIO_VERSION": version(),
        "OpenColorIO_VERSION_MAJOR": major,
        "OpenColorIO_VERSION_MINOR": minor,
        "OpenColorIO_VERSION_PATCH": patch,
        "OpenColorIO_VERSION_RELEASE_TYPE": "",
    }
    return re.sub(r"@(\w+)@", lambda match: values[match.group(1)], template)


def unpack_library(wheel, to):
    (to / "lib").mkdir()
    with zipfile.ZipFile(wheel) as archive:
        (to / "lib" / LIBRARY).write_bytes(archive.read(f"PyOpenColorIO/{LIBRARY}"))


def unpack_headers(sources, to):
    headers = to / "include" / "OpenColorIO"
    headers.mkdir(parents=True)
    with tarfile.open(sources) as archive:
        for member in archive.getmembers():
            _, _, name = member.name.partition("/")
            if name in LICENCES:
                (to / name).write_bytes(archive.extractfile(member).read())
            elif re.fullmatch(r"include/OpenColorIO/\w+\.h", name):
                (headers / Path(name).name).write_bytes(archive.extractfile(member).read())
            elif name == "include/OpenColorIO/OpenColorABI.h.in":
                (headers / "OpenColorABI.h").write_text(abi_header(archive.extractfile(member).read().decode()))


def fetch(to):
    to.parent.mkdir(parents=True, exist_ok=True)
    work = Path(tempfile.mkdtemp(prefix="fetching-", dir=to.parent))
    try:
        tags = [f"manylinux{tag}_{platform.machine()}" for tag in MANYLINUX]
        platforms = [word for tag in tags for word in ("--platform", tag)]
        wheel = download(work / "wheel", "--only-binary", ":all:", *WHEEL, *platforms)
        # pip takes a source distribution only together with its metadata, made by the setuptools that is installed.
        sources = download(work / "sources", "--no-binary", ":all:", "--no-build-isolation")
        (work / "made").mkdir()
        unpack_library(wheel, work / "made")
        unpack_headers(sources, work / "made")
        shutil.rmtree(to, ignore_errors=True)
        (work / "made").rename(to)
    finally:
        shutil.rmtree(work)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--print", action="store_true", help="say where it lies, or is to lie, and fetch nothing")
    arguments = parser.parse_args()
    to = folder()
    if not arguments.print and not to.is_dir():
        try:
            fetch(to)
        except subprocess.CalledProcessError:
            sys.exit(f"script/fetch_opencolorio.py: OpenColorIO {version()} cannot be fetched for {platform.machine()}; "
                     "build with a system OpenColorIO: cmake -DMETAMER_OCIO=system")
    print(to)


if __name__ == "__main__":
    main()
