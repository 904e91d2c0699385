# SPDX-License-Identifier: Apache-2.0
"""Reads what a library for macOS says of itself: Apple's loader.h, fat.h and cs_blobs.h, as far as the tests ask."""

import hashlib
import struct
from dataclasses import dataclass

FAT_MAGIC = 0xCAFEBABE
MAGIC_64 = 0xFEEDFACF
MH_BUNDLE = 8
X86_64, ARM64 = 0x01000007, 0x0100000C
# Flags of the header: what the loader has to join with other libraries' symbols of the same name.
WEAK_DEFINES, BINDS_TO_WEAK = 0x8000, 0x10000
TWO_LEVEL = 0x80
LC_SYMTAB, LC_LOAD_DYLIB, LC_SEGMENT_64, LC_CODE_SIGNATURE = 0x2, 0xC, 0x19, 0x1D
LC_DYLD_INFO_ONLY, LC_BUILD_VERSION = 0x80000022, 0x32
PLATFORM_MACOS = 1
# Of symbols: defined nowhere, seen by others, may be missing.
N_TYPE, N_EXT, N_WEAK_REF = 0x0E, 0x01, 0x40
SIGNATURE, CODE_DIRECTORY, SHA256 = 0xFADE0CC0, 0xFADE0C02, 2


def slices(data):
    """Processor: Slice, of a universal file."""
    magic, count = struct.unpack_from(">II", data)
    if magic != FAT_MAGIC:
        raise ValueError("not a universal file")
    found = {}
    for k in range(count):
        processor, _, offset, size, align = struct.unpack_from(">IIIII", data, 8 + 20 * k)
        if offset % (1 << align):
            raise ValueError(f"slice {k} is not aligned")
        found[processor] = Slice(data[offset : offset + size])
    return found


def uleb128(data, at):
    value = shift = 0
    while True:
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        shift += 7
        if byte < 0x80:
            return value, at


def text_at(data, at):
    return data[at : data.index(0, at)].decode()


@dataclass(frozen=True)
class Slice:
    data: bytes

    @property
    def header(self):
        """Magic, processor, its variant, kind of file, count of commands, their size, flags."""
        return struct.unpack_from("<7I", self.data)

    @property
    def kind(self):
        return self.header[3]

    @property
    def flags(self):
        return self.header[6]

    def commands(self, wanted=None):
        """(kind, offset) of each load command."""
        at, count = 32, self.header[4]
        for _ in range(count):
            kind, size = struct.unpack_from("<II", self.data, at)
            if wanted in (None, kind):
                yield kind, at
            at += size
        if at != 32 + self.header[5]:
            raise ValueError("load commands are of another size than the header says")

    def numbers(self, kind, form):
        """The numbers after the first two of the one load command of that kind."""
        [(_, at)] = self.commands(kind)
        return struct.unpack_from(form, self.data, at + 8)

    def libraries(self):
        return [text_at(self.data, at + struct.unpack_from("<I", self.data, at + 8)[0]) for _, at in self.commands(LC_LOAD_DYLIB)]

    def minimum(self):
        """Platform, and the version that it has to be of at least."""
        platform, version = self.numbers(LC_BUILD_VERSION, "<II")
        return platform, (version >> 16, version >> 8 & 0xFF, version & 0xFF)

    def undefined(self):
        """Name: description, of each symbol that the system is asked for."""
        at, count, texts, _ = self.numbers(LC_SYMTAB, "<IIII")
        found = {}
        for k in range(count):
            name, kind, _, description, _ = struct.unpack_from("<IBBHQ", self.data, at + 16 * k)
            if kind & N_EXT and not kind & N_TYPE:
                found[text_at(self.data, texts + name)] = description
        return found

    def weak_binds(self):
        """Bytes of the loader's list of symbols that it has to join with other libraries'."""
        return self.numbers(LC_DYLD_INFO_ONLY, "<10I")[5]

    def exports(self):
        """Names in the tree of what the loader finds."""
        offset, size = self.numbers(LC_DYLD_INFO_ONLY, "<10I")[8:]
        tree, found = self.data[offset : offset + size], set()

        def walk(at, name):
            length, at = uleb128(tree, at)
            if length:
                found.add(name)
            at += length
            count, at = tree[at], at + 1
            for _ in range(count):
                part = text_at(tree, at)
                child, at = uleb128(tree, at + len(part) + 1)
                walk(child, name + part)

        walk(0, "")
        return found

    def signed_pages(self):
        """What the signature covers, in bytes from the start, and pages whose hash is not the one that it names."""
        offset, size = self.numbers(LC_CODE_SIGNATURE, "<II")
        signature = self.data[offset : offset + size]
        magic, _, count = struct.unpack_from(">III", signature)
        parts = [struct.unpack_from(">II", signature, 12 + 8 * k)[1] for k in range(count)]
        directories = [part for part in parts if struct.unpack_from(">I", signature, part)[0] == CODE_DIRECTORY]
        if magic != SIGNATURE or len(directories) != 1:
            raise ValueError("no signature of one directory")
        directory = signature[directories[0] :]
        hashes, _, _, pages, limit = struct.unpack_from(">5I", directory, 16)
        length, algorithm, _, shift = struct.unpack_from(">4B", directory, 36)
        if (length, algorithm) != (32, SHA256) or pages != -(-limit >> shift):
            raise ValueError("hashes are not SHA-256 of each page")
        wrong = []
        for page in range(pages):
            begin = page << shift
            own = hashlib.sha256(self.data[begin : min(begin + (1 << shift), limit)]).digest()
            if own != directory[hashes + 32 * page : hashes + 32 * page + 32]:
                wrong.append(page)
        return limit, wrong

    def file_end(self):
        """End of what the loader maps, in bytes from the start."""
        return max(sum(struct.unpack_from("<QQ", self.data, at + 40)) for _, at in self.commands(LC_SEGMENT_64))
