#!/usr/bin/env python3
"""What fits of large models take, on bodies made for it: a fitted asteroid with landforms and finer ground.

    large_models.py build/release/bin MODEL.ply [--facets 3145728 786432 196608] [--folder DIR]

The truth is the relief of MODEL over 80 metaballs with craters, boulders and two levels below the model, as an even
mesh in a text file. A row has processor seconds and peak memory of its fit with relief, the mean distance over the
base's, similarity, bytes of .astro for each height, and the seconds and memory in which a mesh of 20,000 triangles is
made of the fit, as measured and as another body of the kind. The exponent is that of the fit's seconds against
facets. Bodies that lie in DIR from an earlier run are used again.
"""
import argparse
import json
import math
import os
import subprocess
import tempfile
from pathlib import Path


def run(*command):
    """The processor seconds and the peak gigabytes of a program."""
    program = subprocess.Popen([str(word) for word in command])
    _, status, used = os.wait4(program.pid, 0)
    if status != 0:
        raise SystemExit(f"{' '.join(map(str, command))}: failed")
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1e6


def make_truth(programs, model, recipe):
    run(programs / "fit_shape", model, "-o", recipe, "--spheres", 80, "--noise-seeds", 0, "--quiet")
    document = json.loads(recipe.read_text())
    size = 2.0 * max(sphere[3] for sphere in document["body"]["spheres"])
    document["layers"] += [
        {"type": "craters", "population": {"count": 2000, "least_diameter": 0.004 * size, "greatest_diameter": 0.1 * size}},
        {"type": "boulders", "population": {"count": 4000, "least_diameter": 0.002 * size, "greatest_diameter": 0.03 * size}},
    ]
    recipe.write_text(json.dumps(document))


def row(programs, body, folder):
    fit = folder / "fit.astro"
    summary = folder / "fit.json"
    seconds, memory = run(programs / "fit_shape", body, "-o", fit, "--spheres", 80, "--noise-seeds", 0, "--quiet",
                          "--summary", summary)  # fmt: skip
    figures = json.loads(summary.read_text())
    mesh = [programs / "synth", fit, "-o", folder / "mesh.ply", "--triangles", 20000, "--quiet"]
    measured, like = run(*mesh), run(*mesh, "--like")
    heights = figures["relief"]["heights"]
    return seconds, [
        f"{seconds:.0f}",
        f"{memory:.2f}",
        f"{figures['mean_distance'] / figures['base']['mean_distance']:.3f}",
        f"{figures['similarity']:.3f} / {figures['similarity_floor']:.3f}",
        f"{heights}",
        f"{fit.stat().st_size / heights:.3f}",
        f"{measured[0]:.1f}, {measured[1]:.2f}",
        f"{like[0]:.1f}, {like[1]:.2f}",
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=Path)
    parser.add_argument("model", type=Path)
    parser.add_argument("--facets", type=int, nargs="+", default=[3145728, 786432, 196608])
    parser.add_argument("--folder", type=Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = arguments.folder or Path(name)
        folder.mkdir(parents=True, exist_ok=True)
        recipe = folder / "truth.json"
        if not recipe.exists():
            make_truth(arguments.programs, arguments.model, recipe)
        print("| facets | fit, s | GB | over the base | similarity / floor | heights | bytes each | measured, s, GB | like, s, GB |")
        print("|---" * 9 + "|")
        took = []
        for facets in sorted(arguments.facets):
            body = folder / f"truth_{facets}.obj"
            if not body.exists():
                run(arguments.programs / "synth", recipe, "-o", body, "--finer", 2, "--triangles", facets, "--even", "--quiet")
            seconds, cells = row(arguments.programs, body, folder)
            took.append((facets, seconds))
            print(f"| {facets} | " + " | ".join(cells) + " |", flush=True)
        if len(took) > 1:
            (few, least), (many, most) = took[0], took[-1]
            print(f"exponent {math.log(most / least) / math.log(many / few):.2f}")


if __name__ == "__main__":
    main()
