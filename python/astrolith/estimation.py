"""Fits: shapes to recipes of metaballs and noise, photos to layers of Gabor noise, meshes to classes.

This module's extension links FFTW (GPL-2.0-or-later) and CGAL (GPL-3.0-or-later): whoever passes on a program
together with it does so under the GPL. ``astrolith.synthesis`` alone is free of it.
"""

from __future__ import annotations

import dataclasses
import os
from typing import Optional, Union

import numpy.typing as npt

from astrolith import _arrays, _estimation, _options
from astrolith._classes import classify, train_classifier
from astrolith._mesh import Mesh, MeshLike, arrays_of, stated_unit, unit_of
from astrolith._options import Progress
from astrolith._packing import Packing, pack_spheres
from astrolith._recipe import PathLike, Recipe, Record, records
from astrolith._texture_fit import TextureFit, fit_texture

__all__ = ["Packing", "ShapeFit", "TextureFit", "classify", "fit_shape", "fit_texture", "pack_spheres", "repair_mesh", "train_classifier"]


@dataclasses.dataclass(eq=False)
class ShapeFit:
    """A fitted shape: its recipe, and the figures of ``fit_shape --summary``.

    Distances in `figures` are fractions of the diagonal of the target's bounding box: mean_distance, p99_distance,
    max_distance. similarity is that of ``compare``; more than similarity_floor cannot be expected.
    """

    recipe: Recipe
    figures: Record

    def __repr__(self) -> str:
        spheres = len(self.recipe.body.spheres) + len(self.recipe.body.get("subtract", []))
        return f"<astrolith.ShapeFit: {spheres} metaballs, mean distance {self.figures.mean_distance:.4g} of the diagonal>"


def _most_spheres(spheres: Optional[int], size: Optional[int]) -> int:
    """The largest number of metaballs; 0: as many as follow from the size of the recipe."""
    if spheres is not None:
        return _arrays.integer(spheres, "spheres", 1, 10000)
    return 200 if size is None else 0


_OPTIMIZERS = ("pso", "crs2", "isres", "esch", "sbplx")


