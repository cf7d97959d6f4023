#!/usr/bin/env python3
"""Prints the recipe of a body with much surface: 343 metaballs on a lattice, joined by necks, under fractal noise.

    sponge_recipe.py > sponge.json && synth sponge.json --resolution 4864 --predict -o sponge.ply
"""
import json
import random

SIDE = 7  # metaballs along each axis, 1 km apart


def main():
    random.seed(4)
    spheres = []
    for place in range(SIDE**3):
        center = (place // SIDE**2, place // SIDE % SIDE, place % SIDE)
        moved = [round(x + random.uniform(-0.06, 0.06), 3) for x in center]
        spheres.append([*moved, round(random.uniform(0.42, 0.46), 3)])
    noise = {"type": "simplex", "amplitude": 0.01, "frequency": 4, "octaves": 4}
    recipe = {"format_version": 1, "length_unit": "km", "seed": 5}
    print(json.dumps({**recipe, "body": {"type": "metaballs", "spheres": spheres}, "layers": [noise]}))


if __name__ == "__main__":
    main()
