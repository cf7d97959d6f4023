#!/usr/bin/env python3
"""Counts the parts and the handles of fits with relief, of bodies of their kinds and of variations, beside the target's.

    relief_topology.py build/release/bin eros.ply itokawa.ply [--spheres 80 200] [--seeds 1 2 3]

Cells are parts / handles; those that are not the target's have a star. The mesh of a fit is that of its own check, those
of --like and --vary have 256 cells. Distances are fractions of the diagonal in %, of the fit and of its metaballs alone.
"""
import json
import pathlib
import tempfile

from measure import Run, arguments_of, head, row


def read(file):
    return json.loads(file.read_text())


def topology(figures):
    return figures["components"], figures["genus"]


def of_kind(programs, recipe, folder, *options):
    """The topology of another body of the kind."""
    summary = folder / "kind.json"
    Run(programs / "synth", recipe, *options, "--resolution", 256, "-o", folder / "kind.ply", "--summary", summary, "--quiet")
    return topology(read(summary))


def fitted(programs, mesh, spheres, seed, folder):
    """The cells of a row: topologies, distances, heights that were halved."""
    recipe, summary = folder / "fit.astro", folder / "fit.json"
    Run(programs / "fit_shape", mesh, "-o", recipe, "--all-parts", "--spheres", spheres, "--seed", seed,
        "--noise-seeds", 0, "--summary", summary, "--quiet")  # fmt: skip
    fit = read(summary)
    target = fit["target_components"], fit["target_genus"]
    kinds = [of_kind(programs, recipe, folder, *options, "--seed", seed) for options in (["--like"], ["--vary", 0.2])]
    cells = [f"{parts} / {handles}" + ("" if (parts, handles) == target else " *")
             for parts, handles in (target, topology(fit), *kinds)]  # fmt: skip
    distances = [f"{100 * of['mean_distance']:.4f} / {100 * of['max_distance']:.2f}" for of in (fit, fit["base"])]
    return cells + distances + [fit["relief"]["halved_heights"]]


if __name__ == "__main__":
    numbers = {"type": int, "nargs": "+"}
    given = arguments_of(__doc__, "programs", "meshes", spheres={**numbers, "default": [80, 200]},
                         seeds={**numbers, "default": [1, 2, 3]})  # fmt: skip
    head("body", "metaballs", "seed", "target", "fit", "like", "varied", "mean / largest", "of the metaballs", "halved")
    with tempfile.TemporaryDirectory() as folder:
        for mesh in given.meshes:
            for spheres in given.spheres:
                for seed in given.seeds:
                    row(mesh.stem, spheres, seed, *fitted(given.programs, mesh, spheres, seed, pathlib.Path(folder)))
