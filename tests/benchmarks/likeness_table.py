#!/usr/bin/env python3
"""Judges bodies of a kind: fits each shape model, draws its relief for other places, and compares both surfaces.

    likeness_table.py build/release/bin eros.ply itokawa.ply [--spheres 80] [--seeds 1 2 3]

Each seed gives an evened mesh of as many facets as the model, which `compare --realism` judges. A row has the largest
distance, p and similarity of each seed, and their medians. A surface passes with p >= .05 and a largest distance <= .13.
"""
import argparse
import json
import re
import statistics
import subprocess
import tempfile
from pathlib import Path


def run(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def facets_of(mesh):
    """The facets that a .ply states, or that an .obj lists."""
    data = mesh.read_bytes()
    stated = re.search(rb"element face (\d+)", data[:4096])
    return int(stated[1]) if stated else len(re.findall(rb"^f ", data, re.MULTILINE))


def judged(programs, mesh, recipe, seed, facets, folder):
    like = folder / "like.ply"
    run(programs / "synth", recipe, "--like", "--seed", seed, "--triangles", facets, "--even", "-o", like, "--quiet")
    found = json.loads(run(programs / "compare", mesh, like, "--realism", "--quiet"))
    return found["realism"]["largest_distance"], found["realism"]["p"], found["similarity"]


def row(programs, mesh, arguments, folder):
    recipe = folder / f"{mesh.stem}.astro"
    run(programs / "fit_shape", mesh, "-o", recipe, "--spheres", arguments.spheres, "--noise-seeds", "0", "--quiet")
    facets = facets_of(mesh)
    seeds = [judged(programs, mesh, recipe, seed, facets, folder) for seed in arguments.seeds]
    passed = sum(distance <= 0.13 and p >= 0.05 for distance, p, _ in seeds)
    medians = [statistics.median(values) for values in zip(*seeds)]
    cells = [" / ".join(f"{value:.3f}" for value in values) for values in [*seeds, medians]]
    return f"| {mesh.stem} | " + " | ".join(cells) + f" | {passed} of {len(seeds)} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=Path)
    parser.add_argument("mesh", type=Path, nargs="+")
    parser.add_argument("--spheres", type=int, default=80)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    arguments = parser.parse_args()
    print("| body | " + " | ".join(f"seed {seed}" for seed in arguments.seeds) + " | medians | passes |")
    print("|---" * (len(arguments.seeds) + 3) + "|")
    with tempfile.TemporaryDirectory() as folder:
        for mesh in arguments.mesh:
            print(row(arguments.programs, mesh, arguments, Path(folder)), flush=True)


if __name__ == "__main__":
    main()
