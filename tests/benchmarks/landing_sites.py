#!/usr/bin/env python3
"""Measures the slope and the roughness of landing sites again, on the meshes of aligned patches.

    landing_sites.py RECIPE SIZE [--density 2000] [--period 12] [--resolution 256] [--sites 5]

SIZE is in the recipe's unit. A patch has cells as fine as the body's mesh. Slopes are those of the patch's facets
against the effective gravity at their centres; the plane is fitted with NumPy. Needs the Python package of the build on
PYTHONPATH, and NumPy.
"""
import argparse

import astrolith
import numpy

METRES = {"m": 1.0, "km": 1000.0}


def slopes_of(normals, places, body, options):
    """Degrees, by the potential's gradient and the rotation about the centre of mass; places in the recipe's unit."""
    found = astrolith.gravity(options.recipe, points=places, sample=0, **body)
    from_axis = METRES[found.figures.unit] * places - numpy.array(found.figures.body.center_of_mass_m)
    from_axis[:, 2] = 0.0
    rate = 2.0 * numpy.pi / (3600.0 * options.period)
    effective = found.acceleration + rate**2 * from_axis
    cosine = -(normals * effective).sum(1) / numpy.linalg.norm(effective, axis=1)
    return numpy.degrees(numpy.arccos(numpy.clip(cosine, -1.0, 1.0)))


def measured(site, cell, body, options):
    """Mean slope in degrees, and roughness in the recipe's unit."""
    patch = [float(word) for word in site.patch.split()]
    mesh = astrolith.mesh(options.recipe, patch=patch, aligned=True, resolution=max(8, round(patch[3] / cell)))
    axes = numpy.array([mesh.figures.patch_axes[name] for name in ("right", "ahead", "up")])
    corners = mesh.vertices[mesh.faces].astype(float)
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    areas = numpy.cross(b - a, c - a) / 2.0
    weight = areas @ axes[2]
    normals = areas / numpy.linalg.norm(areas, axis=1)[:, None]
    slopes = slopes_of(normals, corners.mean(axis=1) + patch[:3], body, options)
    middles = numpy.concatenate([a + b, b + c, c + a]) / 2.0 @ axes.T
    weights = numpy.tile(numpy.maximum(weight, 0.0), 3)
    terms = numpy.column_stack([numpy.ones(len(middles)), middles[:, :2]])
    root = numpy.sqrt(weights)
    plane = numpy.linalg.lstsq(terms * root[:, None], middles[:, 2] * root, rcond=None)[0]
    rest = middles[:, 2] - terms @ plane
    return (slopes * weight).sum() / weight.sum(), numpy.sqrt((weights * rest**2).sum() / weights.sum())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipe")
    parser.add_argument("size", type=float)
    parser.add_argument("--density", type=float, default=2000.0)
    parser.add_argument("--period", type=float, default=12.0)
    parser.add_argument("--resolution", type=int, default=256)
    parser.add_argument("--sites", type=int, default=5)
    options = parser.parse_args()
    body = {"density": options.density, "period": options.period, "resolution": options.resolution}
    found = astrolith.gravity(options.recipe, sites=options.sites, site_size=options.size, **body)
    cell = astrolith.mesh(options.recipe, resolution=options.resolution).figures.cell
    print("| slope | again | roughness, m | again |\n|---|---|---|---|")
    for site in found.sites:
        slope, roughness = measured(site, cell, body, options)
        of_roughness = METRES[found.figures.unit] * roughness / site.roughness_m - 1
        print(f"| {site.mean_slope_deg:.3f} | {100 * (slope / site.mean_slope_deg - 1):+.1f} % "
              f"| {site.roughness_m:.4g} | {100 * of_roughness:+.1f} % |")


if __name__ == "__main__":
    main()
