#!/usr/bin/env python3
"""Damages measured shapes in ten ways, fits each, and compares the fits with the clean shape.

    damaged_meshes.py BIN SHAPE.ply ... [--spheres 60] [--only WAY ...] [--keep FOLDER] [-o TABLE.md]

BIN holds fit_shape, synth and compare; a shape is a closed mesh as binary .ply. A row is a shape and a way to damage it;
its figures are the mean distance between the clean shape and the fit's mesh, in percent of the diagonal, how much that
is more than for the fit of the clean shape, the seconds of the fit, and what fit_shape said of the repair. A hole of
10 % must be refused, and is then wrapped. Exit status 1 if a damaged shape was not fitted, or the hole of 10 % was.
"""

import argparse
import array
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import time

from garbled_meshes import Mesh


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def norm(a):
    return math.sqrt(sum(x * x for x in a))


class Shape(Mesh):
    """A mesh whose vertices and faces can be added."""

    def at(self, v):
        return list(self.vertices[self.point(v)])

    def add_vertex(self, p):
        self.vertices += array.array("f", [*p, *[0.0] * (self.floats - 3)])
        return len(self.vertices) // self.floats - 1

    def area(self, face):
        a, b, c = map(self.at, face)
        return norm(cross(sub(b, a), sub(c, a))) / 2

    def normal(self, face):
        a, b, c = map(self.at, face)
        n = cross(sub(b, a), sub(c, a))
        return [x / max(norm(n), 1e-300) for x in n]

    def center(self, face):
        return [sum(x) / 3 for x in zip(*map(self.at, face))]

    def diagonal(self):
        axes = [self.vertices[axis :: self.floats] for axis in range(3)]
        return norm([max(a) - min(a) for a in axes])

    def around(self, share):
        """The faces nearest to the middle one that hold this share of the area."""
        middle = self.center(self.faces[len(self.faces) // 3])
        order = sorted(range(len(self.faces)), key=lambda f: norm(sub(self.center(self.faces[f]), middle)))
        left, chosen = share * sum(map(self.area, self.faces)), []
        for f in order:
            left -= self.area(self.faces[f])
            if left < 0:
                break
            chosen.append(f)
        return chosen or order[:1]

    def save(self, file):
        count = len(self.vertices) // self.floats
        self.header = [f"element vertex {count}" if "element vertex" in line else line for line in self.header]
        self.write(file)


def crack(shape):
    """Along the border of a tenth of the surface, the vertices are there twice, a tenth of an edge apart."""
    inside = set(shape.around(0.1))
    outer = {v for f, face in enumerate(shape.faces) if f not in inside for v in face}
    edge = norm(sub(shape.at(shape.faces[0][0]), shape.at(shape.faces[0][1])))
    twins = {}
    for f in inside:
        for k, v in enumerate(shape.faces[f]):
            if v not in outer:
                continue
            if v not in twins:
                to = sub(shape.center(shape.faces[f]), shape.at(v))
                twins[v] = shape.add_vertex([p + 0.1 * edge * x / norm(to) for p, x in zip(shape.at(v), to)])
            shape.faces[f][k] = twins[v]


def hole(share):
    def without(shape):
        gone = set(shape.around(share))
        shape.faces = [face for f, face in enumerate(shape.faces) if f not in gone]

    without.__doc__ = f"{100 * share:g} % of the surface is missing in one place."
    return without


def flipped(shape):
    """One face looks inwards."""
    shape.faces[len(shape.faces) // 2].reverse()


def all_flipped(shape):
    """All faces look inwards."""
    for face in shape.faces:
        face.reverse()


def doubled(shape):
    """One face in a hundred is there twice, with vertices of its own."""
    for face in shape.faces[::100]:
        shape.faces.append([shape.add_vertex(shape.at(v)) for v in face])


def fin(shape):
    """A sheet of four faces, 3 % of the diagonal high, stands on two edges."""
    a, b, c = shape.faces[len(shape.faces) // 4]
    n = shape.normal([a, b, c])
    tops = [shape.add_vertex([p + 0.03 * shape.diagonal() * x for p, x in zip(shape.at(v), n)]) for v in (a, b, c)]
    shape.faces += [[a, b, tops[0]], [b, tops[1], tops[0]], [b, c, tops[1]], [c, tops[2], tops[1]]]


def t_junctions(shape):
    """One face in fifty has a vertex in the middle of an edge that its neighbour does not have."""
    for f in range(0, len(shape.faces), 50):
        a, b, c = shape.faces[f]
        m = shape.add_vertex([(p + q) / 2 for p, q in zip(shape.at(a), shape.at(b))])
        shape.faces[f] = [a, m, c]
        shape.faces.append([m, b, c])


def two_bodies(shape):
    """A moon of a fifth of the size stands beside the body."""
    far, count = 1.5 * shape.diagonal(), len(shape.vertices) // shape.floats
    new = [shape.add_vertex([0.2 * x + (far if k == 0 else 0.0) for k, x in enumerate(shape.at(v))]) for v in range(count)]
    shape.faces += [[new[v] for v in face] for face in list(shape.faces)]


def crossing(shape):
    """A patch of .2 % of the surface is drawn sideways and down, so that it folds through its surroundings."""
    patch = shape.around(0.002)
    n = shape.normal(shape.faces[patch[0]])
    rim = {v for f in set(range(len(shape.faces))) - set(patch) for v in shape.faces[f]}
    for v in {v for f in patch for v in shape.faces[f]} - rim:
        p = [x - 0.02 * shape.diagonal() * y for x, y in zip(shape.at(v), n)]
        side = cross(n, [0.3, 0.5, 0.8])
        p = [x + 0.05 * shape.diagonal() * y / norm(side) for x, y in zip(p, side)]
        shape.vertices[shape.point(v)] = array.array("f", p)


WAYS = {
    "clean": lambda shape: None,
    "crack": crack,
    "hole of 1 %": hole(0.01),
    "hole of 4 %": hole(0.04),
    "flipped facet": flipped,
    "all flipped": all_flipped,
    "doubled facets": doubled,
    "fin": fin,
    "T-junctions": t_junctions,
    "two bodies": two_bodies,
    "self-intersection": crossing,
    "hole of 10 %": hole(0.1),
    "hole of 10 %, --wrap": hole(0.1),
}


def fit(arguments, file, folder, options):
    """The status, the seconds, the words and the summary of a fit."""
    recipe, summary = folder / "fit.json", folder / "summary.json"
    command = [arguments.bin / "fit_shape", file, "-o", recipe, "--base-only", "--noise-seeds", "0", "--summary", summary]
    start = time.monotonic()
    done = subprocess.run([*command, "--spheres", str(arguments.spheres), *options], capture_output=True, text=True, check=False)
    seconds = time.monotonic() - start
    return done.returncode, seconds, done.stderr.splitlines(), json.loads(summary.read_text()) if done.returncode == 0 else {}


def distance(arguments, clean, folder):
    """Mean distance between the clean shape and the fit, in percent of the diagonal."""
    mesh, result = folder / "fit.ply", folder / "compare.json"
    synth = [arguments.bin / "synth", folder / "fit.json", "-o", mesh, "--resolution", "200", "--quiet"]
    subprocess.run(synth, check=True)
    subprocess.run([arguments.bin / "compare", clean, mesh, "-o", result, "--quiet", "--points", "1000", "--strict"], check=True)
    return 100 * json.loads(result.read_text())["mean_distance"]


def rows(arguments, clean, folder):
    base = None
    for way, damage in WAYS.items():
        if arguments.only and way not in ("clean", *arguments.only):
            continue
        shape, file = Shape(clean), folder / "damaged.ply"
        damage(shape)
        shape.save(file)
        if arguments.keep:
            arguments.keep.mkdir(exist_ok=True)
            shape.save(arguments.keep / f"{clean.stem}_{way.replace(' ', '_')}.ply")
        status, seconds, lines, _ = fit(arguments, file, folder, ["--wrap"] if "--wrap" in way else [])
        refused = way == "hole of 10 %"
        words = next((line for line in lines if str(file) in line and " x " not in line), "").replace(f"{file}: ", "")
        if status != 0:
            yield f"| {clean.stem} | {way} | refused | | {seconds:.1f} | {words} |", refused and status == 2
            continue
        error = distance(arguments, clean, folder)
        base = error if base is None else base
        yield f"| {clean.stem} | {way} | {error:.4f} | {error - base:+.4f} | {seconds:.1f} | {words} |", not refused


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("shapes", type=pathlib.Path, nargs="+")
    parser.add_argument("--spheres", type=int, default=60)
    parser.add_argument("--only", nargs="+", choices=list(WAYS), default=[])
    parser.add_argument("--keep", type=pathlib.Path, help="keep the damaged meshes here")
    parser.add_argument("-o", "--output", type=pathlib.Path)
    arguments = parser.parse_args()
    table = ["| shape | damage | distance, % | more than clean | s | said |", "|---|---|---|---|---|---|"]
    print("\n".join(table))
    wrong = 0
    with tempfile.TemporaryDirectory() as name:
        for clean in arguments.shapes:
            for row, fine in rows(arguments, clean, pathlib.Path(name)):
                table.append(row)
                wrong += not fine
                print(row, flush=True)
    if arguments.output:
        arguments.output.write_text("\n".join(table) + "\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
