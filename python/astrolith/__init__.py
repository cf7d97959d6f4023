"""Procedural recipes for small bodies and rock: synthesis, fitting, description.

>>> import astrolith
>>> ball = {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0, 0, 0, 1]]}
>>> mesh = astrolith.mesh({"format_version": 1, "length_unit": "km", "body": ball}, resolution=16)
>>> mesh.vertices.shape[1], mesh.figures.closed
(3, True)

Arrays are NumPy arrays. Lengths are in the recipe's ``length_unit``. Positions are in the body-fixed frame. The same
options and seed give the bytes that the programs ``synth``, ``fit_shape``, ``fit_gabor``, ``describe``, ``compare``
and ``gravity`` give, for any number of threads.

``astrolith.synthesis`` needs no library of the fits. ``astrolith.estimation`` links FFTW and CGAL, which are under the
GPL; it is loaded when one of its names is first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from astrolith.synthesis import (
    Camera,
    Craters,
    Description,
    Field,
    Gravity,
    HeightMap,
    Image,
    Mesh,
    Ranges,
    Recipe,
    Scene,
    SurfaceDescription,
    Texture,
    Variation,
    __version__,
    compare,
    describe,
    describe_surface,
    draw,
    expose,
    find_craters,
    gravity,
    height_map,
    library,
    mesh,
    mesh_formats,
    predict,
    read_mesh,
    realism,
    render,
    synth,
    texture,
    vary,
    write_mesh,
)

if TYPE_CHECKING:
    from astrolith.estimation import (
        Packing,
        ShapeFit,
        TextureFit,
        classify,
        fit_shape,
        fit_texture,
        pack_spheres,
        repair_mesh,
        train_classifier,
    )

__all__ = [
    "Camera",
    "Craters",
    "Description",
    "Field",
    "Gravity",
    "HeightMap",
    "Image",
    "Mesh",
    "Packing",
    "Ranges",
    "Recipe",
    "Scene",
    "ShapeFit",
    "SurfaceDescription",
    "Texture",
    "TextureFit",
    "Variation",
    "__version__",
    "classify",
    "compare",
    "describe",
    "describe_surface",
    "find_craters",
    "fit_shape",
    "fit_texture",
    "gravity",
    "height_map",
    "library",
    "mesh",
    "mesh_formats",
    "pack_spheres",
    "predict",
    "read_mesh",
    "realism",
    "render",
    "synth",
    "repair_mesh",
    "texture",
    "train_classifier",
    "draw",
    "expose",
    "vary",
    "write_mesh",
]

_ESTIMATION = (
    "Packing",
    "ShapeFit",
    "TextureFit",
    "classify",
    "fit_shape",
    "fit_texture",
    "pack_spheres",
    "repair_mesh",
    "train_classifier",
)


def __getattr__(name: str) -> Any:
    """Load the fits and the bridges when one of their names is first used."""
    if name in ("bridges", "estimation"):
        return importlib.import_module(f"astrolith.{name}")
    if name in _ESTIMATION:
        return getattr(importlib.import_module("astrolith.estimation"), name)
    raise AttributeError(f"module 'astrolith' has no attribute {name!r}")


def __dir__() -> list[str]:
    """The public names, also of the fits that are not loaded yet, and of the modules."""
    return sorted({*__all__, "bridges", "estimation", "synthesis"})
