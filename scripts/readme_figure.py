#!/usr/bin/env python3
"""Draws the README's first picture: measured bodies above, the meshes of their recipes below.

    readme_figure.py SHAPE.ply RECIPE.astro [SHAPE.ply RECIPE.astro ...] -o docs/figures/measured_and_recipes.jpg

Needs the Python package (build/ci/python in PYTHONPATH) and Pillow. Recipes: fit_shape SHAPE.ply -o RECIPE.astro --spheres 80
"""
import argparse

import astrolith
import numpy as np
from PIL import Image

WIDTH, HEIGHT = 620, 420  # of one body
VIEWS = ((0.3, -1.0, 0.5), (0.2, 1.0, 0.35), (1.0, 0.4, 0.3), (1.0, 0.3, 0.2))


def shot(mesh, view):
    """A body at twice the size, for smooth edges."""
    return astrolith.render(mesh, views=[view], width=2 * WIDTH, height=2 * HEIGHT, sun=(-0.8, 0.45, 0.4))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+")
    parser.add_argument("-o", dest="output", required=True)
    given = parser.parse_args()
    pairs = list(zip(given.files[::2], given.files[1::2], VIEWS))
    measured = [shot(astrolith.read_mesh(shape), view) for shape, _, view in pairs]
    made = [shot(astrolith.mesh(astrolith.Recipe.read(recipe), triangles=1.5e6), view) for _, recipe, view in pairs]
    picture = Image.fromarray(np.vstack([np.hstack(measured), np.hstack(made)]))
    picture.resize((WIDTH * len(pairs), 2 * HEIGHT), Image.LANCZOS).save(given.output, quality=88)


if __name__ == "__main__":
    main()
