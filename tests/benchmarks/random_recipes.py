#!/usr/bin/env python3
"""Draws random valid recipes, makes their meshes with `synth` and checks what must hold for each of them.

    tests/benchmarks/random_recipes.py build/release/bin/synth --count 500 --first 1 --keep failed

Each mesh is made with one and with two threads, and predicted. What is checked:
  - the mesh is a closed 2-manifold and has the same bytes for both numbers of threads, or
  - the program refuses the recipe: exit status 2 and one line;
  - the mesh takes at most 1.2 times the predicted memory and at most 60 seconds.
The script prints a table of failures by kind, and keeps their recipes in the folder of --keep. Its exit status is 1 if
there are any. With --compact it only turns the recipes into compact ones and back, which must change nothing; that needs the
Python package of the build on PYTHONPATH.
"""
import collections
import hashlib
import json
import pathlib
import struct
import sys
import tempfile

import recipe_draw
from measure import Run, arguments_of

MOST_SECONDS = 60  # of the processors, for each thread; other programs may run beside this one
MOST_OF_PREDICTED_MEMORY = 1.2


# The next two functions share no code with synth.
def triangles_of(ply):
    """The vertex numbers of all triangles of a binary PLY file of synth, and the number of vertices."""
    data = ply.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode("ascii", "replace").splitlines()
    counts = {line.split()[1]: int(line.split()[2]) for line in header if line.startswith("element ")}
    first = end + 4 * sum(line.startswith("property float") for line in header) * counts["vertex"]
    faces = struct.iter_unpack("<BIII", data[first:first + 13 * counts["face"]])
    return [face[1:] for face in faces], counts["vertex"]


def defect_of(ply):
    """Why a mesh is no closed 2-manifold; empty if it is one."""
    triangles, vertices = triangles_of(ply)
    after = {}  # (vertex, next vertex) -> the third vertex of their triangle
    for a, b, c in triangles:
        after.update({(a, b): c, (b, c): a, (c, a): b})
    if not triangles or len(after) != 3 * len(triangles):
        return "no triangle, or an edge with two triangles on one side"
    if any(a == b or (b, a) not in after for a, b in after):
        return "a triangle without area, or an open edge"
    around = collections.Counter(a for a, _ in after)
    for vertex, first in dict(after.keys()).items():  # the triangles around a vertex form one cycle
        at, steps = first, 0
        while steps == 0 or (at != first and steps < around[vertex]):
            at, steps = after[vertex, at], steps + 1
        if steps != around[vertex]:
            return "a vertex with several fans"
    return "" if len(around) == vertices else "a vertex without triangle"


def run_of(synth, arguments, folder, threads):
    """A run, and its summary; it is stopped at three times the most seconds."""
    summary = folder / "summary.json"
    summary.unlink(missing_ok=True)
    run = Run(synth, *arguments, "--summary", summary, check=False, most_seconds=3 * MOST_SECONDS * threads)
    return run, json.loads(summary.read_text()) if run.status == 0 else {}


def kind_of_words(run):
    """The message without its numbers and names, so that equal failures fall together."""
    line = ["no words", *run.errors.strip().splitlines()][-1].split(".json: ")[-1]
    return "".join("N" if c.isdigit() else c for c in line)[:90]


def failures_of_run(run, summary, predicted, threads):
    if run.seconds > MOST_SECONDS * threads:
        yield f"above {MOST_SECONDS} s"
    elif run.status == 0 and summary["peak_bytes"] > MOST_OF_PREDICTED_MEMORY * predicted.get("peak_bytes", float("inf")):
        yield "memory above 1.2 times the prediction"
    elif run.status not in (0, 2) or (run.status == 2 and len(run.errors.strip().splitlines()) != 1):
        yield f"exit {run.status}: {kind_of_words(run)}"


def check(synth, number, folder):
    """Makes, predicts and checks one recipe. Returns its failures, whether it was refused, and its file."""
    content, cells = recipe_draw.recipe(number)
    file, mesh = folder / f"{number}.json", folder / f"{number}.ply"
    file.write_text(json.dumps(content, indent=1))
    failures, hashes = set(), set()
    for threads in (1, 2):
        common = [file, "-o", mesh, "--resolution", cells, "--threads", threads, "--quiet"]
        prediction, told = run_of(synth, [*common, "--predict"], folder, threads)
        run, summary = run_of(synth, common, folder, threads)
        failures.update(failures_of_run(run, summary, told.get("predicted", {}), threads))
        if prediction.seconds > MOST_SECONDS * threads:
            failures.add("prediction above 60 s")
        if run.status == 0 and prediction.status != 0:
            failures.add(f"prediction alone refuses: {kind_of_words(prediction)}")
        hashes.add((run.status, hashlib.sha256(mesh.read_bytes()).hexdigest() if run.status == 0 else ""))
        if run.status == 0 and threads == 2 and (defect := defect_of(mesh)):
            failures.add(f"no closed 2-manifold: {defect}")
        mesh.unlink(missing_ok=True)
    if len(hashes) > 1:
        failures.add("different bytes for 1 and 2 threads")
    return sorted(failures), run.status == 2, file


def check_compact(numbers, folder):
    """Prints the sizes of both forms, and the recipes that do not come back equal. Returns the exit status."""
    import astrolith

    sizes, refused, file = [], 0, folder / "recipe.astro"
    for number in numbers:
        try:
            recipe = astrolith.Recipe.from_dict(recipe_draw.recipe(number)[0])
        except ValueError:
            refused += 1
            continue
        recipe.write(file)
        sizes.append((len(recipe.to_json()), file.stat().st_size))
        if astrolith.Recipe.read(file).to_json() != recipe.to_json():
            print(f"recipe {number}: comes back changed")
            return 1
    print(f"{len(sizes)} recipes read, {refused} refused, all equal; mean bytes of JSON and compact: "
          f"{[sum(column) // len(sizes) for column in zip(*sizes)]}")
    return 0


def main():
    given = arguments_of(__doc__, "synth", count=50, first=1, keep={"type": pathlib.Path}, compact={"action": "store_true"})
    numbers = range(given.first, given.first + given.count)
    kinds, refusals = collections.defaultdict(list), 0
    with tempfile.TemporaryDirectory() as name:
        if given.compact:
            return check_compact(numbers, pathlib.Path(name))
        for number in numbers:
            failures, refused, file = check(given.synth, number, pathlib.Path(name))
            refusals += refused
            for failure in failures:
                kinds[failure].append(number)
                print(f"recipe {number}: {failure}", flush=True)
                if given.keep:
                    given.keep.mkdir(parents=True, exist_ok=True)
                    (given.keep / f"{number}.json").write_bytes(file.read_bytes())
            file.unlink()
    print(f"\n{given.count} recipes, {refusals} refused in one line, {sum(map(len, kinds.values()))} failures")
    for kind, failed in sorted(kinds.items(), key=lambda item: -len(item[1])):
        print(f"{len(failed):5d}  {kind}  (recipes {', '.join(map(str, failed[:8]))})")
    return 1 if kinds else 0


if __name__ == "__main__":
    sys.exit(main())
