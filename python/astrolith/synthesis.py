"""Recipes to fields, meshes, textures and pictures, and descriptions of shapes.

This module and its extension link no library of the fits: nothing of it is under the GPL.
"""

from __future__ import annotations

import dataclasses
from typing import Any, Callable, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _synthesis
from astrolith._mesh import Mesh, MeshLike, arrays_of, read_mesh, write_mesh
from astrolith._recipe import Recipe, RecipeLike, Record, json_of, records

__all__ = [
    "Description",
    "Field",
    "Mesh",
    "Recipe",
    "Texture",
    "Variation",
    "compare",
    "describe",
    "mesh",
    "read_mesh",
    "render",
    "texture",
    "vary",
    "write_mesh",
]

__version__: str = _synthesis.version().split(" ")[0]

Progress = Optional[Callable[[float, str], Any]]
"""Called from the calling thread with the share done in [0, 1] and a few words. Returning False stops the work."""

_LARGEST_SEED = 2**53 - 1


def _seed(seed: Any) -> int:
    return _arrays.integer(seed, "seed", 0, _LARGEST_SEED)


def _threads(threads: Any) -> int:
    return _arrays.integer(threads, "threads", 0, 1024)


def _seeded(recipe: RecipeLike, seed: Optional[int]) -> tuple[str, str]:
    """The recipe's text, with another seed where one is given, and its name in messages."""
    json, name = json_of(recipe)
    if seed is None:
        return json, name
    fields = records(json)
    fields["seed"] = _seed(seed)
    return json_of(fields)[0], name


class Field:
    """The field F of a recipe: positive inside, about a distance near the surface, whose F = 0 is the surface.

    Parameters
    ----------
    recipe
        A recipe with a body.

    Raises
    ------
    ValueError
        The recipe breaks a rule, or has no body.

    Notes
    -----
    Layers too fine for float coordinates of the body's frame are left out (:attr:`left_out`); a ``patch`` of
    :func:`mesh` has them.
    """

    def __init__(self, recipe: RecipeLike) -> None:
        json, name = json_of(recipe)
        self._field = _synthesis.Field(json, name)

    def value(self, points: npt.ArrayLike, *, threads: int = 0, progress: Progress = None) -> npt.NDArray[np.float64]:
        """Evaluate F, in length units.

        Parameters
        ----------
        points
            (n, 3) float64 or float32 positions in the body-fixed frame. float64 is read in place.
        threads
            Threads to use; 0: all. They do not change the result.

        Returns
        -------
        ndarray
            (n) float64.

        Raises
        ------
        ValueError
            `points` has another shape or type, or a number that is not finite.
        """
        return self._field.value(_arrays.rows(points, "points", empty=True), _threads(threads), progress)

    def gradient(self, points: npt.ArrayLike, *, threads: int = 0, progress: Progress = None) -> npt.NDArray[np.float64]:
        """Evaluate the gradient of F, (n, 3) float64 without a unit; it points inwards. As :meth:`value` otherwise."""
        return self._field.gradient(_arrays.rows(points, "points", empty=True), _threads(threads), progress)

    def inside(self, points: npt.ArrayLike, *, threads: int = 0, progress: Progress = None) -> npt.NDArray[np.bool_]:
        """Return (n) bool: whether F > 0. As :meth:`value` otherwise."""
        return self._field.inside(_arrays.rows(points, "points", empty=True), _threads(threads), progress)

    @property
    def bounds(self) -> npt.NDArray[np.float64]:
        """(2, 3) float64: the lower and the upper corner of a box that holds the whole surface, length units."""
        return np.array(self._field.bounds())

    @property
    def gradient_step(self) -> float:
        """The step of the central differences of :meth:`gradient`, length units."""
        return self._field.gradient_step()

    @property
    def left_out(self) -> list[tuple[int, float, float]]:
        """What float coordinates cannot resolve: layer (-1: the body's warp), share of variance, finest length."""
        return self._field.left_out()


def _region(patch: Optional[Sequence[float]], tile: Union[None, str, Sequence[int]]) -> tuple[Any, Any]:
    if patch is not None and tile is not None:
        raise ValueError("tile: excludes patch; leave one of them out")
    if patch is not None:
        return _arrays.vector(patch, "patch", 4), None
    if tile is None:
        return None, None
    parts = tile.split("/") if isinstance(tile, str) else list(tile)
    try:
        number, count = (int(part) for part in parts)
    except (TypeError, ValueError):
        raise ValueError(f"tile: {tile!r} is no tile; give (I, N) with I from 1 to N, such as (3, 16)") from None
    return None, (_arrays.integer(number, "tile", 1, 2**31 - 1), _arrays.integer(count, "tile", 1, 2**31 - 1))


