#!/usr/bin/env python3
"""Holds the albedos of --albedo against what was published of known bodies.

albedo.py SYNTH [--triangles 4e6]       needs numpy

Each row has a body of the library with boulders, its median normal albedo, the full width of its distribution at half
maximum over the median, and the shares of the surface below and above some albedo. Colours of vertices hold albedos in
steps of some 1 %.
"""
import argparse
import pathlib
import subprocess
import tempfile

import numpy

# Word, body, unit's metres, and what was published: median and its error, width, and where.
BODIES = [
    ("bennu", "bennu", 1e3, (0.046, 0.002), 0.25, "Golish et al. 2021"),
    ("ryugu", "bennu", 1e3, (0.0406, 0.001), None, "Yokota et al. 2021"),
    ("itokawa", "itokawa", 1e3, (0.27, 0.02), None, "Tatsumi et al."),
    ("vesta", "eros", 1e3, (0.38, 0.04), 0.17, "Li et al. 2013"),
]


def vertex_colors(ply):
    data = ply.read_bytes()
    header, _, body = data.partition(b"end_header\n")
    kinds = {b"float": "<f4", b"uchar": "u1"}
    lines = header.split(b"\n")
    first = next(i for i, line in enumerate(lines) if line.startswith(b"element vertex"))
    fields = []
    for line in lines[first + 1 :]:
        if not line.startswith(b"property"):
            break
        fields.append((line.split()[2].decode(), kinds[line.split()[1]]))
    return numpy.frombuffer(body, fields, int(lines[first].split()[2]))


def albedos(synth, word, body, metres, triangles, folder):
    ply = folder / f"{word}.ply"
    finish = ["--finish", "bennu", "--from", str(20 / metres), "--to", str(3 / metres)] if body != "eros" else []
    command = [synth, body, *finish, "--albedo", word, "--triangles", triangles, "-o", ply, "--quiet"]
    subprocess.run(list(map(str, command)), check=True)
    green = vertex_colors(ply)["green"] / 255.0
    linear = numpy.where(green <= 0.04045, green / 12.92, ((green + 0.055) / 1.055) ** 2.4)
    normal = next(row[3][0] for row in BODIES if row[0] == word)
    return linear * normal / (0.36 * (normal / 0.1) ** (1 / 3))


def width_at_half(values):
    """The full width at half maximum of a smooth curve through the histogram."""
    counts, edges = numpy.histogram(numpy.log(values), bins=numpy.linspace(-5, 0.5, 551))
    kernel = numpy.exp(-0.5 * (numpy.arange(-6, 7) / 2.0) ** 2)
    smooth = numpy.convolve(counts, kernel / kernel.sum(), "same")
    above = numpy.nonzero(smooth > 0.5 * smooth.max())[0]
    return numpy.exp(edges[above[-1] + 1]) - numpy.exp(edges[above[0]])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("synth")
    parser.add_argument("--triangles", default="4e6")
    given = parser.parse_args()
    print("| albedo | median (published) | width / median (published) | above twice the median | below half | source |")
    print("|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        for word, body, metres, (normal, error), width, source in BODIES:
            values = albedos(given.synth, word, body, metres, given.triangles, pathlib.Path(name))
            median = numpy.median(values)
            print(
                f"| {word} | {median:.4f} ({normal} +- {error}) | {width_at_half(values) / median:.2f} ({width or '-'}) "
                f"| {(values > 2 * median).mean():.4f} | {(values < median / 2).mean():.4f} | {source} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
