#!/usr/bin/env python3
"""Draws random valid recipes, makes their meshes with `synth` and checks what must hold for each of them.

    tests/benchmarks/random_recipes.py build/release/bin/synth --count 500 --first 1 --keep failed

Each mesh is made with one and with two threads, and predicted. What is checked:
  - the mesh is a closed 2-manifold and has the same bytes for both numbers of threads, or
  - the program refuses the recipe: exit status 2 and one line;
  - the mesh takes at most 1.2 times the predicted memory and at most 60 seconds.
The program prints a table of failures by kind. Its exit status is 1 if there are any. With --compact it only turns the
recipes into compact ones and back, which must change nothing; that needs the Python package of the build on PYTHONPATH.
"""
import argparse
import collections
import hashlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time

import closed_mesh
import recipe_draw

MOST_SECONDS = 60.0  # of the processors, for each thread; other programs may run beside this one
MOST_WAITED_SECONDS = 3 * MOST_SECONDS
MOST_OF_PREDICTED_MEMORY = 1.2

Run = collections.namedtuple("Run", "status words processor bytes summary")


def run(synth, arguments, folder):
    """Runs the program under a time limit. `status` is None for a program that was stopped."""
    summary = folder / "summary.json"
    summary.unlink(missing_ok=True)
    with open(folder / "words", "w+b") as words:
        start = time.monotonic()
        child = subprocess.Popen([synth, *map(str, arguments), "--summary", summary], stdout=words, stderr=words)
        late = threading.Timer(MOST_WAITED_SECONDS, lambda: os.kill(child.pid, signal.SIGKILL))
        late.start()
        _, status, usage = os.wait4(child.pid, 0)
        late.cancel()
        seconds = time.monotonic() - start
        child.returncode = os.waitstatus_to_exitcode(status)
        words.seek(0)
        text = words.read().decode("utf-8", "replace")
    code = None if child.returncode == -signal.SIGKILL and seconds >= MOST_WAITED_SECONDS else child.returncode
    figures = json.loads(summary.read_text()) if code == 0 and summary.exists() else {}
    return Run(code, text, usage.ru_utime + usage.ru_stime, figures.get("peak_bytes", 0), figures)


def kind_of_words(words):
    """The message without its numbers and names, so that equal failures fall together."""
    line = words.strip().splitlines()[-1] if words.strip() else "no words"
    line = line.split(".json: ")[-1]
    return "".join("N" if c.isdigit() else c for c in line)[:90]


def is_refusal(result):
    return result.status == 2 and len(result.words.strip().splitlines()) == 1


def failures_of_run(result, predicted, threads):
    if result.status is None or result.processor > MOST_SECONDS * threads:
        return [f"above {MOST_SECONDS:.0f} s"]
    if is_refusal(result):
        return []
    if result.status != 0:
        return [f"exit {result.status}: {kind_of_words(result.words)}"]
    if not predicted.get("peak_bytes"):
        return []
    ratio = result.bytes / predicted["peak_bytes"]
    return ["memory above 1.2 times the prediction"] if ratio > MOST_OF_PREDICTED_MEMORY else []


def check(synth, number, folder):
    """Makes, predicts and checks one recipe. Returns its failures, whether it was refused, and its file."""
    content, cells = recipe_draw.recipe(number)
    file = folder / f"{number}.json"
    file.write_text(json.dumps(content, indent=1))
    failures, hashes = [], set()
    for threads in (1, 2):
        mesh = folder / f"{number}.ply"
        mesh.unlink(missing_ok=True)
        common = [file, "-o", mesh, "--resolution", cells, "--threads", threads, "--quiet"]
        prediction = run(synth, [*common, "--predict"], folder)
        predicted = prediction.summary.get("predicted", {})
        made = run(synth, common, folder)
        failures += failures_of_run(made, predicted, threads)
        if prediction.status is None:
            failures.append("prediction above 60 s")
        if made.status == 0 and prediction.status != 0:
            failures.append(f"prediction alone refuses: {kind_of_words(prediction.words)}")
        hashes.add((made.status, hashlib.sha256(mesh.read_bytes()).hexdigest() if made.status == 0 else ""))
        if made.status == 0 and threads == 2:
            defect = closed_mesh.defect_of(mesh)
            if defect:
                failures.append(f"no closed 2-manifold: {defect}")
        mesh.unlink(missing_ok=True)
    if len(hashes) > 1:
        failures.append("different bytes for 1 and 2 threads")
    return sorted(set(failures)), made.status == 2, file


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


def print_table(kinds, refusals, count):
    print(f"\n{count} recipes, {refusals} refused in one line, {sum(map(len, kinds.values()))} failures")
    for kind, numbers in sorted(kinds.items(), key=lambda item: -len(item[1])):
        print(f"{len(numbers):5d}  {kind}  (recipes {', '.join(map(str, numbers[:8]))})")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("synth", help="the program")
    parser.add_argument("--count", type=int, default=50, help="number of recipes")
    parser.add_argument("--first", type=int, default=1, help="number of the first recipe")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the recipes that failed")
    parser.add_argument("--compact", action="store_true", help="only turn the recipes into compact ones and back")
    options = parser.parse_args()
    numbers = range(options.first, options.first + options.count)
    kinds, refusals = collections.defaultdict(list), 0
    with tempfile.TemporaryDirectory() as name:
        if options.compact:
            return check_compact(numbers, pathlib.Path(name))
        for number in numbers:
            failures, refused, file = check(options.synth, number, pathlib.Path(name))
            refusals += refused
            for failure in failures:
                kinds[failure].append(number)
                print(f"recipe {number}: {failure}", flush=True)
                if options.keep:
                    options.keep.mkdir(parents=True, exist_ok=True)
                    (options.keep / f"{number}.json").write_bytes(file.read_bytes())
            file.unlink()
    print_table(kinds, refusals, options.count)
    return 1 if kinds else 0


if __name__ == "__main__":
    sys.exit(main())
