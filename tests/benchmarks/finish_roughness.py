#!/usr/bin/env python3
"""Measures what a finish adds to ground that a relief has measured, at the scale of the relief's heights.

    finish_roughness.py synth recipe.json ... [--body itokawa] [--patches 24]      needs NumPy and Pillow

Each patch is 8 distances of the relief's heights wide, with 12 pixels to a distance, and boulders down to half a distance.
Heights are means over a distance, less their mean plane. Rows: their root mean square over all patches without and
with the finish, and the ratio on the quarter of the patches that are smoothest, and on the roughest.
"""
import json
import subprocess
import tempfile
from pathlib import Path

import numpy
from PIL import Image

from measure import arguments_of, head, row

WIDE = 8  # distances


def mean_heights(file):
    heights = numpy.array(Image.open(file), float)
    heights[~(numpy.abs(heights) < 1e6)] = numpy.nan
    side = heights.shape[0] // WIDE * WIDE
    cell = side // WIDE
    means = heights[:side, :side].reshape(WIDE, cell, WIDE, cell).mean((1, 3))
    y, x = numpy.mgrid[:WIDE, :WIDE]
    design = numpy.stack([numpy.ones(WIDE * WIDE), x.ravel(), y.ravel()], 1)
    good = numpy.isfinite(means.ravel())
    plane = numpy.linalg.lstsq(design[good], means.ravel()[good], rcond=None)[0]
    return means - (design @ plane).reshape(means.shape)


def main():
    given = arguments_of(__doc__, "synth", "recipes", body="itokawa", patches=24, seed=1)
    head("recipe", "rms without", "rms with", "ratio", "smoothest quarter", "roughest quarter")
    for recipe in given.recipes:
        row(Path(recipe).stem, *measured(given, recipe))


def measured(given, recipe):
    def run(*options):
        subprocess.run([given.synth, recipe, "--quiet", *map(str, options)], check=True)

    bare, finished = [], []
    with tempfile.TemporaryDirectory() as folder:
        mesh, summary, tif = (Path(folder) / name for name in ("a.obj", "a.json", "a.tif"))
        run("-o", mesh, "--resolution", 48, "--finish", given.body, "--to", 1e-6, "--summary", summary)
        distance = json.loads(summary.read_text())["finish"]["from"]
        places = numpy.array([line.split()[1:4] for line in mesh.read_text().splitlines() if line.startswith("v ")], float)
        for place in places[numpy.random.default_rng(given.seed).choice(len(places), given.patches, replace=False)]:
            patch = ["-o", mesh, "--patch", *place, WIDE * distance, "--aligned", "--resolution", 12 * WIDE, "--height-map", tif]
            run(*patch)
            bare.append(mean_heights(tif))
            run(*patch, "--finish", given.body, "--to", 0.5 * distance)
            finished.append(mean_heights(tif))

    def rms(maps):
        return numpy.sqrt(numpy.nanmean(numpy.square(maps)))

    order = numpy.argsort([rms(heights) for heights in bare])
    parts = [order, order[: len(order) // 4], order[-(len(order) // 4) :]]
    ratios = [rms([finished[i] for i in part]) / rms([bare[i] for i in part]) for part in parts]
    return *(f"{rms(maps):.4g} m" for maps in (bare, finished)), *(f"{ratio:.3f}" for ratio in ratios)


if __name__ == "__main__":
    main()
