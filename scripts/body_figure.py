#!/usr/bin/env python3
"""Draws rows of bodies for README.md and docs/gallery.md.

    body_figure.py SHAPE.ply RECIPE.astro [...] -o measured_and_recipes.jpg   # measured bodies above the meshes of their recipes
    body_figure.py RECIPE.astro [...] -o likeness.jpg                         # recipes above others with their heights drawn anew
    body_figure.py ITOKAWA.astro --sheet 8 -o thousand.jpg                    # the first 64 seeds of one body
    body_figure.py --library 6 -o library.jpg                                 # the bodies of the library, six in a row
    body_figure.py --draws 8 -o drawn_bodies.jpg                              # the first 48 draws of the library's population
    body_figure.py --kinds -o kinds.jpg                                       # ten kinds of bodies, from examples and the library
    body_figure.py RECIPE.astro --zoom X Y Z --finish itokawa -o zoom.jpg     # a body, and its ground at a point ever finer

Needs the Python package (build/ci/python in PYTHONPATH) and Pillow. Recipes: fit_shape SHAPE.ply -o RECIPE.astro --spheres 80
"""
import argparse
from pathlib import Path

import astrolith
import numpy as np
from PIL import Image

VIEWS = ((0.3, -1.0, 0.5), (0.2, 1.0, 0.35), (1.0, 0.4, 0.3), (1.0, 0.3, 0.2))

EXAMPLES = Path(__file__).parent.parent / "synthesis/examples"
ROUGH = {"details": "relief", "finish": "bennu", "from_": 50, "to": 2}
KINDS = (
    (EXAMPLES / "rubble_pile.json", {}),
    ("asteroids", {"near": "bennu", "diameter": "500", "seed": 2, **ROUGH}),
    ("itokawa", {"like": True, "seed": 5, "finer": 1, "finish": "itokawa", "from_": 0.04, "to": 0.002}),
    ("asteroids", {"class_": "contact_binary", "diameter": "600", "seed": 4, **ROUGH}),
    (EXAMPLES / "monolith.json", {}),
    ("eros", {"like": True, "seed": 2, "finer": 2}),
    (EXAMPLES / "steins.json", {}),
    (EXAMPLES / "lutetia.json", {}),
    (EXAMPLES / "comet_nucleus.json", {}),
    (EXAMPLES / "ceres.json", {}),
)


def shot(body, view, triangles=1e6, size=(620, 420), sun=(-0.8, 0.45, 0.4)):
    """A body, as a recipe or a mesh, at twice the size, for smooth edges."""
    mesh = astrolith.mesh(body, triangles=triangles) if isinstance(body, astrolith.Recipe) else body
    return astrolith.render(mesh, views=[view], width=2 * size[0], height=2 * size[1], sun=sun)


def zoom(recipe, place, finish, size=(620, 620)):
    """The body, and squares of its ground about a place: each a fifth as long, with what the finish draws down to 1/100 of it."""
    whole = astrolith.mesh(recipe, triangles=1e6)
    normal = whole.normals[((whole.vertices - place) ** 2).sum(1).argmin()]
    view = normal + 0.6 * np.cross(normal, (0, 0, 1))
    shots, side = [shot(whole, view, size=size)], np.ptp(whole.vertices, 0).max() / 6
    for _ in range(3):
        ground = astrolith.mesh(recipe, patch=(*place, side), aligned=True, resolution=320, finish=finish, to=side / 100)
        wide = shot(ground, view, size=(2 * size[0], 2 * size[1]), sun=(-0.6, 0.5, 0.9))
        shots.append(wide[size[1]:-size[1], size[0]:-size[0]])
        side /= 5
    return [shots[:2], shots[2:]]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*")
    parser.add_argument("--sheet", type=int, metavar="SIDE", help="a square of likenesses of the first recipe")
    parser.add_argument("--library", type=int, metavar="COLUMNS", help="a sheet of the bodies of the library")
    parser.add_argument("--draws", type=int, metavar="COLUMNS", help="a sheet of 48 bodies that nobody has seen; a divisor of 48")
    parser.add_argument("--kinds", action="store_true", help="a sheet of ten kinds of bodies")
    parser.add_argument("--zoom", type=float, nargs=3, metavar=("X", "Y", "Z"), help="the ground at this point of the recipe")
    parser.add_argument("--finish", default="itokawa", help="the known body whose boulders lie on that ground")
    parser.add_argument("-o", dest="output", required=True)
    given = parser.parse_args()
    recipes = [astrolith.Recipe.read(file) for file in given.files if file.endswith(".astro")]
    if given.library:
        shots = [shot(astrolith.Recipe.read(name), (1.0, 0.6, 0.5), 2e5, (250, 200)) for name in astrolith.library()]
        rows = [shots[first:first + given.library] for first in range(0, len(shots), given.library)]
    elif given.draws:
        drawn = (astrolith.mesh("asteroids", seed=seed, albedo="drawn", triangles=1e5) for seed in range(48))
        shots = [shot(mesh, (1.0, 0.6, 0.5), size=(180, 150)) for mesh in drawn]
        rows = [shots[first:first + given.draws] for first in range(0, len(shots), given.draws)]
    elif given.kinds:
        made = (astrolith.mesh(recipe, resolution=512, min_component=1e-3, **options) for recipe, options in KINDS)
        shots = [shot(mesh, (0.3, -1.0, 0.35), size=(380, 300)) for mesh in made]
        rows = [shots[:5], shots[5:]]
    elif given.zoom:
        rows = zoom(recipes[0], given.zoom, given.finish)
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
