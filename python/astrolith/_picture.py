"""Pictures of meshes."""

from __future__ import annotations

from typing import Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _options, _synthesis
from astrolith._mesh import MeshLike, arrays_of, surface_of
from astrolith._options import Progress


def linear_light(colors: npt.NDArray[np.uint8]) -> npt.NDArray[np.float64]:
    """The linear light, 0 to 1, of colours in sRGB of 8 bits."""
    encoded = np.asarray(colors) / 255.0
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def render(
    mesh: MeshLike,
    *,
    views: Sequence[Sequence[float]] = (),
    cameras: Union[str, Sequence[str]] = (),
    map: str = "",
    sun: Sequence[float] = (-0.75, 0.45, 0.55),
    sun_body: Optional[Sequence[float]] = None,
    reflectance: str = "rock",
    ambient: float = 0.1,
    transparent: bool = False,
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
        Directions from the body to the viewer, one panel each.
    cameras
        Cameras in the words of ``synth --camera``, such as ``"lat 20 lon 45 fov 30 radii 4"``, one panel each.
        Without views and cameras: +x, +y, +z and obliquely, a patch from above.
    map
        ``"equirectangular"``, all longitudes and latitudes, or ``"hemispheres"``, two by Lambert's projection, which keeps
        areas, in place of views, with lines every 30 degrees. The light comes from the upper left.
    sun
        The direction towards the sun in the axes of each view: right, up, to the viewer.
    sun_body
        The direction towards the sun in the axes of the mesh, in place of ``sun``.
    reflectance
        ``"lambert"``, ``"lommel-seeliger"``, ``"rock"``, .35 of Lommel-Seeliger and .65 of Lambert, ``"akimov"``, or a law
        with its numbers, ``"mcewen L .5"``, ``"minnaert k .7"`` or ``"hapke w .2 g -.3 b0 .8 h .05 theta 20"`` (degrees).
    ambient
        Light from everywhere as a share of sunlight, 0 to 10.
    transparent
        Whether the background is transparent.
    width, height
        Pixels of the whole picture, 16 to 16384.
    colors
        (n, 3) linear-light albedo of each vertex in [0, 1]; None: the mesh's own colors, or else neutral grey.

    Returns
    -------
    ndarray
        (height, width, 3) uint8 sRGB, the top row first; (height, width, 4) with alpha where ``transparent``.

    Raises
    ------
    ValueError
        The mesh or an argument is wrong.
    """
    own = getattr(mesh, "colors", None)
    if colors is None and own is not None:
        colors = linear_light(own)
    # Colours belong to the vertices as they are.
    arrays = surface_of(mesh, "mesh") if colors is None else arrays_of(mesh, "mesh")
    directions = [_arrays.vector(view, "views") for view in _arrays.items(views, "views")]
    words = [_arrays.text(camera, "cameras") for camera in ([cameras] if isinstance(cameras, str) else _arrays.items(cameras, "cameras"))]
    sun_name, towards_sun = ("sun", sun) if sun_body is None else ("sun_body", sun_body)
    towards_sun = _arrays.vector(towards_sun, sun_name)
    projection = _arrays.text(map, "map")
    if projection not in ("", "equirectangular", "hemispheres"):
        raise ValueError(f'map: must be "equirectangular" or "hemispheres", is {projection!r}')
    if projection and (directions or words or sun_body is not None):
        raise ValueError("map: shows all directions, lit from the upper left; leave out views, cameras and the sun")
    for name, direction in [("views", d) for d in directions] + [(sun_name, towards_sun)]:
        if not any(direction):
            raise ValueError(f"{name}: 0 0 0 is no direction; give another")
    albedo = None if colors is None else _arrays.rows(colors, "colors", length=len(arrays.vertices))
    return _synthesis.render(
        arrays.vertices,
        arrays.faces,
        arrays.normals,
        albedo,
        directions,
        words,
        projection,
        towards_sun,
        sun_body is not None,
        _arrays.text(reflectance, "reflectance"),
        _arrays.number(ambient, "ambient", 0.0, 10.0),
        _arrays.flag(transparent, "transparent"),
        _arrays.integer(width, "width", 16, 16384),
        _arrays.integer(height, "height", 16, 16384),
        _options.seed(seed),
        _options.threads(threads),
        progress,
    )
