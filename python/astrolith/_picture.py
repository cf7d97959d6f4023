"""Pictures of meshes."""

from __future__ import annotations

from typing import Optional, Sequence

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _options, _synthesis
from astrolith._mesh import MeshLike, arrays_of
from astrolith._options import Progress


def render(
    mesh: MeshLike,
    *,
    views: Sequence[Sequence[float]] = (),
    sun: Sequence[float] = (-0.75, 0.45, 0.55),
    width: int = 1280,
    height: int = 960,
    colors: Optional[npt.ArrayLike] = None,
    seed: int = 1,
    threads: int = 0,
    progress: Progress = None,
) -> npt.NDArray[np.uint8]:
    """Render a mesh under sunlight with shadows, as ``synth --preview`` does.

    Parameters
    ----------
    views
        Directions from the body to the viewer, one tile each; empty: +x, +y, +z and obliquely, a patch from above.
    sun
        The direction towards the sun in the axes of each view: right, up, to the viewer.
    width, height
        Pixels of the whole picture, 16 to 16384.
    colors
        (n, 3) linear-light albedo of each vertex in [0, 1]; None: neutral grey.

    Returns
    -------
    ndarray
        (height, width, 3) uint8 sRGB, the top row first.

    Raises
    ------
    ValueError
        The mesh or an argument is wrong.
    """
    arrays = arrays_of(mesh, "mesh")
    directions = [_arrays.vector(view, "views") for view in views]
    towards_sun = _arrays.vector(sun, "sun")
    for name, direction in [("views", d) for d in directions] + [("sun", towards_sun)]:
        if not any(direction):
            raise ValueError(f"{name}: 0 0 0 is no direction; give another")
    albedo = None if colors is None else _arrays.rows(colors, "colors", length=len(arrays.vertices))
    return _synthesis.render(
        arrays.vertices,
        arrays.faces,
        arrays.normals,
        albedo,
        directions,
        towards_sun,
        _arrays.integer(width, "width", 16, 16384),
        _arrays.integer(height, "height", 16, 16384),
        _options.seed(seed),
        _options.threads(threads),
        progress,
    )
