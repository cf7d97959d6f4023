#!/usr/bin/env python3
"""Compares what `synth --predict` says with what the mesh takes, for each of some recipes.

    tests/benchmarks/prediction_table.py build/release/bin/synth synthesis/examples/*.json --resolution 192
    tests/benchmarks/prediction_table.py build/release/bin/synth --random 1:100 --resolution 128 --threads 2

Seconds are those of the processor (user and system), which other programs on the machine change less than the clock.
Each row has predicted over used triangles, memory and seconds, and two shares of the mesh's seconds: what the
prediction itself takes, and the whole run with --predict, which also starts the program, reads the recipe and places
its landforms as a run that makes the mesh does. `--random A:B` adds the recipes A to B of recipe_draw.py. The last rows
have quantiles, and count the recipes that are predicted within 30 %.
"""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile

import recipe_draw

NEAR = 0.3
QUANTILES = (0, 0.05, 0.25, 0.5, 0.75, 0.95, 1)
FIGURES = ("triangles", "memory", "seconds", "share", "whole run")


def run(synth, arguments, folder):
    """Returns the summary and the processor seconds of a run, or the program's words and None."""
    summary = folder / "summary.json"
    child = subprocess.Popen([synth, *map(str, arguments), "--summary", summary, "--quiet"],
                             stderr=subprocess.PIPE, text=True)
    words = child.stderr.read()
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        return words.strip(), None
    return json.loads(summary.read_text()), usage.ru_utime + usage.ru_stime


def row_of(synth, recipe, more, folder):
    """The ratios of one recipe and the seconds of its mesh; a refusal's words instead of them."""
    common = [recipe, "-o", folder / "mesh.ply", *more]
    prediction, thinking = run(synth, [*common, "--predict"], folder)
    if thinking is None:
        return prediction
    made, working = run(synth, common, folder)
    if working is None:
        return made
    predicted = prediction["predicted"]
    seconds = predicted.get("processor_seconds", predicted["seconds"])
    return (predicted["triangles"] / made["triangles"], predicted["peak_bytes"] / made["peak_bytes"],
            seconds / working, predicted["own_seconds"] / working, thinking / working, working)


def print_counts(rows):
    for column, name in enumerate(FIGURES):
        values = sorted(row[column] for row in rows)
        near = sum(1 - NEAR <= value <= 1 + NEAR for value in values)
        quantiles = " ".join(f"{values[min(int(share * len(values)), len(values) - 1)]:.2f}" for share in QUANTILES)
        fitting = (f"below 5 %: {sum(value < 0.05 for value in values)}" if name in ("share", "whole run")
                   else f"within 30 %: {near}")
        print(f"{name:10s} least, 5, 25, 50, 75, 95 %, most: {quantiles}; {fitting} of {len(values)}")


def random_recipes(numbers, folder):
    """Writes random recipes, and returns their files."""
    first, last = (int(number) for number in numbers.split(":"))
    files = [folder / f"random_{number}.json" for number in range(first, last + 1)]
    for number, file in zip(range(first, last + 1), files):
        file.write_text(json.dumps(recipe_draw.recipe(number)[0]))
    return files


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("synth", help="the program")
    parser.add_argument("recipes", nargs="*", type=pathlib.Path, help="recipes with a body")
    parser.add_argument("--random", metavar="A:B", help="also the random recipes A to B")
    parser.add_argument("--threads", default="1", help="threads of both programs")
    parser.add_argument("--resolution", default="192", help="cells along the longest side")
    parser.add_argument("--more", default="", help="further options of synth, such as --labels")
    options = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as name:
        more = ["--resolution", options.resolution, "--threads", options.threads, *options.more.split()]
        drawn = random_recipes(options.random, pathlib.Path(name)) if options.random else []
        for recipe in options.recipes + drawn:
            row = row_of(options.synth, recipe, more, pathlib.Path(name))
            if isinstance(row, str):
                print(f"{recipe.stem:28s} {row[:90]}", flush=True)
                continue
            rows.append(row)
            print("{:28s} triangles {:.2f} memory {:.2f} seconds {:.2f} share {:.3f} whole run {:.3f} of {:.2f} s".format(
                recipe.stem, *row), flush=True)
    if rows:
        print_counts(rows)


if __name__ == "__main__":
    main()
