#!/usr/bin/env python3
"""Whether drawn boulders follow the laws that their recipe states: numbers, exponent, axes, burial and share of the area.

    boulder_laws.py build/release/bin [--seeds 3]       needs NumPy

A sphere of 600 m is strewn by a count and by cells. Each row has what the recipe states, what the feature list has, and their
ratio, over the seeds together. The exponent is the one of greatest likelihood for a power law between two limits.
"""
import csv
import json
import pathlib
import tempfile

import numpy

from measure import Run, arguments_of, head, row

RADIUS, LEAST, GREATEST, EXPONENT = 300.0, 2.0, 18.0, 2.7


def exponent_of(diameters):
    """Of N(> D) ~ D^-a between LEAST and GREATEST, by bisection of the likelihood's slope."""
    logs = numpy.log(diameters / LEAST).mean()
    low, high, span = 0.1, 10.0, numpy.log(GREATEST / LEAST)
    for _ in range(80):
        a = (low + high) / 2
        slope = 1 / a - span / numpy.expm1(a * span) - logs
        low, high = (a, high) if slope > 0 else (low, a)
    return a


def mean_square(a=EXPONENT):
    """Of diameters under the law."""
    top = GREATEST ** (2 - a) - LEAST ** (2 - a)
    return a / (2 - a) * top / (LEAST**-a - GREATEST**-a)


def drawn(programs, population, seeds, folder):
    columns = {name: [] for name in ("diameter", "axis_b", "axis_c", "burial")}
    for seed in range(1, seeds + 1):
        recipe, table = folder / "body.json", folder / "features.csv"
        recipe.write_text(json.dumps({
            "format_version": 1, "length_unit": "m", "seed": seed,
            "body": {"type": "metaballs", "spheres": [[0, 0, 0, RADIUS]]},
            "layers": [{"type": "boulders", "population": population}]}))  # fmt: skip
        Run(programs / "synth", recipe, "-o", folder / "body.ply", "--resolution", 128, "--feature-list", table, "--quiet")
        with table.open() as lines:
            for line in csv.DictReader(text for text in lines if not text.startswith("#")):
                for name in columns:
                    columns[name].append(float(line[name]))
    return {name: numpy.array(values) for name, values in columns.items()}


if __name__ == "__main__":
    given = arguments_of(__doc__, "programs", seeds=3)
    law = {"least_diameter": LEAST, "greatest_diameter": GREATEST, "exponent": EXPONENT}
    area, density = 4 * numpy.pi * RADIUS**2, 0.02
    kinds = {"by a count": dict(law, count=20000), "by cells": dict(law, density=density, by_cells=True)}
    head("boulders", "quantity", "stated", "drawn", "ratio")
    for name, population in kinds.items():
        with tempfile.TemporaryDirectory() as folder:
            found = drawn(given.programs[0], population, given.seeds, pathlib.Path(folder))
        count = population.get("count", density * area)
        a, b, c = found["diameter"], found["axis_b"], found["axis_c"]
        for quantity, stated, value in (
            ("number", count * given.seeds, len(a)),
            ("exponent", EXPONENT, exponent_of(a)),
            ("b / a", 0.71, (b / a).mean()),
            ("c / a", 0.5, (c / a).mean()),
            ("burial", 0.35, found["burial"].mean()),
            ("share of the area", count / area * numpy.pi / 4 * 0.71 * mean_square(), (numpy.pi / 4 * a * b).sum() / area / given.seeds),
        ):
            row(name, quantity, f"{stated:.4g}", f"{value:.4g}", f"{value / stated:.3f}")
