#!/usr/bin/env python3
"""Judges bodies of a kind: fits each shape model, draws its relief for other places, and compares both surfaces.

    likeness_table.py build/release/bin eros.ply itokawa.ply [--spheres 80] [--seeds 1 2 3]

Each seed gives an evened mesh of as many facets as the model, which `compare --realism` judges. The first table has the
largest distance, p and similarity of each seed, and their medians. A surface passes with p >= .05 and a largest distance
<= .13. The second table has medians of what stands beside the verdict: the rms of heights in bands and the coupling of
the bands, both over the model's, and the Kolmogorov-Smirnov distances of the skewness within 6 and 12 edges.
"""
import argparse
import json
import re
import statistics
import subprocess
import sys
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
    return json.loads(run(programs / "compare", mesh, like, "--realism", "--json", "--quiet"))


def skewness(realism, edges):
    return next((s["distance"] for s in realism["statistics"] if s["statistic"] == "skewness" and s["edges"] == edges), None)


def beside(found):
    """What stands beside the verdict, None where the body is too small for it."""
    realism = found["realism"]
    bands = [band["ratio"] for band in realism["bands"]]
    return [*bands, *[None] * (4 - len(bands)), realism.get("coupling_ratio"), skewness(realism, 6), skewness(realism, 12)]


def medians(rows):
    return [None if None in values else statistics.median(values) for values in zip(*rows)]


def rows(programs, mesh, arguments, folder):
    recipe = folder / f"{mesh.stem}.astro"
    run(programs / "fit_shape", mesh, "-o", recipe, "--spheres", arguments.spheres, "--noise-seeds", "0", "--quiet")
    facets = facets_of(mesh)
    found = [judged(programs, mesh, recipe, seed, facets, folder) for seed in arguments.seeds]
    seeds = [(f["realism"]["largest_distance"], f["realism"]["p"], f["similarity"]) for f in found]
    passed = sum(f["realism"]["passes"] for f in found)
    cells = [" / ".join(f"{value:.3f}" for value in values) for values in [*seeds, medians(seeds)]]
    others = ["-" if value is None else f"{value:.2f}" for value in medians([beside(f) for f in found])]
    return (f"| {mesh.stem} | " + " | ".join(cells) + f" | {passed} of {len(seeds)} |",
            f"| {mesh.stem} | " + " | ".join(others) + " |")  # fmt: skip


def table(heads, lines):
    return "\n".join(["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|", *lines])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=Path)
    parser.add_argument("mesh", type=Path, nargs="+")
    parser.add_argument("--spheres", type=int, default=80)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    arguments = parser.parse_args()
    verdicts, others = [], []
    with tempfile.TemporaryDirectory() as folder:
        for mesh in arguments.mesh:
            verdict, other = rows(arguments.programs, mesh, arguments, Path(folder))
            print(verdict, other, sep="\n", file=sys.stderr, flush=True)
            verdicts.append(verdict)
            others.append(other)
    print(table(["body", *[f"seed {seed}" for seed in arguments.seeds], "medians", "passes"], verdicts))
    print()
    bands = ["0.8 to 1.6 edges", "1.6 to 3.2", "3.2 to 6.4", "6.4 to 12.8"]
    print(table(["body", *bands, "coupling", "skewness, 6 edges", "12 edges"], others))


if __name__ == "__main__":
    main()
