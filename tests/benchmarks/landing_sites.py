#!/usr/bin/env python3
"""Measures the slope and the roughness of landing sites again, on the meshes of aligned patches.

    landing_sites.py RECIPE --size SIZE [--density 2000] [--period 12] [--resolution 256] [--sites 5]

SIZE is in the recipe's unit. A patch has cells as fine as the body's mesh. Slopes are those of the patch's facets
against the effective gravity at their centres; the plane is fitted with NumPy. Needs the Python package of the build on
PYTHONPATH, and NumPy.
"""
import astrolith
import numpy

from measure import arguments_of, head, row

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


if __name__ == "__main__":
    given = arguments_of(__doc__, "recipe", size={"type": float, "required": True}, density=2000.0, period=12.0, resolution=256, sites=5)
    body = {"density": given.density, "period": given.period, "resolution": given.resolution}
    found = astrolith.gravity(given.recipe, sites=given.sites, site_size=given.size, **body)
    cell = astrolith.mesh(given.recipe, resolution=given.resolution).figures.cell
    head("slope", "again", "roughness, m", "again")
    for site in found.sites:
        slope, roughness = measured(site, cell, body, given)
        of_roughness = METRES[found.figures.unit] * roughness / site.roughness_m - 1
        row(f"{site.mean_slope_deg:.3f}", f"{100 * (slope / site.mean_slope_deg - 1):+.1f} %",
            f"{site.roughness_m:.4g}", f"{100 * of_roughness:+.1f} %")
