#!/usr/bin/env python3
"""Holds the craters that `describe --craters` finds against those that `synth` made.

    found_craters.py build/release/bin [--bodies shown|held|fitted|boulders] [--facets 100000] [--keep DIR]     needs NumPy

Each body is made from a recipe of this script; its list of features is the truth. `shown` are five bodies, `held` ten with
other seeds, lengths and bases, `fitted` those that the detector's confidence was fitted to. A crater counts that is above
8 mean edges wide, deeper than .03 of its diameter and at most half covered by craters that fell later. It is found if one
of the table has its centre within .3 of its diameter and .65 to 1.5 times its diameter. Precision is the share of found
craters above 8 edges that lie so on some crater of the list, whatever its depth and cover, each on one of its own. The
error of the diameter is the median of |found / made - 1|, the bias that of found / made.

`boulders` are six bodies with boulders, by the same measure: one counts above 6 edges that rises by .12 of its width, the
mean of its longer axes, and is found within .4 of that width and .6 to 1.7 times it.
"""
import csv
import json
import pathlib
import random
import tempfile
from typing import NamedTuple

import numpy

from measure import ROOT, Run, arguments_of, head, row

CONFIDENT = 0.5
MADE = ("simple", "worn", "finished", "drawn")


def recipe_of(body, size, draw, number, greatest, exponent, degradation, spread, hills, unit="m"):
    """A body with hills and craters. `size` is its mean radius; hills and the greatest crater are in it."""
    population = {"count": number, "least_diameter": 0.1 * size, "greatest_diameter": greatest * size, "exponent": exponent,
                  "degradation": degradation, "depth_spread": spread}  # fmt: skip
    ground = {"type": "simplex", "name": "hills", "amplitude": hills * size, "octaves": 4,
              "frequency": draw.uniform(0.7, 1.5) / size}  # fmt: skip
    layers = [ground, {"type": "craters", "name": "impacts", "population": population}]
    return {"format_version": 1, "length_unit": unit, "seed": draw.randrange(1 << 30), "body": body, "layers": layers}


def simple(draw):
    return recipe_of(metaballs([0, 0, 0, 100]), 100, draw, 60, 0.8, 1.5, 0.5, 0.0, 0.02)


def worn(draw):
    lobes = metaballs([-50, 0, 0, 80], [draw.uniform(55, 75), 10, 0, draw.uniform(55, 70)])
    return recipe_of(lobes, 95, draw, 150, 0.8, 2.0, 0.8, 0.3, 0.04)


def finished(draw):
    lumps = metaballs([-150, 0, 0, 130], [20, 30, 0, 150], [draw.uniform(120, 170), 0, 20, 100])
    return recipe_of(lumps, 190, draw, 0, 0.8, 2.0, 0.0, 0.0, 0.03)


def measured(body, size):
    return lambda draw: recipe_of(body, size, draw, 120, 0.7, 1.8, 0.6, 0.2, 0.01, "km")


def drawn(body):
    return lambda draw: recipe_of(body, 145, draw, 100, 0.7, 1.8, 0.5, 0.2, 0.02)


def bouldery(draw):
    body = metaballs([0, 0, 0, 100]) if draw.random() < 0.5 else metaballs([-50, 0, 0, 80], [65, 10, 0, 65])
    made = recipe_of(body, 100, draw, 40, 0.6, 1.8, 0.5, 0.0, draw.choice([0.01, 0.02, 0.04]))
    if draw.random() < 0.5:
        made["layers"].pop()
    drawn = {"count": 70, "least_diameter": 9, "greatest_diameter": 40, "exponent": 2}
    made["layers"].append({"type": "boulders", "name": "blocks", "population": drawn})
    return made


def metaballs(*spheres):
    return {"type": "metaballs", "blend_exponent": 2, "spheres": list(spheres)}


def bare(file, programs, folder):
    """The body of a recipe of the repository."""
    Run(programs / "synth", ROOT / file, "--write-recipe", folder / "base.json", "--quiet")
    return json.loads((folder / "base.json").read_text())["body"]


def bodies(which, programs, folder):
    """(name, recipe, options of synth)"""
    library = {"eros": 8.4, "phobos": 11.1, "deimos": 6.2, "epimetheus": 58.0, "ida": 15.7, "castalia": 0.54}
    named = lambda name: measured(bare(f"library/{name}.astro", programs, folder), library[name])  # noqa: E731
    morph = drawn(bare("synthesis/examples/drawn_body.json", programs, folder))
    finish = ["--finish", "eros", "--from", 120, "--to", 8]
    kinds = {"simple": simple, "worn": worn, "finished": finished, "drawn": morph, "bouldery": bouldery}
    sets = {"shown": [("simple", 1), ("worn", 1), ("finished", 1), ("eros", 1), ("drawn", 1)],
            "held": [*((kind, seed) for kind in MADE for seed in (2, 3)), ("phobos", 2), ("epimetheus", 3)],
            "fitted": [*((kind, seed) for kind in MADE for seed in (11, 12, 13)),
                       ("deimos", 11), ("ida", 12), ("castalia", 13)],
            "boulders": [("bouldery", seed) for seed in range(1, 7)]}  # fmt: skip
    for name, seed in sets[which]:
        draw = random.Random(f"{name} {seed}")
        recipe = (kinds[name] if name in kinds else named(name))(draw)
        if name == "finished":
            recipe["layers"].pop()
        yield f"{name} {seed}", recipe, finish if name == "finished" else []


def table_of(file):
    with open(file, newline="") as text:
        return list(csv.DictReader(text))


