"""Procedural recipes for small bodies and rock: synthesis and description.

>>> import astrolith
>>> ball = {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0, 0, 0, 1]]}
>>> mesh = astrolith.mesh({"format_version": 1, "length_unit": "km", "body": ball}, resolution=16)
>>> mesh.vertices.shape[1], mesh.figures.closed
(3, True)

Arrays are NumPy arrays. Lengths are in the recipe's ``length_unit``. Positions are in the body-fixed frame. The same
options and seed give the bytes that the programs ``synth``, ``describe`` and ``compare`` give, for any number of threads.
``astrolith.synthesis`` needs no library of the fits.
"""

from __future__ import annotations


from astrolith.synthesis import (
    Description,
    Field,
    Mesh,
    Recipe,
    Texture,
    Variation,
    __version__,
    compare,
    describe,
    mesh,
    read_mesh,
    render,
    texture,
    vary,
    write_mesh,
)

__all__ = [
    "Description",
    "Field",
    "Mesh",
    "Recipe",
    "Texture",
    "Variation",
    "__version__",
    "compare",
    "describe",
    "mesh",
    "read_mesh",
    "render",
    "texture",
    "vary",
    "write_mesh",
]
