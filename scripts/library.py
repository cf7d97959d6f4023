#!/usr/bin/env python3
"""Makes the library of bodies, library/NAME.astro, of shape models and of the table library/bodies.json, and their population.

    PYTHONPATH=build/release/python scripts/library.py build/release/bin FOLDER_OF_MODELS [NAME ...]

Without names it makes all bodies of the table: some 10 minutes on two cores. It fits 80 metaballs and the relief, in at
most BYTES, puts the source and the licence into the recipe's description, and writes volume and mean diameter of the
model into the table. It prints for each body: bytes, mean and largest distance between mesh and model, in per cent of
the diagonal, and the ratio of the volumes.
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

import astrolith

LIBRARY = pathlib.Path(__file__).resolve().parent.parent / "library"
BYTES = 16000


def fitted(programs, model, recipe, body):
    """The figures of the fit, after which the recipe lies in the library."""
    figures = recipe.with_suffix(".json")
    # The description takes some of the bytes.
    fit = [programs / "fit_shape", model, "-o", recipe, "--bytes", str(BYTES - 200), "--unit", "km", "--noise-seeds", "0"]
    subprocess.run([*fit, *body.get("fit_options", []), "--device", "cpu", "--summary", figures, "--quiet"], check=True)
    described = astrolith.Recipe.read(recipe)
    described["description"] = f"{body['title']}. Shape model: {body['credit']}. Licence: {body['licence']}."
    described.write(LIBRARY / f"{body['name']}.astro")
    return json.loads(figures.read_text())


def volume_of(model):
    """The volume of a model, of which no part counts twice."""
    return astrolith.repair_mesh(model, all_parts=True, union=True)[0].volume


def gather(programs, bodies):
    """Makes the population of all bodies, populations/asteroids.astro, with what the table knows of them."""
    with tempfile.TemporaryDirectory() as folder:
        table = pathlib.Path(folder) / "bodies.csv"
        rows = [f"{b['name']},{b['source']},{b.get('class', '')},{b.get('rotation_period_h', '')},{b.get('bulk_density_kg_m3', '')}" for b in bodies]
        table.write_text("\n".join(["name,source,class,rotation_period_h,density_kg_m3", *rows]) + "\n")
        recipes = [LIBRARY / f"{body['name']}.astro" for body in bodies]
        subprocess.run([programs / "fit_population", *recipes, "-o", LIBRARY / "populations/asteroids.astro", "--table", table, "--unit", "m"], check=True)


def main():
    programs, models = map(pathlib.Path, sys.argv[1:3])
    table = LIBRARY / "bodies.json"
    bodies = json.loads(table.read_text())
    with tempfile.TemporaryDirectory() as folder:
        for body in bodies["bodies"]:
            if sys.argv[3:] and body["name"] not in sys.argv[3:]:
                continue
            model, recipe = models / body["model"], pathlib.Path(folder) / f"{body['name']}.astro"
            figures = fitted(programs, model, recipe, body)
            volume = volume_of(model)
            body["volume_km3"] = float(f"{volume:.4g}")
            body["mean_diameter_km"] = float(f"{(6 * volume / math.pi) ** (1 / 3):.4g}")
            size = (LIBRARY / recipe.name).stat().st_size
            print(f"{body['name']:11s} {size:6d} B  mean {100 * figures['mean_distance']:.4f} %  "
                  f"max {100 * figures['max_distance']:.3f} %  volume {figures['volume_ratio']:.4f}", flush=True)  # fmt: skip
            table.write_text(json.dumps(bodies, indent=2) + "\n")
    gather(programs, bodies["bodies"])


if __name__ == "__main__":
    main()
