"""Patches of surfaces as heights over a plane."""

from __future__ import annotations

import dataclasses
from typing import Optional, Sequence

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _synthesis
from astrolith._meshing import mesh
from astrolith._options import Progress
from astrolith._recipe import RecipeLike

_UNITS = ("m", "km", "cm", "mm")


@dataclasses.dataclass(eq=False)
class HeightMap:
    """A patch as heights over its mean plane.

    The centre of the pixel in column i and row j lies at origin + (i + 1/2 - n/2) pixel right
    + (n/2 - (j + 1/2)) pixel ahead, in metres of the body-fixed frame, and its surface a height along `up` above.

    Attributes
    ----------
    heights
        (n, n) float32 metres, the top row first; NaN where there is no surface.
    pixel
        Metres a pixel.
    origin
        (3) metres in the body-fixed frame.
    right, ahead, up
        (3) unit vectors of the body-fixed frame.
    body_frame
        The recipe's name of that frame.
    """

    heights: npt.NDArray[np.float32]
    pixel: float
    origin: tuple[float, float, float]
    right: tuple[float, float, float]
    ahead: tuple[float, float, float]
    up: tuple[float, float, float]
    body_frame: str = ""

    def __repr__(self) -> str:
        return f"<astrolith.HeightMap: {self.heights.shape} heights in metres, {self.pixel:.4g} m a pixel>"


def height_map(
    recipe: RecipeLike,
    patch: Sequence[float],
    *,
    resolution: int = 256,
    aligned: bool = False,
    seed: Optional[int] = None,
    threads: int = 0,
    progress: Progress = None,
) -> HeightMap:
    """Make a patch as heights over its mean plane, as ``synth --patch X Y Z SIDE --height-map`` does.

    Parameters
    ----------
    recipe
        A recipe with a body and a unit of length.
    patch
        (x, y, z, side): the centre and the side of a cube, in the recipe's unit.
    resolution
        Pixels along a side, 4 to 8192. The mesh has as many cells.
    aligned
        Whether the cube stands on its ground, as with ``--aligned``: the map's square is then the cube's, without
        an empty border.

    Raises
    ------
    ValueError
        There is no surface in the patch or beside it, the recipe is in pixels, or an argument is wrong.
    """
    resolution = _arrays.integer(resolution, "resolution", 4, 8192)
    made = mesh(
        recipe, patch=patch, aligned=aligned, resolution=resolution, seed=seed, threads=threads, progress=progress
    )
    side = _arrays.vector(patch, "patch", 4)[3]
    unit = _arrays.choice(made.length_unit, "recipe.length_unit", _UNITS)
    vertices = made.vertices.astype(np.float64)
    plane = made.figures.get("map_plane")
    if plane is None:
        raise ValueError("patch: the surface in it faces no direction; take a smaller one")
    rows = [plane["right"], plane["ahead"], plane["up"], plane["origin"]]
    fields = _synthesis.height_map(vertices, made.faces, made.origin or (0.0, 0.0, 0.0), side, resolution, unit, rows)
    return HeightMap(**fields, body_frame=made.frame)
