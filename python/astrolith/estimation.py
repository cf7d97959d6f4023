"""Fits: shapes to recipes of metaballs and noise, photos to layers of Gabor noise, meshes to classes.

This module's extension links FFTW (GPL-2.0-or-later) and CGAL (GPL-3.0-or-later): whoever passes on a program
together with it does so under the GPL. ``astrolith.synthesis`` alone is free of it.
"""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Optional, Union, cast

import numpy as np
import numpy.typing as npt

try:
    from astrolith import _estimation
except ModuleNotFoundError as error:
    raise ModuleNotFoundError("astrolith: the fits are not installed; pip install 'astrolith[fit]'", name=error.name) from None
from astrolith import _arrays, _jobs, _options
from astrolith._classes import classify, train_classifier
from astrolith._mesh import Arrays, Mesh, MeshLike, arrays_of, stated_unit
from astrolith._options import Progress
from astrolith._packing import Packing, pack_spheres
from astrolith._recipe import Recipe, Record, records
from astrolith._texture_fit import TextureFit, fit_texture

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from astrolith._fit_options import FitShapeOptions

__all__ = ["Packing", "ShapeFit", "TextureFit", "classify", "fit_shape", "fit_texture", "pack_spheres", "repair_mesh", "train_classifier"]


@dataclasses.dataclass(eq=False)
class ShapeFit:
    """A fitted shape: its recipe, and the figures of ``fit_shape --summary``.

    Distances in `figures` are fractions of the diagonal of the target's bounding box: mean_distance, p99_distance,
    max_distance. similarity is what ``compare`` states; more than similarity_floor cannot be expected.
    """

    recipe: Recipe
    figures: Record

    def __repr__(self) -> str:
        spheres = len(self.recipe.body.spheres) + len(self.recipe.body.get("subtract", []))
        distance = self.figures.get("mean_distance")
        words = "not measured" if distance is None else f"mean distance {distance:.4g} of the diagonal"
        return f"<astrolith.ShapeFit: {spheres} metaballs, {words}>"


_OPTIONS = _estimation.options_of("fit_shape")


def fit_shape(
    mesh: Union[MeshLike, npt.ArrayLike],
    faces: Optional[npt.ArrayLike] = None,
    *,
    threads: int = 0,
    progress: Progress = None,
    **options: Unpack[FitShapeOptions],
) -> ShapeFit:
    """Fit metaballs and details to the mesh of a body, as the program ``fit_shape`` does.

    Parameters
    ----------
    mesh
        The name of a file, a mesh, or (n, 3) float vertices; then `faces` are (m, 3) indices. The recipe of a file
        states the file's name and hash, and has the bytes that the program writes.
    threads
        To use; 0: all.
    progress
        Called with the share done of a stage and a few words. Returning False ends the fit with its best so far, which
        is not measured then.
    {options}

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
    arguments = _jobs.words("fit_shape", _OPTIONS, options)
    given = _jobs.given_mesh(mesh, faces, options.get("unit"))
    if given is None:
        arguments.append(("mesh", [_arrays.file_name(mesh, "mesh")]))
    json, figures, *_ = _estimation.fit_shape(given, arguments, _options.threads(threads), progress)
    return ShapeFit(Recipe(records(json)), _jobs.figures_of(figures))


_jobs.document(fit_shape, _OPTIONS)


def repair_mesh(
    mesh: Union[MeshLike, npt.ArrayLike],
    faces: Optional[npt.ArrayLike] = None,
    *,
    wrap: bool = False,
    fill_unseen: bool = False,
    union: bool = False,
    all_parts: bool = False,
    progress: Progress = None,
) -> tuple[Mesh, Record]:
    """Close a mesh that is open, not manifold or wound both ways, as ``gravity`` and ``fit_shape`` do.

    With `wrap` also a cloud of points becomes a body: a Poisson surface that averages their noise.

    A mesh that is closed, of one body, comes back as it is.

    Parameters
    ----------
    mesh
        The name of a file, a mesh, or (n, 3) float vertices; then `faces` are (m, 3) indices, or absent of points.
    wrap
        Where a repair moves the surface by more than 1 % of the diagonal, fills more than 5 % of it, or fails: wrap the
        mesh at 1/200 of the diagonal.
    fill_unseen
        Take the surface through points also where they saw less than two thirds of the ground.
    union
        Make one surface of parts that overlap or lie inside one another. Cavities stay.
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
    no_faces = np.zeros((0, 3), np.uint32)
    if wrap and _arrays.is_file_name(mesh):
        arrays = Arrays(_arrays.file_name(mesh, "mesh"), np.zeros((0, 3)), no_faces, None)
    elif wrap and faces is None and isinstance(mesh, np.ndarray):
        arrays = Arrays("mesh", _arrays.rows(mesh, "mesh"), no_faces, None)
    else:
        arrays = arrays_of(cast(MeshLike, mesh) if faces is None else (mesh, faces), "mesh")
    unit = stated_unit(mesh)
    vertices, triangles, figures = _estimation.repair_mesh(
        arrays.name, arrays.vertices, arrays.faces, bool(wrap), bool(fill_unseen), bool(union), bool(all_parts), unit, progress
    )
    return Mesh(vertices, triangles, length_unit=unit), records(figures)
