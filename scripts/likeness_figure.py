#!/usr/bin/env python3
"""Draws bodies of a kind: the meshes of recipes with a relief above, and below others with the heights drawn anew.

    likeness_figure.py RECIPE.astro [RECIPE.astro ...] -o docs/figures/likeness.jpg

Needs the Python package (build/ci/python in PYTHONPATH) and Pillow. Recipes: fit_shape SHAPE.ply -o RECIPE.astro --spheres 80
"""
import argparse

import astrolith
import numpy as np
from PIL import Image

WIDTH, HEIGHT = 620, 420  # of one body
VIEWS = ((0.3, -1.0, 0.5), (0.2, 1.0, 0.35), (1.0, 0.4, 0.3), (1.0, 0.3, 0.2))
SEEDS = (3, 4)


def shot(recipe, view):
    """A body at twice the size, for smooth edges."""
    mesh = astrolith.mesh(recipe, triangles=1e6)
    return astrolith.render(mesh, views=[view], width=2 * WIDTH, height=2 * HEIGHT, sun=(-0.8, 0.45, 0.4))


def column(file, view):
    recipe = astrolith.Recipe.read(file)
    return np.vstack([shot(recipe, view)] + [shot(recipe.like(seed), view) for seed in SEEDS])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipes", nargs="+")
    parser.add_argument("-o", dest="output", required=True)
    given = parser.parse_args()
    columns = [column(file, view) for file, view in zip(given.recipes, VIEWS)]
    picture = Image.fromarray(np.hstack(columns))
    size = (WIDTH * len(columns), HEIGHT * (1 + len(SEEDS)))
    picture.resize(size, Image.LANCZOS).save(given.output, quality=85)


if __name__ == "__main__":
    main()
