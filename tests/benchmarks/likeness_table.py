#!/usr/bin/env python3
"""Judges bodies of a kind: fits each shape model, draws its relief for other places, and compares both surfaces.

    likeness_table.py build/release/bin eros.ply itokawa.ply [--spheres 80] [--seeds 1 2 3]     needs the Python package

Each seed gives an evened mesh of as many facets as the model, which `compare --realism` judges. The first table has the
largest distance, p and similarity of each seed, and their medians. A surface passes with p >= .05 and a largest distance
<= .13. The second table has medians of what stands beside the verdict: the rms of heights in bands and the coupling of
the bands, both over the model's, and the Kolmogorov-Smirnov distances of the skewness within 6 and 12 edges.
"""
import pathlib
import statistics
import sys
import tempfile

import astrolith

from measure import Run, arguments_of, head, row


def judged(programs, mesh, recipe, seed, facets, folder):
    like = folder / "like.ply"
    Run(programs / "synth", recipe, "--like", "--seed", seed, "--triangles", facets, "--even", "-o", like, "--quiet")
    return Run(programs / "compare", mesh, like, "--realism", "--json", "--quiet").json()


def beside(realism):
    """What stands beside the verdict, None where the body is too small for it."""
    bands = [band["ratio"] for band in realism["bands"]]
    skewness = {s["edges"]: s["distance"] for s in realism["statistics"] if s["statistic"] == "skewness"}
    return [*bands, *[None] * (4 - len(bands)), realism.get("coupling_ratio"), skewness.get(6), skewness.get(12)]


def medians(rows):
    return [None if None in values else statistics.median(values) for values in zip(*rows)]


def rows(programs, mesh, given, folder):
    recipe, facets = folder / f"{mesh.stem}.astro", len(astrolith.read_mesh(mesh).faces)
    Run(programs / "fit_shape", mesh, "-o", recipe, "--spheres", given.spheres, "--noise-seeds", 0, "--quiet")
    found = [judged(programs, mesh, recipe, seed, facets, folder) for seed in given.seeds]
    seeds = [(f["realism"]["largest_distance"], f["realism"]["p"], f["similarity"]) for f in found]
    passed = sum(f["realism"]["passes"] for f in found)
    cells = [" / ".join(f"{value:.3f}" for value in values) for values in [*seeds, medians(seeds)]]
    others = ["-" if value is None else f"{value:.2f}" for value in medians([beside(f["realism"]) for f in found])]
    return (mesh.stem, *cells, f"{passed} of {len(seeds)}"), (mesh.stem, *others)


if __name__ == "__main__":
    given = arguments_of(__doc__, "programs", "meshes", spheres=80, seeds={"type": int, "nargs": "+", "default": [1, 2, 3]})
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for mesh in given.meshes:
            found.append(rows(given.programs, mesh, given, pathlib.Path(folder)))
            print(*found[-1], sep="\n", file=sys.stderr, flush=True)
    heads = (["body", *(f"seed {seed}" for seed in given.seeds), "medians", "passes"],
             ["body", "0.8 to 1.6 edges", "1.6 to 3.2", "3.2 to 6.4", "6.4 to 12.8", "coupling", "skewness, 6 edges", "12 edges"])
    for heading, lines in zip(heads, zip(*found)):
        head(*heading)
        for line in lines:
            row(*line)
        print()
