#!/usr/bin/env python3
"""Compares what `synth --predict` says with what the mesh takes, for each of some recipes.

    tests/benchmarks/prediction_table.py build/release/bin/synth synthesis/examples/*.json --resolution 192

Both programs run with one thread. Seconds are those of the processor (user and system), which other programs on the
machine hardly change. Each row has predicted over used triangles, memory and seconds, and two shares of the mesh's
seconds: what the prediction itself takes, and the whole run with --predict, which also starts the program, reads the
recipe and places its landforms as a run that makes the mesh does. The last rows count the recipes that are predicted
within 20 %.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import tempfile

NEAR = 0.2
FIGURES = ("triangles", "memory", "seconds", "share", "whole run")


def run(synth, arguments, folder):
    """Returns the summary and the processor seconds of a run, or the program's words and None."""
    summary = folder / "summary.json"
    child = subprocess.Popen([synth, *map(str, arguments), "--summary", summary, "--quiet", "--threads", "1"],
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
    return (predicted["triangles"] / made["triangles"], predicted["peak_bytes"] / made["peak_bytes"],
            predicted["seconds"] / working, predicted["own_seconds"] / working, thinking / working, working)


def print_counts(rows):
    for column, name in enumerate(FIGURES):
        values = sorted(row[column] for row in rows)
        near = sum(abs(value - 1) <= NEAR for value in values)
        fitting = (f"below 5 %: {sum(value < 0.05 for value in values)}" if name in ("share", "whole run")
                   else f"within 20 %: {near}")
        print(f"{name:10s} median {statistics.median(values):.2f}, {values[0]:.2f} to {values[-1]:.2f}; "
              f"{fitting} of {len(values)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("synth", help="the program")
    parser.add_argument("recipes", nargs="+", type=pathlib.Path, help="recipes with a body")
    parser.add_argument("--resolution", default="192", help="cells along the longest side")
    parser.add_argument("--more", default="", help="further options of synth, such as --labels")
    options = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as name:
        for recipe in options.recipes:
            more = ["--resolution", options.resolution, *options.more.split()]
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
