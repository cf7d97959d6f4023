#!/usr/bin/env python3
"""Recipes of bodies for which the speed of synthesis is stated.

    recipes.py > sponge.json && synth sponge.json --resolution 4864 --predict -o sponge.ply     # the body with much surface
"""
import json
import math
import random


def asteroid(bare):
    """An asteroid of 500 metaballs, length 1: hills alone over the body, or hills, plates, craters and the main bands of gravel."""
    draw = random.Random(3)
    spheres = []
    for i in range(500):
        radius = 0.28 * (1 - 0.85 * (i + 1) / 500) ** 1.5 + 0.02
        direction = [draw.gauss(0, 1) for _ in range(3)]
        reach = draw.random() ** 0.4 / math.hypot(*direction)
        spheres.append([*(reach * (half - radius) * x for half, x in zip((0.55, 0.36, 0.33), direction)), radius])
    hills = {"type": "simplex", "amplitude": 0.02, "frequency": 3, "octaves": 5}
    plates = {"type": "worley", "amplitude": 0.006, "frequency": 9}
    craters = {"type": "spots", "amplitude": 0.01, "size": 0.03, "cell_size": 0.12, "kappa": -0.4, "layers": 3}
    # A pixel is about as wide as a cell of the mesh of a million triangles. The lobes are the strongest ones that a fit of
    # gravel found in each band.
    gravel = {"type": "gabor", "pixel_size": 0.003, "height_rms": 0.001,
              "lobes": [[2, -0.0487, 0.0490, 0.0040], [2, 0.0489, 0.0489, 0.0016], [2, 0.2932, 0.0488, 0.0002], [3, 0, 0, 0.0048],
                        [3, -0.0253, 0.0255, 0.0031], [4, -0.0137, 0.0278, 0.0032], [4, 0.0276, 0.0001, 0.0012]]}  # fmt: skip
    return {"format_version": 1, "length_unit": "km", "body": {"type": "metaballs", "blend_exponent": 3, "spheres": spheres},
            "layers": [hills] if bare else [hills, plates, craters, gravel]}


def sponge(side=7):
    """A body with much surface: metaballs on a lattice of 1 km, joined by necks, under fractal noise."""
    draw = random.Random(4)
    spheres = []
    for i in range(side**3):
        center = (i // side**2, i // side % side, i % side)
        moved = [round(x + draw.uniform(-0.06, 0.06), 3) for x in center]
        spheres.append([*moved, round(draw.uniform(0.42, 0.46), 3)])
    noise = {"type": "simplex", "amplitude": 0.01, "frequency": 4, "octaves": 4}
    return {"format_version": 1, "length_unit": "km", "seed": 5, "body": {"type": "metaballs", "spheres": spheres}, "layers": [noise]}


if __name__ == "__main__":
    print(json.dumps(sponge()))
