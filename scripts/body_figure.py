#!/usr/bin/env python3
"""Draws rows of bodies for README.md and docs/gallery.md.

    body_figure.py SHAPE.ply RECIPE.astro [...] -o measured_and_recipes.jpg   # measured bodies above the meshes of their recipes
    body_figure.py RECIPE.astro [...] -o likeness.jpg                         # recipes above others with their heights drawn anew
    body_figure.py ITOKAWA.astro --sheet 8 -o thousand.jpg                    # the first 64 seeds of one body
    body_figure.py --library 6 -o library.jpg                                 # the bodies of the library, six in a row

Needs the Python package (build/ci/python in PYTHONPATH) and Pillow. Recipes: fit_shape SHAPE.ply -o RECIPE.astro --spheres 80
"""
import argparse

import astrolith
import numpy as np
from PIL import Image

VIEWS = ((0.3, -1.0, 0.5), (0.2, 1.0, 0.35), (1.0, 0.4, 0.3), (1.0, 0.3, 0.2))


def shot(body, view, triangles=1e6, size=(620, 420)):
    """A body, as a recipe or a mesh, at twice the size, for smooth edges."""
    mesh = astrolith.mesh(body, triangles=triangles) if isinstance(body, astrolith.Recipe) else body
    return astrolith.render(mesh, views=[view], width=2 * size[0], height=2 * size[1], sun=(-0.8, 0.45, 0.4))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*")
    parser.add_argument("--sheet", type=int, metavar="SIDE", help="a square of likenesses of the first recipe")
    parser.add_argument("--library", type=int, metavar="COLUMNS", help="a sheet of the bodies of the library")
    parser.add_argument("-o", dest="output", required=True)
    given = parser.parse_args()
    recipes = [astrolith.Recipe.read(file) for file in given.files if file.endswith(".astro")]
    if given.library:
        shots = [shot(astrolith.Recipe.read(name), (1.0, 0.6, 0.5), 2e5, (250, 200)) for name in astrolith.library()]
        rows = [shots[first:first + given.library] for first in range(0, len(shots), given.library)]
    elif given.sheet:
        shots = [shot(recipes[0].like(seed), VIEWS[0], 4e4, (180, 120)) for seed in range(given.sheet**2)]
        rows = [shots[first:first + given.sheet] for first in range(0, len(shots), given.sheet)]
    elif len(recipes) < len(given.files):
        shapes = [astrolith.read_mesh(file) for file in given.files[::2]]
        rows = [[shot(body, view, 1.5e6) for body, view in zip(bodies, VIEWS)] for bodies in (shapes, recipes)]
    else:
        rows = [[shot(drawn, view) for drawn, view in zip(bodies, VIEWS)]
                for bodies in (recipes, *([recipe.like(seed) for recipe in recipes] for seed in (3, 4)))]  # fmt: skip
    picture = Image.fromarray(np.vstack([np.hstack(row) for row in rows]))
    picture.resize((picture.width // 2, picture.height // 2), Image.LANCZOS).save(given.output, quality=88)


if __name__ == "__main__":
    main()