def mesh(
    recipe: RecipeLike,
    *,
    resolution: Optional[int] = None,
    triangles: Optional[float] = None,
    patch: Optional[Sequence[float]] = None,
    tile: Union[None, str, Sequence[int]] = None,
    seed: Optional[int] = None,
    min_component: float = 0.0,
    labels: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Mesh:
    """Mesh the surface of a recipe's body: closed and 2-manifold, but for the cuts of patches and tiles.

    Parameters
    ----------
    recipe
        A recipe with a body, a dictionary or a file.
    resolution
        Cells along the longest side of the body, or of the patch; 256 unless `triangles` is given.
    triangles
        Choose the resolution that gives about this many triangles, 100 to 1e10.
    patch
        (x, y, z, side): only what this cube holds of the surface. Vertices are relative to its centre.
    tile
        (I, N) or "I/N": only the I-th of N slabs along z. Tiles fit without cracks.
    seed
        Replaces the recipe's seed.
    min_component
        Leave out pieces and cavities of less volume than this share of the largest piece's; 0: all stay.
    labels
        Whether the mesh gets labels and elevations.
    threads
        Threads to use; 0: all. They do not change the result.
    progress
        Called with the share done and a few words.

    Returns
    -------
    Mesh
        float32 vertices and normals, uint32 faces.

    Raises
    ------
    ValueError
        The recipe or an argument is wrong, or there is no surface in the region.
    RuntimeError
        The mesh is no closed manifold, or `progress` returned False.
    KeyboardInterrupt
        Ctrl-C was pressed; it is raised within a second.
    """
    if resolution is not None and triangles is not None:
        raise ValueError("triangles: excludes resolution; leave one of them out")
    cells = 256 if resolution is None else _arrays.integer(resolution, "resolution", 4, 8192)
    count = 0.0 if triangles is None else _arrays.number(triangles, "triangles", 100.0, 1e10)
    cube, slab = _region(patch, tile)
    json, name = _seeded(recipe, seed)
    fields = records(json)
    if fields.get("erosion") is not None and (cube is not None or slab is not None or labels):
        culprit = "labels" if labels else "patch" if cube is not None else "tile"
        raise ValueError(f"{name}: erosion: is of the whole mesh; leave out {culprit}, or take erosion out of the recipe")
    if min_component and (cube is not None or slab is not None):
        raise ValueError("min_component: the size of a piece that is cut is not known; leave out tile and patch")
    made = _synthesis.mesh(
        json,
        name,
        cells,
        count,
        cube,
        slab,
        _arrays.number(min_component, "min_component", 0.0, 1.0),
        bool(labels),
        _threads(threads),
        progress,
    )
    figures = Record(made["figures"])
    return Mesh(
        made["vertices"],
        made["faces"],
        made["normals"],
        made.get("labels"),
        made.get("elevations"),
        length_unit=fields["length_unit"] if "length_unit" in fields else "km",
        frame=fields["frame"] if "frame" in fields else "",
        comment="made by synth " + _synthesis.version(),
        origin=figures.get("origin"),
        legend=made.get("legend", []),
        figures=figures,
    )


@dataclasses.dataclass(eq=False)
class Texture:
    """A texture of :func:`texture`.

    Attributes
    ----------
    values
        (height, width) float32 heights, or (height, width, 3) float32 colours, full scale 1, not clamped.
    content
        "height" or "color".
    height_unit
        The unit of heights: the recipe's, or "standard deviations" where the layer states no height.
    height_rms
        The standard deviation of the heights.
    """

    values: npt.NDArray[np.float32]
    content: str
    height_unit: str = ""
    height_rms: float = 0.0


def texture(
    recipe: RecipeLike,
    width: int,
    height: int,
    *,
    content: Optional[str] = None,
    tileable: bool = False,
    seed: Optional[int] = None,
    threads: int = 0,
    progress: Progress = None,
) -> Texture:
    """Draw the Gabor layers of a recipe on a plane, as ``synth --texture`` does into a .tif.

    Parameters
    ----------
    width, height
        Pixels, 1 to 16384.
    content
        "height": the heights of the first Gabor layer; "color": the colours of all that have one. None: colours
        where layers have them.
    tileable
        Whether the texture repeats in both directions without a seam.

    Raises
    ------
    ValueError
        The recipe has no such layer, or the texture is too small to repeat.
    """
    json, name = _seeded(recipe, seed)
    word = "" if content is None else _arrays.choice(content, "content", ("height", "color"))
    values, rms, has_height = _synthesis.texture(
        json,
        name,
        _arrays.integer(width, "width", 1, 16384),
        _arrays.integer(height, "height", 1, 16384),
        word,
        bool(tileable),
        _threads(threads),
        progress,
    )
    if values.ndim == 3:
        return Texture(values, "color")
    unit = records(json).get("length_unit", "km") if has_height else "standard deviations"
    return Texture(values, "height", unit, rms)


@dataclasses.dataclass(eq=False)
class Description:
    """The histogram of a shape, which moving, turning and scaling do not change.

    Attributes
    ----------
    histogram
        float64 frequencies with one axis a feature, (bins, ...): what ``describe`` writes.
    points, pairs
        Number of samples and of pairs of them.
    max_distance
        The largest distance of two samples, in the unit of the vertices.
    remarks
        What was left out, one line each.
    """

    histogram: npt.NDArray[np.float64]
    points: int
    pairs: int
    max_distance: float
    vertices_left_out: int
    undefined_curvatures: int
    remarks: list[str]


_FEATURES = ("ahd", "wahl")


def describe(
    mesh: MeshLike,
    *,
    features: str = "ahd",
    bins: int = 5,
    points: int = 10000,
    seed: int = 1,
    threads: int = 0,
    progress: Progress = None,
) -> Description:
    """Describe a shape by the features of pairs of its surface points.

    Parameters
    ----------
    mesh
        A mesh; vertices with normals and without faces will do.
    features
        "wahl": the four features of a pair; "ahd": also curvature and normal perturbation.
    bins
        Bins of each axis, 2 to 10.
    points
        Samples of the surface, 2 to 2**24; the time grows with their square.

    Raises
    ------
    ValueError
        The mesh has no area, or an argument is out of range.
    """
    arrays = arrays_of(mesh, "mesh", points=True)
    bins = _arrays.integer(bins, "bins", 2, 10)
    made = _synthesis.describe(
        arrays.name,
        arrays.vertices,
        arrays.faces,
        arrays.normals,
        _arrays.choice(features, "features", _FEATURES),
        bins,
        _arrays.integer(points, "points", 2, 2**24),
        _seed(seed),
        _threads(threads),
        progress,
    )
    histogram = made.pop("frequencies").reshape((bins,) * made.pop("axes"))
    return Description(histogram, **made)


def compare(
    a: MeshLike,
    b: MeshLike,
    *,
    features: str = "ahd",
    bins: int = 5,
    points: int = 10000,
    samples: int = 100000,
    floor: bool = False,
    seed: int = 1,
    threads: int = 0,
    progress: Progress = None,
) -> Record:
    """Measure how alike two meshes are, and how far apart their surfaces lie as they stand.

    Parameters
    ----------
    samples
        Points of each surface for the distances between the surfaces, 100 to 10**7.
    floor
        Whether the similarities of two samplings of `a` and of `b` are measured, too.

    Returns
    -------
    Record
        The figures of ``compare``: similarity, l2, chi_square, jensen_shannon, earth_movers; mean_distance,
        p99_distance and max_distance as fractions of the diagonal of a's box; in_units_of_the_files.

    Raises
    ------
    ValueError
        A mesh has no area, or an argument is out of range.
    """
    of_a, of_b = arrays_of(a, "a"), arrays_of(b, "b")
    figures: Record = records(
        _synthesis.compare(
            of_a.name,
            of_a.vertices,
            of_a.faces,
            of_b.name,
            of_b.vertices,
            of_b.faces,
            _arrays.choice(features, "features", _FEATURES),
            _arrays.integer(bins, "bins", 2, 10),
            _arrays.integer(points, "points", 2, 2**24),
            _arrays.integer(samples, "samples", 100, 10**7),
            bool(floor),
            _seed(seed),
            _threads(threads),
            progress,
        )
    )
    return figures


@dataclasses.dataclass(eq=False)
class Variation:
    """Another body of the same kind, with its measured similarity, strength (0 to 1), noise ("new" or "kept"), and
    mean and largest distance from the recipe's own body as fractions of the diagonal."""

    recipe: Recipe
    similarity: float
    strength: float
    noise: str
    mean_distance: float
    max_distance: float


def vary(
    recipe: RecipeLike,
    delta: float,
    *,
    seed: int = 1,
    target: Optional[MeshLike] = None,
    threads: int = 0,
    progress: Progress = None,
) -> Variation:
    """Find another body of the same kind, as ``synth --vary`` does.

    Parameters
    ----------
    delta
        The similarity is at least 1 - delta, 0.001 to 1.
    seed
        The number of the variation.
    target
        The mesh that the body is to be like; None: the recipe's own body.

    Raises
    ------
    ValueError
        No variation will do; the message states the largest similarity that can be asked for.
    """
    json, name = json_of(recipe)
    if records(json).get("body") is None:
        raise ValueError(f"{name}: body: absent; lay its layers on a body with Recipe.laid_on")
    like = None if target is None else arrays_of(target, "target")
    varied, figures = _synthesis.vary(
        json,
        name,
        _arrays.number(delta, "delta", 1e-3, 1.0),
        _seed(seed),
        None if like is None else like.vertices,
        None if like is None else like.faces,
        _threads(threads),
        progress,
    )
    return Variation(Recipe(records(varied)), **records(figures))


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
        Directions from the body to the viewer, one tile each; empty: +x, +y, +z and obliquely.
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
        _seed(seed),
        _threads(threads),
        progress,
    )
