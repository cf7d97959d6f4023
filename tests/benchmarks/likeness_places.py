#!/usr/bin/env python3
"""How far a body of its kind goes from the measured one: the correlation of both reliefs vertex by vertex, and the angles
between neighbouring facets of both surfaces, which seams of patches would make larger.

    likeness_places.py RECIPE... [--resolution 256]       needs the Python package of the build on PYTHONPATH, and NumPy
"""
import astrolith
import numpy

from measure import arguments_of


def facet_angles(mesh):
    """The angles between facets with a common edge, in degrees."""
    corners = mesh.vertices[mesh.faces]
    normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= numpy.linalg.norm(normals, axis=1)[:, None]
    edges = numpy.sort(mesh.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2).astype(numpy.int64), axis=1)
    first, second = numpy.argsort(edges[:, 0] * len(mesh.vertices) + edges[:, 1], kind="stable").reshape(-1, 2).T // 3
    return numpy.degrees(numpy.arccos(numpy.clip(numpy.sum(normals[first] * normals[second], axis=1), -1, 1)))


if __name__ == "__main__":
    given = arguments_of(__doc__, "recipes", resolution=256)
    for file in given.recipes:
        recipe = astrolith.Recipe.read(file)
        bare = recipe.copy()
        bare["layers"] = []
        points = astrolith.mesh(bare, resolution=128).vertices
        base, measured = astrolith.Field(bare).value(points), None
        for name, body in [("measured", recipe), *((f"seed {seed}", recipe.like(seed)) for seed in (1, 2, 3))]:
            heights = astrolith.Field(body).value(points) - base
            measured = heights if measured is None else measured
            angles = numpy.quantile(facet_angles(astrolith.mesh(body, resolution=given.resolution)), [0.99, 0.999, 0.9999])
            print(f"{file}, {name}: correlation {numpy.corrcoef(measured, heights)[0, 1]:.3f}, "
                  f"angles of facets, degrees: 99, 99.9, 99.99 %: {numpy.round(angles, 1)}", flush=True)
