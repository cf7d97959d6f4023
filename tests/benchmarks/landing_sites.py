#!/usr/bin/env python3
"""Measures the slope and the roughness of landing sites again, on the meshes of synth's aligned patches.

    landing_sites.py build/release/bin RECIPE SIZE [--density 2000] [--period 12] [--resolution 256] [--sites 5]

SIZE is in the recipe's unit. A patch has cells as fine as the body's mesh. Slopes are those of the patch's facets
against the effective gravity at their centres; the plane is fitted with NumPy. Needs NumPy.
"""
import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import numpy

METRES = {"m": 1.0, "km": 1000.0}


def run(*command, folder):
    words = [str(word) for word in command]
    return subprocess.run(words, check=True, capture_output=True, text=True, cwd=folder).stdout


def facets_of(mesh):
    """The corners of the facets, (m, 3, 3)."""
    lines = mesh.read_text().split("\n")
    vertices = numpy.array([[float(word) for word in line.split()[1:4]] for line in lines if line.startswith("v ")])
    faces = [[int(word.split("/")[0]) - 1 for word in line.split()[1:4]] for line in lines if line.startswith("f ")]
    return vertices[numpy.array(faces)]


def slopes_of(normals, places, options, folder):
    """Degrees, by the potential's gradient and the rotation about the centre of mass; places in the recipe's unit."""
    numpy.savetxt(folder / "places.txt", places, fmt="%.12g")
    figures = json.loads(run(options.bin / "gravity", options.recipe, *options.body, "--points", "places.txt", "-o",
                             "gravity.npy", "--sample", 0, folder=folder))  # fmt: skip
    from_axis = METRES[figures["unit"]] * places - numpy.array(figures["body"]["center_of_mass_m"])
    from_axis[:, 2] = 0.0
    rate = 2.0 * numpy.pi / (3600.0 * options.period)
    effective = numpy.load(folder / "gravity.npy")[:, 4:7] + rate**2 * from_axis
    cosine = -(normals * effective).sum(1) / numpy.linalg.norm(effective, axis=1)
    return numpy.degrees(numpy.arccos(numpy.clip(cosine, -1.0, 1.0)))


def measured(site, cell, options, folder):
    """Mean slope in degrees, roughness in the recipe's unit, and the number of empty pixels."""
    patch = [float(word) for word in site["patch"].split()]
    cells = max(8, round(patch[3] / cell))
    run(options.bin / "synth", options.recipe, "-o", "patch.obj", "--patch", *patch, "--aligned", "--resolution", cells,
        "--height-map", "patch.tif", "--summary", "summary.json", folder=folder)  # fmt: skip
    summary = json.loads((folder / "summary.json").read_text())
    axes = numpy.array([summary["patch_axes"][name] for name in ("right", "ahead", "up")])
    corners = facets_of(folder / "patch.obj")
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    areas = numpy.cross(b - a, c - a) / 2.0
    weight = areas @ axes[2]
    normals = areas / numpy.linalg.norm(areas, axis=1)[:, None]
    slopes = slopes_of(normals, corners.mean(axis=1) + patch[:3], options, folder)
    middles = numpy.concatenate([a + b, b + c, c + a]) / 2.0 @ axes.T
    weights = numpy.tile(numpy.maximum(weight, 0.0), 3)
    terms = numpy.column_stack([numpy.ones(len(middles)), middles[:, :2]])
    root = numpy.sqrt(weights)
    plane = numpy.linalg.lstsq(terms * root[:, None], middles[:, 2] * root, rcond=None)[0]
    rest = middles[:, 2] - terms @ plane
    empty = summary["height_map"]["pixels_without_data"]
    return (slopes * weight).sum() / weight.sum(), numpy.sqrt((weights * rest**2).sum() / weights.sum()), empty


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=lambda text: Path(text).resolve())
    parser.add_argument("recipe", type=lambda text: Path(text).resolve())
    parser.add_argument("size", type=float)
    parser.add_argument("--density", type=float, default=2000.0)
    parser.add_argument("--period", type=float, default=12.0)
    parser.add_argument("--resolution", type=int, default=256)
    parser.add_argument("--sites", type=int, default=5)
    options = parser.parse_args()
    options.body = ["--density", options.density, "--period", options.period, "--resolution", options.resolution]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        found = json.loads(run(options.bin / "gravity", options.recipe, *options.body, "--sites", options.sites,
                               "--site-size", options.size, folder=folder))  # fmt: skip
        run(options.bin / "synth", options.recipe, "-o", "body.ply", "--resolution", options.resolution, "--summary",
            "body.json", folder=folder)  # fmt: skip
        cell = json.loads((folder / "body.json").read_text())["cell"]
        print("| slope | again | roughness, m | again | empty pixels |\n|---|---|---|---|---|")
        for site in found["sites"]:
            slope, roughness, empty = measured(site, cell, options, folder)
            of_slope = 100 * (slope / site["mean_slope_deg"] - 1)
            of_roughness = 100 * (METRES[found["unit"]] * roughness / site["roughness_m"] - 1)
            print(f"| {site['mean_slope_deg']:.3f} | {of_slope:+.1f} % ", end="")
            print(f"| {site['roughness_m']:.4g} | {of_roughness:+.1f} % | {empty} |")


if __name__ == "__main__":
    main()
