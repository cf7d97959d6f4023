#!/usr/bin/env python3
"""What fits of large models take, on bodies made for it: a fitted asteroid with landforms and finer ground.

    large_models.py build/release/bin MODEL.ply [--facets 3145728 786432 196608] [--folder DIR]

The truth is the relief of MODEL with craters, boulders and two levels below the model, as an even mesh in a text file. A
row has processor seconds and peak memory of its fit, the mean distance over the base's, similarity, bytes of .astro for
each height, and the seconds and memory in which a mesh of 20,000 triangles and a patch of a hundredth of the body are made
of the fit, as measured and as another body of the kind. The exponent is that of the fit's seconds against facets. Bodies
that lie in DIR from an earlier run are used again.
"""
import json
import math
import pathlib
import tempfile

from measure import Run, arguments_of, head, row


def make_truth(programs, model, recipe):
    Run(programs / "fit_shape", model, "-o", recipe, "--noise-seeds", 0, "--quiet")
    document = json.loads(recipe.read_text())
    size = 2.0 * max(sphere[3] for sphere in document["body"]["spheres"])
    document["layers"] += [
        {"type": "craters", "population": {"count": 2000, "least_diameter": 0.004 * size, "greatest_diameter": 0.1 * size}},
        {"type": "boulders", "population": {"count": 4000, "least_diameter": 0.002 * size, "greatest_diameter": 0.03 * size}},
    ]
    recipe.write_text(json.dumps(document))


def made_of(programs, fit, size, *likeness):
    """Seconds and gigabytes of a mesh of a fit, and of a patch around one of its vertices."""
    mesh, patch = fit.with_suffix(".obj"), fit.with_suffix(".ply")
    whole = Run(programs / "synth", fit, "-o", mesh, "--quiet", "--triangles", 20000, *likeness)
    with mesh.open() as lines:
        vertex = next(line for line in lines if line.startswith("v ")).split()[1:4]
    cut = Run(programs / "synth", fit, "-o", patch, "--quiet", "--patch", *vertex, size, "--resolution", 200, *likeness)
    return [f"{run.seconds:.1f}, {run.bytes / 1e9:.2f}" for run in (whole, cut)]


def fitted(programs, body, folder):
    """The seconds of a fit, and its row."""
    fit, summary = folder / "fit.astro", folder / "fit.json"
    run = Run(programs / "fit_shape", body, "-o", fit, "--noise-seeds", 0, "--quiet", "--summary", summary)
    figures = json.loads(summary.read_text())
    heights = figures["relief"]["heights"]
    return run.seconds, [
        f"{run.seconds:.0f}",
        f"{run.bytes / 1e9:.2f}",
        f"{figures['mean_distance'] / figures['base']['mean_distance']:.3f}",
        f"{figures['similarity']:.3f} / {figures['similarity_floor']:.3f}",
        heights,
        f"{fit.stat().st_size / heights:.3f}",
        *made_of(programs, fit, 0.01 * figures["diagonal"]),
        *made_of(programs, fit, 0.01 * figures["diagonal"], "--like"),
    ]


def main():
    arguments = arguments_of(__doc__, "programs", "model", folder={"type": pathlib.Path},
                             facets={"type": int, "nargs": "+", "default": [3145728, 786432, 196608]})  # fmt: skip
    programs = arguments.programs
    with tempfile.TemporaryDirectory() as name:
        folder = arguments.folder or pathlib.Path(name)
        folder.mkdir(parents=True, exist_ok=True)
        recipe = folder / "truth.json"
        if not recipe.exists():
            make_truth(programs, arguments.model, recipe)
        head("facets", "fit, s", "GB", "over the base", "similarity / floor", "heights", "bytes each",
             "mesh, s, GB", "patch", "like", "its patch")  # fmt: skip
        took = []
        for facets in sorted(arguments.facets):
            body = folder / f"truth_{facets}.obj"
            if not body.exists():
                Run(programs / "synth", recipe, "-o", body, "--finer", 2, "--triangles", facets, "--even", "--quiet")
            seconds, cells = fitted(programs, body, folder)
            took.append((facets, seconds))
            row(facets, *cells)
        if len(took) > 1:
            (few, least), (many, most) = took[0], took[-1]
            print(f"exponent {math.log(most / least) / math.log(many / few):.2f}")


if __name__ == "__main__":
    main()
