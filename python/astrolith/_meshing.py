"""The mesh of a recipe."""

from __future__ import annotations

from typing import Any, Optional, Sequence, Union

from astrolith import _arrays, _options, _synthesis
from astrolith._mesh import Mesh
from astrolith._options import Progress
from astrolith._recipe import RecipeLike, Record, change_reliefs, json_of, records

_MOST_FINER_LEVELS = 6
_FORMATS = tuple(row["extension"] for row in _synthesis.mesh_formats() if row["written"])


def _region(patch: Optional[Sequence[float]], tile: Union[None, str, Sequence[int]]) -> tuple[Any, Any]:
    if patch is not None and tile is not None:
        raise ValueError("tile: excludes patch; leave one of them out")
    if patch is not None:
        return _arrays.vector(patch, "patch", 4), None
    if tile is None:
        return None, None
    parts: Sequence[Any] = tile
    if isinstance(tile, str):
        parts = tile.split("/")
    try:
        number, count = (int(part) for part in parts)
    except (TypeError, ValueError):
        raise ValueError(f"tile: {_arrays.shown(tile)} is no tile; give (I, N) with I from 1 to N, such as (3, 16)") from None
    return None, (_arrays.integer(number, "tile", 1, 2**31 - 1), _arrays.integer(count, "tile", 1, 2**31 - 1))


def _mesh_arguments(
    recipe: RecipeLike,
    resolution: Optional[int],
    triangles: Optional[float],
    patch: Optional[Sequence[float]],
    aligned: bool,
    tile: Union[None, str, Sequence[int]],
    seed: Optional[int],
    min_component: float,
    labels: bool,
    even: bool,
    finer: Optional[int],
    fill_unseen: bool,
) -> tuple[str, str, int, float, Any, bool, Any, float, bool, bool]:
    """The checked arguments of the module's functions, of which the recipe's text and name come first."""
    if resolution is not None and triangles is not None:
        raise ValueError("triangles: excludes resolution; leave one of them out")
    cells = 256 if resolution is None else _arrays.integer(resolution, "resolution", 4, 8192)
    count = 0.0 if triangles is None else _arrays.number(triangles, "triangles", 100.0, 1e10)
    cube, slab = _region(patch, tile)
    aligned, labels = _arrays.flag(aligned, "aligned"), _arrays.flag(labels, "labels")
    if aligned and cube is None:
        raise ValueError("aligned: is of a patch; give patch as well")
    json, name = _options.seeded(recipe, seed)
    fields = records(json)
    of_reliefs: dict[str, Any] = {} if finer is None else {"finer": _arrays.integer(finer, "finer", 0, _MOST_FINER_LEVELS)}
    if _arrays.flag(fill_unseen, "fill_unseen"):
        of_reliefs["fill_unseen"] = True
    if of_reliefs:
        change_reliefs(fields, name, **of_reliefs)
        json = json_of(fields)[0]
    if fields.get("erosion") is not None and (cube is not None or slab is not None or labels):
        culprit = "labels" if labels else "patch" if cube is not None else "tile"
        raise ValueError(f"{name}: erosion: is of the whole mesh; leave out {culprit}, or take erosion out of the recipe")
    share = _arrays.number(min_component, "min_component", 0.0, 1.0)
    if share > 0.0 and (cube is not None or slab is not None):
        raise ValueError("min_component: the size of a piece that is cut is not known; leave out tile and patch")
    return json, name, cells, count, cube, aligned, slab, share, labels, _arrays.flag(even, "even")


def mesh(
    recipe: RecipeLike,
    *,
    resolution: Optional[int] = None,
    triangles: Optional[float] = None,
    patch: Optional[Sequence[float]] = None,
    aligned: bool = False,
    tile: Union[None, str, Sequence[int]] = None,
    seed: Optional[int] = None,
    min_component: float = 0.0,
    labels: bool = False,
    even: bool = False,
    finer: Optional[int] = None,
    fill_unseen: bool = False,
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
    aligned
        Turn the cube of the patch to its ground: one axis is the mean normal of the surface in it. `figures.patch_axes`
        states right, ahead and up; vertices still lie along the recipe's axes.
    tile
        (I, N) or "I/N": only the I-th of N slabs along z. Tiles fit without cracks.
    seed
        Replaces the recipe's seed.
    min_component
        Leave out pieces and cavities of less volume than this share of the largest piece's; 0: all stay.
    labels
        Whether the mesh gets labels and elevations.
    even
        Make the triangles more even: vertices move along the surface and back onto it, but for those at cuts.
        `figures.even` states quality and moves.
    finer
        Levels by which the recipe's relief goes on below the edges of the measured model, 0 to 6, each a quarter as large
        as the one before; None: those of the recipe.
    fill_unseen
        Whether ground that no camera saw, which the model has smooth, gets patches of the ground that was seen.
    threads
        Threads to use; 0: all. They do not change the result.
    progress
        Called with the share done and a few words.

    Returns
    -------
    Mesh
        float32 vertices and normals, uint32 faces, and uint8 colors where a layer of the recipe paints.

    Raises
    ------
    ValueError
        The recipe or an argument is wrong, or there is no surface in the region.
    RuntimeError
        The mesh is no closed manifold, or `progress` returned False.
    KeyboardInterrupt
        Ctrl-C was pressed; it is raised within a second.
    """
    arguments = _mesh_arguments(
        recipe, resolution, triangles, patch, aligned, tile, seed, min_component, labels, even, finer, fill_unseen
    )
    fields = records(arguments[0])
    made = _synthesis.mesh(*arguments, _options.threads(threads), progress)
    figures = Record(made["figures"])
    return Mesh(
        made["vertices"],
        made["faces"],
        made["normals"],
        made.get("labels"),
        made.get("elevations"),
        colors=made.get("colors"),
        length_unit=fields["length_unit"] if "length_unit" in fields else "km",
        frame=fields["frame"] if "frame" in fields else "",
        comment="made by synth " + _synthesis.version(),
        origin=figures.get("origin"),
        legend=made.get("legend", []),
        figures=figures,
    )


def predict(
    recipe: RecipeLike,
    *,
    resolution: Optional[int] = None,
    triangles: Optional[float] = None,
    patch: Optional[Sequence[float]] = None,
    aligned: bool = False,
    tile: Union[None, str, Sequence[int]] = None,
    seed: Optional[int] = None,
    min_component: float = 0.0,
    labels: bool = False,
    even: bool = False,
    finer: Optional[int] = None,
    fill_unseen: bool = False,
    format: str = ".ply",
    threads: int = 0,
) -> Record:
    """Predict what the program ``synth`` takes for a mesh, as ``synth --predict`` does.

    Parameters
    ----------
    recipe, resolution, triangles, patch, aligned, tile, seed, min_component, labels, even, finer, fill_unseen
        As `mesh` has them.
    format
        The extension of the file: one that is written, of :func:`mesh_formats`.
    threads
        Threads that make the mesh; 0: all.

    Returns
    -------
    Record
        resolution, triangles, file_bytes, peak_bytes (of this process, with what it holds already), seconds (on the
        clock, on cores that do nothing else) and processor_seconds (of all threads together). Most are within 30 %.

    Raises
    ------
    ValueError
        The recipe or an argument is wrong, or there is no surface in the region.
    """
    _arrays.choice(format, "format", _FORMATS)
    arguments = _mesh_arguments(
        recipe, resolution, triangles, patch, aligned, tile, seed, min_component, labels, even, finer, fill_unseen
    )
    return Record(_synthesis.predict(*arguments, format, _options.threads(threads)))
