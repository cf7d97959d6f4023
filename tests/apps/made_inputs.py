"""Inputs that the tests of programs make: closed meshes and photos of any size."""

import math
import struct
import zlib


def write_ball(file, length=1.4, rings=8, around=12):
    """A ball of meridians and parallels, stretched along x: a closed mesh of 168 facets."""
    points = [(0.0, 0.0, 1.0)]
    for i in range(1, rings):
        for k in range(around):
            a, b = math.pi * i / rings, 2 * math.pi * k / around
            points.append((length * math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)))
    points.append((0.0, 0.0, -1.0))
    at = lambda i, k: 1 + (i - 1) * around + k % around
    faces = []
    for k in range(around):
        faces.append((0, at(1, k), at(1, k + 1)))
        for i in range(1, rings - 1):
            faces += [(at(i, k), at(i + 1, k), at(i + 1, k + 1)), (at(i, k), at(i + 1, k + 1), at(i, k + 1))]
        faces.append((len(points) - 1, at(rings - 1, k + 1), at(rings - 1, k)))
    lines = ["v %r %r %r" % p for p in points] + ["f %d %d %d" % tuple(v + 1 for v in f) for f in faces]
    file.write_text("\n".join(lines) + "\n")


def write_heights(file, side=48):
    """An Arc ASCII grid of `side` x `side` heights in metres, 2 m apart."""
    height = lambda x, y: 30 * math.sin(0.9 * x + 0.4 * y) + 20 * math.sin(0.7 * y - 0.5 * x)
    rows = "\n".join(" ".join(f"{height(x, y):.3f}" for x in range(side)) for y in range(side))
    file.write_text(f"ncols {side}\nnrows {side}\nxllcorner 0\nyllcorner 0\ncellsize 2\n{rows}\n")


def write_photo(file, channels, side=64):
    """A PNG of `side` x `side` pixels of waves with a little noise."""
    state, rows = 1, b""
    for y in range(side):
        rows += b"\0"
        for x in range(side):
            for c in range(channels):
                state = (1103515245 * state + 12345) % 2**31
                wave = math.sin(0.9 * x + 0.4 * y + c) + math.sin(0.7 * y - 0.5 * x)
                rows += bytes([int(128 + 30 * wave + state / 2**31 * 40)])
    chunk = lambda name, data: struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    header = struct.pack(">IIBBBBB", side, side, 8, 0 if channels == 1 else 2, 0, 0, 0)
    file.write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    )
