# SPDX-License-Identifier: Apache-2.0
"""Uncompressed OpenEXR files by their layout alone, for what Python's OpenEXR does not write: subsampled channels, pyramids."""

import struct

import numpy as np

MAGIC = 20000630
TILED = 0x200
TYPES = {1: "<f2", 2: "<f4"}
HALF, FLOAT = TYPES


def attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def header(channels, width, height, flags=0, extra=b""):
    """@param channels  name to (type, sampling)"""
    rows = b"".join(name.encode() + b"\0" + struct.pack("<iB3xii", kind, 0, sampling, sampling)
                    for name, (kind, sampling) in sorted(channels.items())) + b"\0"
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    return (struct.pack("<ii", MAGIC, 2 | flags) + attribute("channels", "chlist", rows)
            + attribute("compression", "compression", b"\0") + attribute("dataWindow", "box2i", box)
            + attribute("displayWindow", "box2i", box) + attribute("lineOrder", "lineOrder", b"\0")
            + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
            + attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0))
            + attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + extra + b"\0")


def with_table(head, chunks):
    place = len(head) + 8 * len(chunks)
    table = b""
    for chunk in chunks:
        table += struct.pack("<Q", place)
        place += len(chunk)
    return head + table + b"".join(chunks)


def scanlines(planes):
    """@param planes  name to (type, sampling, values at the channel's own resolution); one with sampling 1 at least"""
    height, width = next(values.shape for _, sampling, values in planes.values() if sampling == 1)
    chunks = []
    for y in range(height):
        row = b"".join(values[y // sampling].astype(TYPES[kind]).tobytes()
                       for _, (kind, sampling, values) in sorted(planes.items()) if y % sampling == 0)
        chunks.append(struct.pack("<ii", y, len(row)) + row)
    return with_table(header({name: plane[:2] for name, plane in planes.items()}, width, height), chunks)


def pyramid(levels, tile):
    """RGB of halves in square tiles, @param levels  of a square picture, each half as wide as the one before, down to 1"""
    size = levels[0].shape[0]
    chunks = []
    for number, level in enumerate(levels):
        side = level.shape[0]
        for y in range(0, side, tile):
            for x in range(0, side, tile):
                block = level[y:y + tile, x:x + tile].astype(np.float16)
                data = b"".join(row[:, k].tobytes() for row in block for k in (2, 1, 0))
                chunks.append(struct.pack("<5i", x // tile, y // tile, number, number, len(data)) + data)
    extra = attribute("tiles", "tiledesc", struct.pack("<IIB", tile, tile, 1))
    return with_table(header(dict.fromkeys("RGB", (HALF, 1)), size, size, TILED, extra), chunks)


def pyramid_levels(data, size, tile):
    """What pyramid() was given, of a file with the same chunks in the same order."""
    levels, side = [], size
    while side >= 1:
        levels.append(np.zeros((side, side, 3), np.float16))
        side //= 2
    counts = sum((-(-level.shape[0] // tile)) ** 2 for level in levels)
    head = data.index(struct.pack("<5i", 0, 0, 0, 0, 6 * min(size, tile) ** 2)) - 8 * counts
    for (place,) in struct.iter_unpack("<Q", data[head:head + 8 * counts]):
        x, y, number, _, length = struct.unpack("<5i", data[place:place + 20])
        level = levels[number]
        block = level[y * tile:(y + 1) * tile, x * tile:(x + 1) * tile]
        rows = np.frombuffer(data, np.float16, length // 2, place + 20).reshape(block.shape[0], 3, block.shape[1])
        block[...] = rows.transpose(0, 2, 1)[..., ::-1]
    return levels
