#!/usr/bin/env python3
"""Measures how a relief goes on below the edges of its model (`finer` of the layer), on patches of a fitted body.

    finer_roughness.py recipe.astro --edge EDGE [--patches 6]      needs the Python package of the build on PYTHONPATH, and NumPy

EDGE is the mean edge of the model in the recipe's unit. S(l) is the root mean square of second differences of the
heights over the bare body at the lag l, on patches 30 edges wide. Rows: S at 1/16 to 4 edges over the
straight line through 1 and 4 edges, without and with levels, and the difference that remains in means over an edge.
"""
import astrolith
import numpy

from measure import arguments_of, head, row

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
    given = arguments_of(__doc__, "recipe", edge={"type": float, "required": True}, patches=6)
    recipe = astrolith.Recipe.read(given.recipe)
    pixels_per_edge = PIXELS / WIDE
    vertices = astrolith.mesh(recipe, resolution=40).vertices.astype(float)
    differences = {finer: {lag: [] for lag in LAGS} for finer in range(4)}
    left = {finer: [] for finer in range(1, 4)}
    for centre in vertices[numpy.random.default_rng(1).choice(len(vertices), given.patches, replace=False)]:
        maps = [height_map(recipe, finer, [*centre, WIDE * given.edge]) for finer in range(4)]
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
    head("levels", "H", *(f"{lag:g}" for lag in LAGS), "means over an edge, rms, edges")
    for finer in range(4):
        s = [numpy.sqrt(numpy.mean(numpy.concatenate(differences[finer][lag]) ** 2)) for lag in LAGS]
        if finer == 0:
            exponent, at_edge = numpy.log(s[5] / s[4]) / numpy.log(4), s[4]
        rest = numpy.sqrt(numpy.mean(numpy.concatenate(left[finer]) ** 2)) / given.edge if finer else 0.0
        row(finer, f"{exponent:.2f}", *(f"{x / (at_edge * lag**exponent):.2f}" for x, lag in zip(s, LAGS)), f"{rest:.4f}")


if __name__ == "__main__":
    main()
