#!/usr/bin/env python3
"""Measures how a relief goes on below the edges of its model (`finer` of the layer), on patches of a fitted body.

    finer_roughness.py recipe.astro EDGE [--patches 6]      needs the Python package of the build on PYTHONPATH, and NumPy

EDGE is the mean edge of the model in the recipe's unit. S(l) is the root mean square of second differences of the
heights over the bare body at the lag l, on patches 30 edges wide. Rows: S at 1/16 to 4 edges over the
straight line through 1 and 4 edges, without and with levels, and the difference that remains in means over an edge.
"""
import argparse

import astrolith
import numpy

PIXELS = 480
WIDE = 30  # edges
LAGS = [1 / 16, 1 / 8, 1 / 4, 1 / 2, 1, 4]


def height_map(recipe, finer, patch):
    """The heights of all layers on a grid of the plane that fits the patch best."""
    recipe = recipe.copy()
    for layer in recipe.layers:
        if layer["type"] == "relief":
            layer["finer"] = finer
    mesh = astrolith.mesh(recipe, patch=patch, resolution=PIXELS, labels=True)
    points = mesh.vertices.astype(float)
    right, ahead, _ = numpy.linalg.svd(points - points.mean(0), full_matrices=False)[2]
    across = numpy.stack([points @ right, points @ ahead], 1)
    half, side = 0.35 * patch[3], round(0.7 * PIXELS)
    pixel = numpy.floor((across / half + 1.0) * 0.5 * side).astype(int)
    inside = ((pixel >= 0) & (pixel < side)).all(1)
    number = pixel[inside] @ [1, side]
    sums = numpy.bincount(number, mesh.elevations[inside].astype(float), side * side)
    counts = numpy.bincount(number, None, side * side)
    return numpy.where(counts > 0, sums / numpy.maximum(counts, 1), numpy.nan).reshape(side, side)


def second_differences(heights, lag):
    found = []
    for rows in (heights, heights.T):
        change = rows[2 * lag:] - 2 * rows[lag:-lag] + rows[:-2 * lag]
        found.append(change[numpy.isfinite(change)])
    return numpy.concatenate(found)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipe", type=astrolith.Recipe.read)
    parser.add_argument("edge", type=float)
    parser.add_argument("--patches", type=int, default=6)
    arguments = parser.parse_args()
    pixels_per_edge = PIXELS / WIDE
    vertices = astrolith.mesh(arguments.recipe, resolution=40).vertices.astype(float)
    differences = {finer: {lag: [] for lag in LAGS} for finer in range(4)}
    left = {finer: [] for finer in range(1, 4)}
    for centre in vertices[numpy.random.default_rng(1).choice(len(vertices), arguments.patches, replace=False)]:
        maps = [height_map(arguments.recipe, finer, [*centre, WIDE * arguments.edge]) for finer in range(4)]
        for finer, heights in enumerate(maps):
            for lag in LAGS:
                differences[finer][lag].append(second_differences(heights, round(lag * pixels_per_edge)))
            if finer == 0:
                continue
            cell = round(pixels_per_edge)
            count = heights.shape[0] // cell
            cells = (heights - maps[0])[:count * cell, :count * cell].reshape(count, cell, count, cell)
            means = numpy.nanmean(cells, (1, 3))
            left[finer].append(means[numpy.isfinite(means)])
    print("| levels | H | " + " | ".join(f"{lag:g}" for lag in LAGS) + " | means over an edge, rms, edges |")
    print("|---" * (len(LAGS) + 3) + "|")
    for finer in range(4):
        s = [numpy.sqrt(numpy.mean(numpy.concatenate(differences[finer][lag]) ** 2)) for lag in LAGS]
        if finer == 0:
            exponent = numpy.log(s[5] / s[4]) / numpy.log(4)
            at_edge = s[4]
        line = [at_edge * lag ** exponent for lag in LAGS]
        rest = ""
        if finer:
            rest = f"{numpy.sqrt(numpy.mean(numpy.concatenate(left[finer]) ** 2)) / arguments.edge:.4f}"
        print(f"| {finer} | {exponent:.2f} | " + " | ".join(f"{x / y:.2f}" for x, y in zip(s, line)) + f" | {rest} |")


if __name__ == "__main__":
    main()