def fit_shape(
    mesh: Union[MeshLike, npt.ArrayLike],
    faces: Optional[npt.ArrayLike] = None,
    *,
    spheres: Optional[int] = None,
    bytes: Optional[int] = None,
    subtract: Optional[float] = None,
    points: Optional[int] = None,
    tolerance: Optional[float] = None,
    optimizer: Optional[str] = None,
    population: Optional[int] = None,
    generations: Optional[int] = None,
    base_only: bool = False,
    details: Optional[PathLike] = None,
    micro: Optional[PathLike] = None,
    mm_per_px: Optional[float] = None,
    micro_height: Optional[float] = None,
    device: Optional[str] = None,
    time_limit: Optional[float] = None,
    unit: Optional[str] = None,
    seed: Optional[int] = None,
    checkpoint: Optional[PathLike] = None,
    report: Optional[PathLike] = None,
    strict: bool = False,
    wrap: bool = False,
    all_parts: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> ShapeFit:
    """Fit metaballs and details to the mesh of a body, as the program ``fit_shape`` does.

    Parameters
    ----------
    mesh
        The name of a file, a mesh, or (n, 3) float vertices; then `faces` are (m, 3) indices. The recipe of a file
        states the file's name and hash, and has the bytes that the program writes.
    spheres
        Largest number of metaballs, 1 to 10000; default 200, or what follows from `bytes`.
    bytes
        Round the numbers of the metaballs so that ``recipe.write("name.astro")`` takes at most so many bytes, 100 to
        1000000, for the least error. The recipe then states no provenance. Needs `base_only`, and takes no `micro`.
    subtract
        Largest share of the metaballs that may be subtractive, 0 to 0.9; default 0.5.
    points
        Samples of the surface that the refinement sees; default 120 a metaball.
    tolerance
        No more metaballs once the mean distance is below this fraction of the diagonal.
    optimizer
        "pso" (default), "crs2", "isres", "esch" or "sbplx".
    population, generations
        Of the search for details: default 20 and 100.
    base_only
        Metaballs alone, without details.
    details
        "relief" (default): the measured surface itself, as heights over the metaballs. "thesis" (default with
        `generations`): the search for the 34 parameters of three noises. Or the layers of this recipe's file, scaled by
        the ratio of the two bodies' sizes.
    micro
        The finest detail: the file of a recipe of ``fit_gabor``, whose layers are added; or "auto": instead of the
        search, a Gabor layer learnt from what the metaballs leave of the mesh.
    mm_per_px, micro_height
        Size of a pixel of the photo of `micro`, and root mean square height of its first layer, both in mm.
    device
        What computes the search: "auto" (default; the GPU where there is one), "cpu" or "cuda".
    time_limit
        Seconds after which the best so far is returned, measured figures included; default 0, none. The result then
        depends on the machine.
    unit
        The unit of the vertices, "km" or "m"; default: what a Mesh or a file states, else "km".
    seed
        0 to 2**53 - 1; default 1.
    checkpoint
        Keep the progress in this file; where it exists, go on from there.
    report
        A folder for a page, index.html, with target and fit to turn, and pictures of both.
    strict, wrap, all_parts
        As of the program: refuse a mesh that is not closed; wrap one that a repair cannot close; take all bodies of a
        mesh that holds several. figures.repair and figures.remarks say what was done.
    progress
        Called with the share done of a stage and a few words. Returning False ends the fit with its best so far.

    Returns
    -------
    ShapeFit

    Raises
    ------
    ValueError
        The mesh is flat, or open, not manifold or crossing beyond repair; an argument is out of range; the checkpoint
        belongs to another fit.
    KeyboardInterrupt
        Ctrl-C was pressed. It is raised within a second; the checkpoint is whole then.
    """
    file = os.fspath(mesh) if isinstance(mesh, (str, os.PathLike)) else ""
    arrays = None
    if not file:
        arrays = arrays_of(mesh if faces is None else (mesh, faces), "mesh")
    given = _options.given(
        spheres=spheres, bytes=bytes, subtract=subtract, points=points, tolerance=tolerance, optimizer=optimizer,
        population=population, generations=generations, base_only=base_only, unit=unit, seed=seed,
        details=_options.name_of(details), micro=_options.name_of(micro), mm_per_px=mm_per_px, micro_height=micro_height, device=device,
        time_limit=time_limit, strict=strict, wrap=wrap, all_parts=all_parts,
    )  # fmt: skip
    if details is not None and base_only:
        raise ValueError("details: base_only leaves them out; leave out one of both")
    if details not in (None, "thesis") and generations is not None:
        raise ValueError("generations: are those of details=\"thesis\"; leave out one of both")
    if bytes is not None and (not base_only or micro is not None):
        raise ValueError("bytes: are those of a bare body; pass base_only=True and leave out micro")
    if micro is None and (mm_per_px is not None or micro_height is not None):
        raise ValueError("micro: is missing; mm_per_px and micro_height are of its layers")
    json, figures = _estimation.fit_shape(
        file or "mesh",
        None if arrays is None else arrays.vertices,
        None if arrays is None else arrays.faces,
        _most_spheres(spheres, bytes),
        0 if bytes is None else _arrays.integer(bytes, "bytes", 100, 1000000),
        0.5 if subtract is None else _arrays.number(subtract, "subtract", 0.0, 0.9),
        0 if points is None else _arrays.integer(points, "points", 0, 10**7),
        0.0 if tolerance is None else _arrays.number(tolerance, "tolerance", 0.0, 1e18),
        _arrays.choice(optimizer or "pso", "optimizer", _OPTIMIZERS),
        20 if population is None else _arrays.integer(population, "population", 1, 10000),
        100 if generations is None else _arrays.integer(generations, "generations", 1, 100000),
        bool(base_only),
        _options.name_of(details) or ("relief" if generations is None else "thesis"),
        _options.name_of(micro) or "",
        0.0 if mm_per_px is None else _arrays.number(mm_per_px, "mm_per_px", 1e-12, 1e12),
        0.0 if micro_height is None else _arrays.number(micro_height, "micro_height", 1e-12, 1e12),
        _arrays.choice(device or "auto", "device", ("auto", "cpu", "cuda")),
        0.0 if time_limit is None else _arrays.number(time_limit, "time_limit", 0.0, 1e9),
        unit_of(mesh, unit, ("km", "m"), "mesh"),
        _options.name_of(checkpoint) or "",
        _options.name_of(report) or "",
        bool(strict),
        bool(wrap),
        bool(all_parts),
        given,
        1 if seed is None else _options.seed(seed),
        _options.threads(threads),
        progress,
    )
    return ShapeFit(Recipe(records(json)), records(figures))


def repair_mesh(
    mesh: Union[MeshLike, npt.ArrayLike],
    faces: Optional[npt.ArrayLike] = None,
    *,
    wrap: bool = False,
    all_parts: bool = False,
    progress: Progress = None,
) -> tuple[Mesh, Record]:
    """Close a mesh that is open, not manifold or wound both ways, as ``gravity`` and ``fit_shape`` do.

    A mesh that is closed, of one body, comes back as it is.

    Parameters
    ----------
    mesh
        The name of a file, a mesh, or (n, 3) float vertices; then `faces` are (m, 3) indices.
    wrap
        Where a repair moves the surface by more than 1 % of the diagonal, fills more than 5 % of it, or fails: wrap the
        mesh at 1/200 of the diagonal.
    all_parts
        Keep all bodies of a mesh that holds several; otherwise the largest.

    Returns
    -------
    The mesh, and the fields repair.* of ``fit_shape --summary`` with a sentence, `words`.

    Raises
    ------
    ValueError
        The mesh cannot be repaired.

    Examples
    --------
    >>> import astrolith
    >>> ball = {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0, 0, 0, 1]]}
    >>> body = astrolith.mesh({"format_version": 1, "length_unit": "km", "body": ball}, resolution=24)
    >>> closed, figures = astrolith.repair_mesh(body.vertices, body.faces[5:])
    >>> figures.holes >= 1, len(closed.faces) == len(body.faces)
    (True, True)
    """
    arrays = arrays_of(mesh if faces is None else (mesh, faces), "mesh")
    unit = stated_unit(mesh)
    vertices, triangles, figures = _estimation.repair_mesh(
        arrays.name, arrays.vertices, arrays.faces, bool(wrap), bool(all_parts), unit, progress
    )
    return Mesh(vertices, triangles, length_unit=unit), records(figures)
