#!/usr/bin/env python3
"""Damages measured shapes in ten ways, fits each, and compares the fits with the clean shape.

    damaged_meshes.py BIN SHAPE.ply ... [--spheres 60] [--only WAY ...] [--keep FOLDER]

BIN holds fit_shape, synth and compare; a shape is a closed mesh as binary .ply. A row is a shape and a way to damage it;
its figures are the mean distance between the clean shape and the fit's mesh, in percent of the diagonal, how much that
is more than for the fit of the clean shape, the seconds of the fit, and what fit_shape said of the repair. A hole of
10 % must be refused, and is then wrapped. Exit status 1 if a damaged shape was not fitted, or the hole of 10 % was.
"""

import pathlib
import sys
import tempfile

import numpy as np

from garbled_meshes import Mesh
from measure import Run, arguments_of, head, row


class Shape(Mesh):
    """A mesh whose vertices and faces can be added."""

    def add_vertices(self, points):
        """Their numbers."""
        first = len(self.vertices)
        self.vertices = np.concatenate([self.vertices, np.atleast_2d(points)])
        return np.arange(first, len(self.vertices))

    def add_faces(self, faces):
        self.faces = np.concatenate([self.faces, faces])

    def corners(self):
        return self.vertices[self.faces].astype(float)

    def normals(self):
        """Twice as long as the areas of the faces."""
        a, b, c = self.corners().transpose(1, 0, 2)
        return np.cross(b - a, c - a)

    def diagonal(self):
        return np.linalg.norm(np.ptp(self.vertices, axis=0))

    def around(self, share):
        """The faces nearest to the middle one that hold this share of the area."""
        centers, areas = self.corners().mean(1), np.linalg.norm(self.normals(), axis=1)
        order = np.argsort(np.linalg.norm(centers - centers[len(centers) // 3], axis=1), kind="stable")
        return order[: max(1, np.searchsorted(np.cumsum(areas[order]), share * areas.sum(), "right"))]


def crack(shape):
    """Along the border of a tenth of the surface, the vertices are there twice, a tenth of an edge apart."""
    inside = shape.around(0.1)
    outer = np.unique(np.delete(shape.faces, inside, axis=0))
    edge = np.linalg.norm(shape.vertices[shape.faces[0, 0]] - shape.vertices[shape.faces[0, 1]])
    corner, centers = np.argwhere(np.isin(shape.faces[inside], outer)), shape.corners().mean(1)
    face, old = inside[corner[:, 0]], shape.faces[inside[corner[:, 0]], corner[:, 1]]
    border, first = np.unique(old, return_index=True)
    to = centers[face[first]] - shape.vertices[border]
    twins = shape.add_vertices(shape.vertices[border] + 0.1 * edge * to / np.linalg.norm(to, axis=1)[:, None])
    shape.faces[face, corner[:, 1]] = twins[np.searchsorted(border, old)]


def hole(share):
    def without(shape):
        shape.faces = np.delete(shape.faces, shape.around(share), axis=0)

    without.__doc__ = f"{100 * share:g} % of the surface is missing in one place."
    return without


def flipped(shape):
    """One face looks inwards."""
    shape.faces[len(shape.faces) // 2] = shape.faces[len(shape.faces) // 2, ::-1]


def all_flipped(shape):
    """All faces look inwards."""
    shape.faces = shape.faces[:, ::-1].copy()


def doubled(shape):
    """One face in a hundred is there twice, with vertices of its own."""
    shape.add_faces(shape.add_vertices(shape.vertices[shape.faces[::100]].reshape(-1, 3)).reshape(-1, 3))


def fin(shape):
    """A sheet of four faces, 3 % of the diagonal high, stands on two edges."""
    face = len(shape.faces) // 4
    (a, b, c), normal = shape.faces[face], shape.normals()[face]
    tops = shape.add_vertices(shape.vertices[[a, b, c]] + 0.03 * shape.diagonal() * normal / np.linalg.norm(normal))
    shape.add_faces([[a, b, tops[0]], [b, tops[1], tops[0]], [b, c, tops[1]], [c, tops[2], tops[1]]])


def t_junctions(shape):
    """One face in fifty has a vertex in the middle of an edge that its neighbour does not have."""
    a, b, c = shape.faces[::50].T.copy()
    middle = shape.add_vertices((shape.vertices[a] + shape.vertices[b]) / 2)
    shape.faces[::50] = np.stack([a, middle, c], axis=1)
    shape.add_faces(np.stack([middle, b, c], axis=1))


def two_bodies(shape):
    """A moon of a fifth of the size stands beside the body."""
    count = len(shape.vertices)
    shape.add_vertices(0.2 * shape.vertices + [1.5 * shape.diagonal(), 0, 0])
    shape.add_faces(shape.faces + count)


def crossing(shape):
    """A patch of .2 % of the surface is drawn sideways and down, so that it folds through its surroundings."""
    patch = shape.around(0.002)
    normal = shape.normals()[patch[0]]
    normal /= np.linalg.norm(normal)
    side = np.cross(normal, [0.3, 0.5, 0.8])
    moved = np.setdiff1d(shape.faces[patch], np.delete(shape.faces, patch, axis=0))
    shape.vertices[moved] += shape.diagonal() * (0.05 * side / np.linalg.norm(side) - 0.02 * normal)


WAYS = {"clean": lambda shape: None, "crack": crack, "hole of 1 %": hole(0.01), "hole of 4 %": hole(0.04),
        "flipped facet": flipped, "all flipped": all_flipped, "doubled facets": doubled, "fin": fin,
        "T-junctions": t_junctions, "two bodies": two_bodies, "self-intersection": crossing,
        "hole of 10 %": hole(0.1), "hole of 10 %, --wrap": hole(0.1)}  # fmt: skip


def distance(given, clean, folder):
    """Mean distance between the clean shape and the fit, in percent of the diagonal."""
    mesh = folder / "fit.ply"
    Run(given.bin / "synth", folder / "fit.json", "-o", mesh, "--resolution", 200, "--quiet")
    return 100 * Run(given.bin / "compare", clean, mesh, "--json", "--quiet", "--points", 1000, "--strict").json()["mean_distance"]


def measured(given, clean, folder):
    """Prints the rows of a shape. How many of them are not as they should be."""
    base, wrong, file = None, 0, folder / "damaged.ply"
    for way, damage in WAYS.items():
        if given.only and way not in ("clean", *given.only):
            continue
        shape = Shape(clean)
        damage(shape)
        shape.write(file)
        if given.keep:
            given.keep.mkdir(exist_ok=True)
            shape.write(given.keep / f"{clean.stem}_{way.replace(' ', '_')}.ply")
        run = Run(given.bin / "fit_shape", file, "-o", folder / "fit.json", "--base-only", "--noise-seeds", 0, "--spheres",
                  given.spheres, *(["--wrap"] if "--wrap" in way else []), check=False)  # fmt: skip
        words = next((line for line in run.errors.splitlines() if str(file) in line and " x " not in line), "")
        cells = ["refused", ""]
        if run.status == 0:
            error = distance(given, clean, folder)
            base = error if base is None else base
            cells = [f"{error:.4f}", f"{error - base:+.4f}"]
        wrong += run.status != (2 if way == "hole of 10 %" else 0)
        row(clean.stem, way, *cells, f"{run.clock:.1f}", words.replace(f"{file}: ", ""))
    return wrong


if __name__ == "__main__":
    given = arguments_of(__doc__, "bin", "shapes", spheres=60, only={"nargs": "+", "choices": list(WAYS), "default": []},
                         keep={"type": pathlib.Path, "help": "keep the damaged meshes here"})  # fmt: skip
    head("shape", "damage", "distance, %", "more than clean", "s", "said")
    with tempfile.TemporaryDirectory() as name:
        sys.exit(1 if sum([measured(given, clean, pathlib.Path(name)) for clean in given.shapes]) else 0)
