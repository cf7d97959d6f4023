"""Bodies filled with spheres."""

from __future__ import annotations

import dataclasses
from typing import Optional, Union

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _estimation, _jobs, _options
from astrolith._arrays import PathLike
from astrolith._mesh import MeshLike
from astrolith._options import Progress


@dataclasses.dataclass(eq=False)
class Packing:
    """Spheres that fill a body without overlap, the largest first.

    Attributes
    ----------
    centers
        (n, 3) float64 positions in `length_unit`, in the frame of the mesh.
    radii
        (n) float64 in `length_unit`.
    masses
        (n) float64 kg, or None without a density. The spheres share the mass of the whole body in proportion to
        their volumes, so that the mascons (point masses at the centres) weigh as much as the body.
    filling_rate
        The volume of the spheres over the volume of the body.
    stopped_early
        Whether `progress` asked to stop; the spheres are the ones placed so far.
    """

    centers: npt.NDArray[np.float64]
    radii: npt.NDArray[np.float64]
    masses: Optional[npt.NDArray[np.float64]]
    filling_rate: float
    length_unit: str
    stopped_early: bool

    def __repr__(self) -> str:
        return f"<astrolith.Packing: {len(self.radii)} spheres fill {100 * self.filling_rate:.2f} % of the volume>"


def pack_spheres(
    mesh: Union[MeshLike, npt.ArrayLike],
    faces: Optional[npt.ArrayLike] = None,
    *,
    spheres: int = 200,
    density: Optional[float] = None,
    unit: Optional[str] = None,
    output: Optional[PathLike] = None,
    strict: bool = False,
    wrap: bool = False,
    all_parts: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Packing:
    """Fill the mesh of a body with spheres that do not overlap, as ``fit_shape --packing-only`` does.

    Parameters
    ----------
    mesh
        The name of a file, a mesh, or (n, 3) float vertices; then `faces` are (m, 3) indices.
    spheres
        Largest number of spheres, 1 to 10000.
    density
        Of the body in kg/m3, above 0: the spheres then have masses.
    unit
        The unit of the vertices, "km" or "m"; default: what a Mesh or a file states, else "km".
    output
        Write the table of ``fit_shape --packing-only`` to this file (.csv). The table of a file's mesh has the bytes
        that the program writes.
    strict, wrap, all_parts
        As of ``fit_shape``: refuse a mesh that is not closed; wrap one that a repair cannot close; take all bodies of a
        mesh that holds several.
    progress
        Called with the share done and a few words. Returning False ends the packing with the spheres so far.

    Returns
    -------
    Packing

    Raises
    ------
    ValueError
        The mesh is flat, or open, not manifold or crossing beyond repair; an argument is out of range; the table cannot
        be written.

    Examples
    --------
    >>> import astrolith
    >>> ball = {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0, 0, 0, 1]]}
    >>> body = astrolith.mesh({"format_version": 1, "length_unit": "m", "body": ball}, resolution=24)
    >>> packing = astrolith.pack_spheres(body, spheres=8, density=2000)
    >>> packing.centers.shape, packing.length_unit, 0.5 < packing.filling_rate < 1
    ((8, 3), 'm', True)
    """
    given = _jobs.given_mesh(mesh, faces, unit)
    options = {"spheres": spheres, "density": density, "unit": unit, "output": output, "strict": strict, "wrap": wrap, "all_parts": all_parts, "packing_only": True}  # fmt: skip
    arguments = _jobs.words("pack_spheres", _estimation.options_of("fit_shape"), options)
    if given is None:
        arguments.append(("mesh", [_arrays.file_name(mesh, "mesh")]))
    _, figures, rows, masses, stopped = _estimation.fit_shape(given, arguments, _options.threads(threads), progress)
    weights = np.array(masses) if density is not None else None
    centers, radii = np.ascontiguousarray(rows[:, :3]), np.ascontiguousarray(rows[:, 3])
    packing = _jobs.figures_of(figures)
    return Packing(centers, radii, weights, packing.filling_rate, packing.length_unit, stopped)