def columns(rows, *names):
    return numpy.array([[float(r[name] or "nan") for name in names] for r in rows]).reshape(len(rows), len(names))


def vertices_of(obj):
    return numpy.array([line.split()[1:4] for line in obj.read_text().splitlines() if line.startswith("v ")], float)


def covered(places, radii, vertices):
    """The share of each crater's vertices that lie within craters which fell later."""
    shares = numpy.zeros(len(radii))
    for k, (place, radius) in enumerate(zip(places, radii)):
        own = vertices[((vertices - place) ** 2).sum(1) < radius**2]
        far = ((own[:, None] - places[k + 1 :]) ** 2).sum(2) > radii[k + 1 :] ** 2
        shares[k] = 1.0 - far.all(1).mean() if len(own) else 1.0
    return shares


class Kind(NamedTuple):
    least: float  # mean edges
    depth: float  # over the diameter
    apart: float  # of the found and the true place, over the diameter
    ratio: tuple  # of the found to the true diameter


KINDS = {"crater": Kind(8.0, 0.03, 0.3, (0.65, 1.5)), "boulder": Kind(6.0, 0.12, 0.4, (0.6, 1.7))}


class Truth:
    def __init__(self, features, vertices, name="crater"):
        self.kind = KINDS[name]
        made = [r for r in table_of(features) if name in r["kind"] and r["x"]]
        self.places = columns(made, "x", "y", "z")
        self.diameters, self.depths = columns(made, "diameter", "depth").T
        if name == "boulder":
            b, c, burial = columns(made, "axis_b", "axis_c", "burial").T
            self.diameters, self.depths = numpy.sqrt(self.diameters * b), (1 - burial) * c
        hidden = name == "crater"
        self.covered = covered(self.places, self.diameters / 2, vertices) if hidden else numpy.zeros(len(made))

    def counting(self, edge):
        high = self.depths > self.kind.depth * self.diameters
        return (self.diameters > self.kind.least * edge) & high & (self.covered <= 0.5)


def matches(found, made, may, kind=KINDS["crater"]):
    """For each crater that is found the one that is made, each of its own, nearest first; -1 for none."""
    (places, diameters), (true_places, true_diameters) = found, made
    apart = numpy.sqrt(((places[:, None] - true_places) ** 2).sum(2)) / true_diameters
    ratio = diameters[:, None] / true_diameters
    off = apart / kind.apart + numpy.abs(numpy.log(ratio)) / 0.4
    off[(apart > kind.apart) | (ratio < kind.ratio[0]) | (ratio > kind.ratio[1]) | ~may] = numpy.inf
    result = numpy.full(len(diameters), -1)
    for flat in numpy.argsort(off, axis=None):
        i, j = numpy.unravel_index(flat, off.shape)
        if not numpy.isfinite(off[i, j]):
            break
        result[i] = j
        off[i], off[:, j] = numpy.inf, numpy.inf
    return result


def judged(name, recipe, options, programs, facets, folder):
    endings = (".json", ".obj", ".features.csv", ".found.csv", ".summary.json")
    files = {ending: folder / (name.replace(" ", "_") + ending) for ending in endings}
    files[".json"].write_text(json.dumps(recipe))
    if not files[".obj"].exists():  # kept from an earlier run
        made = ["-o", files[".obj"], "--feature-list", files[".features.csv"], "--quiet"]
        Run(programs / "synth", files[".json"], *options, "--triangles", facets, *made)
    kind = "boulder" if name.startswith("bouldery") else "crater"
    found = ["--craters", files[".found.csv"], "--summary", files[".summary.json"], "--quiet"]
    Run(programs / "describe", files[".obj"], *found, *(["--boulders"] if kind == "boulder" else []))
    edge = json.loads(files[".summary.json"].read_text())["craters"]["edge"]
    truth = Truth(files[".features.csv"], vertices_of(files[".obj"]), kind)
    found = [r for r in table_of(files[".found.csv"]) if r["kind"] == kind and float(r["confidence"]) >= CONFIDENT]
    places, diameters = columns(found, "x", "y", "z"), columns(found, "diameter")[:, 0]
    made, counting = (truth.places, truth.diameters), truth.counting(edge)
    hits = matches((places, diameters), made, counting, truth.kind)
    every = matches((places, diameters), made, numpy.full(len(counting), True), truth.kind)
    large = diameters > truth.kind.least * edge
    ratios = diameters[hits >= 0] / truth.diameters[hits[hits >= 0]]
    return counting.sum(), (hits >= 0).sum(), large.sum(), (every >= 0)[large].sum(), ratios


def cells(made, hit, found, right, ratios):
    error, bias = numpy.median(numpy.abs(ratios - 1)), numpy.median(ratios)
    return made, found, f"{hit / max(made, 1):.2f}", f"{right / max(found, 1):.2f}", f"{error:.3f}", f"{bias:.3f}"


if __name__ == "__main__":
    which = {"choices": ["shown", "held", "fitted", "boulders"], "default": "shown"}
    given = arguments_of(__doc__, "bin", bodies=which, facets=100000, keep="")
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(given.keep or temporary)
        head("body", "that count", "found", "recall", "precision", "error of diameter", "bias")
        results = []
        for name, recipe, options in bodies(given.bodies, given.bin, folder):
            results.append(judged(name, recipe, options, given.bin, given.facets, folder))
            row(name, *cells(*results[-1]))
        made, hit, found, right, ratios = zip(*results)
        row("all", *cells(sum(made), sum(hit), sum(found), sum(right), numpy.concatenate(ratios)))
