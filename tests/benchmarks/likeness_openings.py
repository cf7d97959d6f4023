#!/usr/bin/env python3
"""Whether bodies of a kind fall apart or crack: parts, handles, and ground that a ball cannot touch from outside.

    likeness_openings.py build/release/bin RECIPE... [--seeds 13] [--laid]       needs the Python package, NumPy and SciPy

A ball of 1.5 mean edges of the model is laid on each vertex of an evened mesh. Ground whose ball holds another vertex, nearer
than .7 of its radius to its middle, lies in a cleft that is too narrow for it. The table has the share of such ground and its
largest connected piece, in vertices, of the recipe's own mesh and of the likes: their median and their worst.
"""
import pathlib
import statistics
import tempfile

import astrolith
import numpy
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from measure import Run, arguments_of, head, row


def clefts(mesh, radius):
    """The share of vertices that the ball cannot touch, and how many of them the largest piece has."""
    middles = mesh.vertices + radius * mesh.normals
    nearest = cKDTree(mesh.vertices).query(middles)[0]
    closed = nearest < 0.7 * radius
    edges = mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    edges = edges[closed[edges].all(axis=1)]
    links = coo_matrix((numpy.ones(len(edges)), edges.T), shape=[len(closed)] * 2)
    pieces = numpy.bincount(connected_components(links, directed=False)[1][closed], minlength=1)
    return closed.mean(), int(pieces.max())


def judged(programs, recipe, edge, facets, folder, *options):
    mesh, summary = folder / "body.ply", folder / "body.json"
    Run(programs / "synth", recipe, *options, "--triangles", facets, "--even", "-o", mesh, "--summary", summary, "--quiet")
    made = astrolith.read_mesh(mesh)
    euler = len(made.vertices) - len(made.faces) // 2
    parts = connected_components(coo_matrix((numpy.ones(len(made.faces)), made.faces[:, :2].T), shape=[len(made.vertices)] * 2))[0]
    return parts, parts - euler // 2, *clefts(made, 1.5 * edge)


def row_of(programs, recipe, given, folder):
    edge = next(layer for layer in astrolith.Recipe.read(recipe)["layers"] if layer["type"] == "relief")["edge"]
    facets = int(astrolith.mesh(astrolith.Recipe.read(recipe), resolution=128).area / (3**0.5 / 4 * edge**2))
    word = "--laid" if given.laid else "--like"
    own = judged(programs, recipe, edge, facets, folder)
    likes = [judged(programs, recipe, edge, facets, folder, word, "--seed", seed) for seed in range(1, given.seeds + 1)]
    same = sum(like[:2] == own[:2] for like in likes)
    cells = []
    for column, form in ((2, "{:.5f}"), (3, "{:.0f}")):
        values = [like[column] for like in likes]
        cells += [form.format(v) for v in (own[column], statistics.median(values), max(values))]
    return (recipe.stem, f"{own[0]}, {own[1]}", f"{same} of {len(likes)}", *cells)


if __name__ == "__main__":
    given = arguments_of(__doc__, "programs", "recipes", seeds=13, laid={"action": "store_true"})
    head("body", "parts, handles", "likes with as many", "share closed", "median", "worst", "largest piece", "median", "worst")
    with tempfile.TemporaryDirectory() as folder:
        for recipe in given.recipes:
            row(*row_of(given.programs, recipe, given, pathlib.Path(folder)))
