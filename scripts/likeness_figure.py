#!/usr/bin/env python3
"""Draws bodies of a kind: the meshes of recipes with a relief above, and below others with the heights drawn anew.

    likeness_figure.py RECIPE.astro [RECIPE.astro ...] -o docs/figures/likeness.jpg
    likeness_figure.py ITOKAWA.astro --sheet 8 -o docs/figures/thousand.jpg      # the first 64 seeds of one body

Needs the Python package (build/ci/python in PYTHONPATH) and Pillow. Recipes: fit_shape SHAPE.ply -o RECIPE.astro --spheres 80
"""
import argparse

import astrolith
import numpy as np
from PIL import Image

WIDTH, HEIGHT = 620, 420  # of one body
VIEWS = ((0.3, -1.0, 0.5), (0.2, 1.0, 0.35), (1.0, 0.4, 0.3), (1.0, 0.3, 0.2))
SEEDS = (3, 4)


def shot(recipe, view, triangles=1e6, size=(WIDTH, HEIGHT)):
    """A body at twice the size, for smooth edges."""
    mesh = astrolith.mesh(recipe, triangles=triangles)
    return astrolith.render(mesh, views=[view], width=2 * size[0], height=2 * size[1], sun=(-0.8, 0.45, 0.4))


def sheet(file, side):
    """The likenesses of one body with the seeds 0, 1 ..., row by row."""
    recipe, size = astrolith.Recipe.read(file), (180, 120)
    shots = [shot(recipe.like(seed), VIEWS[0], 4e4, size) for seed in range(side * side)]
    return np.vstack([np.hstack(shots[row * side:(row + 1) * side]) for row in range(side)])


def column(file, view):
    recipe = astrolith.Recipe.read(file)
    return np.vstack([shot(recipe, view)] + [shot(recipe.like(seed), view) for seed in SEEDS])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipes", nargs="+")
    parser.add_argument("--sheet", type=int, metavar="SIDE", help="a square of likenesses of the first recipe")
    parser.add_argument("-o", dest="output", required=True)
    given = parser.parse_args()
    if given.sheet:
        pixels = sheet(given.recipes[0], given.sheet)
    else:
        pixels = np.hstack([column(file, view) for file, view in zip(given.recipes, VIEWS)])
    half = (pixels.shape[1] // 2, pixels.shape[0] // 2)
    Image.fromarray(pixels).resize(half, Image.LANCZOS).save(given.output, quality=85)


if __name__ == "__main__":
    main()
