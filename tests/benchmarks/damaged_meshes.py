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

    def crack(self):
        """Along the border of a tenth of the surface, the vertices are there twice, a tenth of an edge apart."""
        inside = self.around(0.1)
        outer = np.unique(np.delete(self.faces, inside, axis=0))
        edge = np.linalg.norm(self.vertices[self.faces[0, 0]] - self.vertices[self.faces[0, 1]])
        corner, centers = np.argwhere(np.isin(self.faces[inside], outer)), self.corners().mean(1)
        face, old = inside[corner[:, 0]], self.faces[inside[corner[:, 0]], corner[:, 1]]
        border, first = np.unique(old, return_index=True)
        to = centers[face[first]] - self.vertices[border]
        twins = self.add_vertices(self.vertices[border] + 0.1 * edge * to / np.linalg.norm(to, axis=1)[:, None])
        self.faces[face, corner[:, 1]] = twins[np.searchsorted(border, old)]

    def hole(self, share):
        """A share of the surface is missing in one place."""
        self.faces = np.delete(self.faces, self.around(share), axis=0)

    def flipped(self):
        """One face looks inwards."""
        self.faces[len(self.faces) // 2] = self.faces[len(self.faces) // 2, ::-1]

    def all_flipped(self):
        """All faces look inwards."""
        self.faces = self.faces[:, ::-1].copy()

    def doubled(self):
        """One face in a hundred is there twice, with vertices of its own."""
        self.add_faces(self.add_vertices(self.vertices[self.faces[::100]].reshape(-1, 3)).reshape(-1, 3))

    def fin(self):
        """A sheet of four faces, 3 % of the diagonal high, stands on two edges."""
        face = len(self.faces) // 4
        (a, b, c), normal = self.faces[face], self.normals()[face]
        tops = self.add_vertices(self.vertices[[a, b, c]] + 0.03 * self.diagonal() * normal / np.linalg.norm(normal))
        self.add_faces([[a, b, tops[0]], [b, tops[1], tops[0]], [b, c, tops[1]], [c, tops[2], tops[1]]])

    def t_junctions(self):
        """One face in fifty has a vertex in the middle of an edge that its neighbour does not have."""
        a, b, c = self.faces[::50].T.copy()
        middle = self.add_vertices((self.vertices[a] + self.vertices[b]) / 2)
        self.faces[::50] = np.stack([a, middle, c], axis=1)
        self.add_faces(np.stack([middle, b, c], axis=1))

    def two_bodies(self):
        """A moon of a fifth of the size stands beside the body."""
        count = len(self.vertices)
        self.add_vertices(0.2 * self.vertices + [1.5 * self.diagonal(), 0, 0])
        self.add_faces(self.faces + count)

    def crossing(self):
        """A patch of .2 % of the surface is drawn sideways and down, so that it folds through its surroundings."""
        patch = self.around(0.002)
        normal = self.normals()[patch[0]]
        normal /= np.linalg.norm(normal)
        side = np.cross(normal, [0.3, 0.5, 0.8])
        moved = np.setdiff1d(self.faces[patch], np.delete(self.faces, patch, axis=0))
        self.vertices[moved] += self.diagonal() * (0.05 * side / np.linalg.norm(side) - 0.02 * normal)


WAYS = {"clean": lambda shape: None, "crack": Shape.crack, "hole of 1 %": lambda shape: shape.hole(0.01),
        "hole of 4 %": lambda shape: shape.hole(0.04), "flipped facet": Shape.flipped, "all flipped": Shape.all_flipped,
        "doubled facets": Shape.doubled, "fin": Shape.fin, "T-junctions": Shape.t_junctions, "two bodies": Shape.two_bodies,
        "self-intersection": Shape.crossing, "hole of 10 %": lambda shape: shape.hole(0.1),
        "hole of 10 %, --wrap": lambda shape: shape.hole(0.1)}  # fmt: skip


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
