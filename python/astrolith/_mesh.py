"""Triangle meshes: arrays with what is known about them."""

from __future__ import annotations

import dataclasses
import os
import sys
import warnings
from typing import Any, Mapping, Optional

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _synthesis
from astrolith._arrays import PathLike
from astrolith._recipe import Record
from astrolith._units import METRES, name_of

MeshLike = Any
"""A Mesh, anything with ``vertices`` and ``faces`` (trimesh has both), a pair of arrays, or the name of a file."""


@dataclasses.dataclass(eq=False)
class Mesh:
    """A triangle mesh.

    Attributes
    ----------
    vertices
        (n, 3) positions in `length_unit`: float32 from :func:`mesh`, float64 from :func:`read_mesh`.
    faces
        (m, 3) uint32 indices of vertices, counter-clockwise seen from outside. (0, 3) for points.
    normals
        (n, 3) outward unit vectors, or None.
    labels
        (n) int32: the layer that changed the surface most, 0 for the bare body, i + 1 for layer i; or None.
    elevations
        (n) float32 heights of all layers above the bare body in `length_unit`; or None.
    origin
        The place that vertices are relative to, in the recipe's frame; None: the frame's own origin.
    figures
        What ``synth --summary`` states: triangles, closed, genus, components, cell, layers_left_out and more.
    colors
        (n, 3) uint8 sRGB that the layers paint; or None.
    values
        Other numbers of the vertices by their names, (n) float64 each: those of ``synth --gravity``.
    """

    vertices: npt.NDArray[Any]
    faces: npt.NDArray[np.uint32]
    normals: Optional[npt.NDArray[Any]] = None
    labels: Optional[npt.NDArray[np.int32]] = None
    elevations: Optional[npt.NDArray[np.float32]] = None
    length_unit: str = ""
    frame: str = ""
    comment: str = ""
    origin: Optional[tuple[float, float, float]] = None
    legend: list[str] = dataclasses.field(default_factory=list)
    figures: Record = dataclasses.field(default_factory=Record)
    colors: Optional[npt.NDArray[np.uint8]] = None
    values: dict[str, npt.NDArray[np.float64]] = dataclasses.field(default_factory=dict)

    @property
    def whole_body(self) -> bool:
        """Whether the mesh is closed, as a patch is not."""
        return bool(self.figures.get("closed", False))

    def __repr__(self) -> str:
        unit = f", {self.length_unit}" if self.length_unit else ""
        return f"<astrolith.Mesh: {len(self.vertices)} vertices, {len(self.faces)} faces{unit}>"

    @property
    def area(self) -> float:
        """The area of the surface in square units."""
        return _synthesis.surface_area(*self._checked())

    @property
    def volume(self) -> float:
        """The volume inside in cubic units, negative where the faces are turned inside out.

        Raises
        ------
        ValueError
            The mesh is open, as a patch is, or its faces are wound both ways.
        """
        return _synthesis.volume(*self._checked())

    def _checked(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.uint32]]:
        arrays = arrays_of((self.vertices, self.faces), "mesh")
        return arrays.vertices, arrays.faces


@dataclasses.dataclass
class Arrays:
    """A mesh as the extension modules take it."""

    name: str
    vertices: npt.NDArray[np.float64]
    faces: npt.NDArray[np.uint32]
    normals: Optional[npt.NDArray[np.float64]]


def surface_of(mesh: MeshLike, name: str, *, points: bool = False) -> Arrays:
    """Checks a mesh that is measured, and winds it as the programs do.

    Vertices at equal places are merged where that closes borders, and faces are turned outwards; warns of both.
    """
    arrays = arrays_of(mesh, name, points=points)
    wound = _synthesis.wound_surface(arrays.vertices, arrays.faces)
    if wound is None:
        return arrays
    vertices, faces, words = wound
    _warn(f"{arrays.name}: {words}")
    return Arrays(arrays.name, vertices, faces, None)


def arrays_of(mesh: MeshLike, name: str, *, points: bool = False, local: bool = False) -> Arrays:
    """Checks a mesh. With `points`, vertices with normals and without faces will do.

    The origin of a whole body is added to its vertices unless they are to stay `local`.
    """
    if _arrays.is_file_name(mesh):
        file = _arrays.file_name(mesh, name)
        read = _synthesis.read_mesh(file, points)
        return Arrays(file, read["vertices"], read["faces"], read.get("normals"))
    normals: Any = None
    if isinstance(mesh, tuple) and len(mesh) == 2:
        vertices, faces = mesh
    elif hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        vertices, faces = mesh.vertices, mesh.faces
        if isinstance(mesh, Mesh):
            normals = mesh.normals
    elif isinstance(mesh, Mapping):
        raise ValueError(f"{name}: is a recipe, and must be a mesh; pass astrolith.mesh({name})")
    else:
        raise ValueError(
            f"{name}: must be a Mesh, a pair (vertices, faces), an object with both or a file, and is {type(mesh).__name__}"
        )
    checked = _arrays.rows(_plain(vertices), f"{name}.vertices")
    if isinstance(mesh, Mesh) and mesh.whole_body and mesh.origin is not None and not local:
        checked = checked + np.asarray(mesh.origin)
    faces = np.zeros((0, 3), np.uint32) if faces is None else _plain(faces)
    if normals is not None:
        normals = _arrays.rows(normals, f"{name}.normals", length=len(checked))
    no_faces = points and normals is not None
    return Arrays(name, checked, _arrays.faces_of(faces, f"{name}.faces", len(checked), empty=no_faces), normals)


def stated_unit(mesh: MeshLike) -> str:
    """The unit that a Mesh, a trimesh.Trimesh or a file states; "" where it states none."""
    if _arrays.is_file_name(mesh):
        return _synthesis.stated_length_unit(os.fsdecode(mesh))
    return mesh.length_unit if isinstance(mesh, Mesh) else name_of(getattr(mesh, "units", None))


def _warn(message: str) -> None:
    """Warns at the line outside of this package that called into it."""
    package, level, frame = os.path.dirname(__file__) + os.sep, 1, sys._getframe()
    while frame.f_back is not None and frame.f_code.co_filename.startswith(package):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, stacklevel=level)


def unit_of(mesh: MeshLike, unit: Optional[str], units: tuple[str, ...], name: str, otherwise: str = "km") -> str:
    """The unit of a mesh's vertices: the argument `unit`, else what the mesh states, else `otherwise`.

    Without `units` any unit will do. Warns where the mesh states another unit than the argument. `name` is that of the
    mesh's argument; messages name a file instead.
    """
    stated = stated_unit(mesh)
    named = os.fsdecode(mesh) if _arrays.is_file_name(mesh) else name
    if unit is not None:
        _arrays.choice(unit, "unit", units or tuple(METRES))
        if stated not in ("", unit):
            _warn(f"unit: {named} states {stated}; it is taken in {unit}, as the argument says")
        return unit
    if stated and units and stated not in units:
        raise ValueError(
            f"unit: is missing; {named} states {stated}, which is none of {', '.join(units)}; "
            "convert its lengths to one of these first, or pass unit where the statement is wrong"
        )
    return stated or otherwise


def pair_of(a: MeshLike, b: MeshLike, unit: str) -> tuple[Arrays, Arrays, str]:
    """Two meshes for a comparison, and the unit of the first, "" where it is unknown.

    The second is scaled to that unit. Warns where the units differ and the length of one is unknown. `unit` is "m" or
    "km" for both meshes, or "": what they state.
    """
    given = _arrays.choice(unit, "unit", ("", "m", "km")) or None
    of_a, of_b = surface_of(a, "a"), surface_of(b, "b")
    unit_of_a, unit_of_b = unit_of(a, given, (), "a", ""), unit_of(b, given, (), "b", "")
    if unit_of_a in METRES and unit_of_b in METRES:
        if unit_of_a != unit_of_b:
            of_b.vertices = of_b.vertices * (METRES[unit_of_b] / METRES[unit_of_a])
    elif "" not in (unit_of_a, unit_of_b) and unit_of_a != unit_of_b:
        _warn(f"{of_b.name}: is in {unit_of_b}, and {of_a.name} in {unit_of_a}; nothing was scaled")
    return of_a, of_b, unit_of_a


def _plain(array: Any) -> Any:
    """The array itself where it belongs to a class derived from ndarray, such as trimesh's."""
    return array.view(np.ndarray) if isinstance(array, np.ndarray) else array


def mesh_formats() -> list[Record]:
    """The formats of meshes.

    Each has its `name` and its `extension`, whether it is `read` and `written`, and what is written: the `unit` of
    length, `colors` of vertices, other `values` of vertices such as labels, and `texture_coordinates`.

    Examples
    --------
    >>> [row.extension for row in mesh_formats() if row.values]
    ['.ply']
    """
    return [Record(row) for row in _synthesis.mesh_formats()]


def read_mesh(file: PathLike, *, points: bool = False) -> Mesh:
    """Read a mesh of one of :func:`mesh_formats`.

    Parameters
    ----------
    file
        The file. Its content and its extension must agree on the format.
    points
        Whether a .ply of points with unit normals and without faces is welcome, too.

    Returns
    -------
    Mesh
        float64 vertices in the file's unit, which `length_unit` names where the file states it; with the labels and the
        elevations of ``synth --labels``.

    Raises
    ------
    ValueError
        The file is damaged or of another kind. The message names the place in the file.
    FileNotFoundError
        There is no such file. It is a ValueError, too.
    """
    read = _synthesis.read_mesh(_arrays.file_name(file, "file"), _arrays.flag(points, "points"))
    return Mesh(
        read["vertices"],
        read["faces"],
        read.get("normals"),
        read.get("labels"),
        read.get("elevations"),
        length_unit=stated_unit(file),
    )


def write_mesh(mesh: MeshLike, file: PathLike, uv: bool = False) -> None:
    """Write a mesh in one of :func:`mesh_formats`, whole or not at all; .zst behind .ply compresses it.

    A mesh of :func:`mesh` gives the bytes of ``synth -o``. Labels, elevations, colours, and the unit that the mesh or the
    file that it names states, are written where the format has them. Warns where it states no unit and lengths are not
    in kilometres.

    Parameters
    ----------
    mesh
        What is written.
    file
        The file, whose extension chooses the format.
    uv
        Texture coordinates in a .glb or .obj, by longitude and latitude; the 180th meridian cuts the triangles that cross
        it.

    Raises
    ------
    ValueError
        The mesh is wrong, the extension is another one, or the folder cannot be written.
    RuntimeError
        The disk is full, or float32 cannot hold the coordinates.
    """
    file = _arrays.file_name(file, "file")
    kind = Record(_synthesis.written_mesh_format(file))
    uv = _arrays.flag(uv, "uv")
    if uv and not kind.texture_coordinates:
        raise ValueError(f"{file}: a {kind.extension} gets no texture coordinates; leave out uv")
    arrays = arrays_of(mesh, "mesh", local=True)
    made = mesh if isinstance(mesh, Mesh) else Mesh(arrays.vertices, arrays.faces, length_unit=stated_unit(mesh))
    labels = elevations = None
    if made.labels is not None and made.elevations is not None and kind["values"]:
        if arrays.normals is None:
            raise ValueError("mesh.normals: are missing; labels are written with normals only")
        labels = _arrays.column(made.labels, "mesh.labels", np.int32, len(arrays.vertices))
        elevations = _arrays.column(made.elevations, "mesh.elevations", np.float32, len(arrays.vertices))
    values = made.values if kind["values"] and labels is None else {}
    colors = None if made.colors is None else _arrays.colors(made.colors, "mesh.colors", len(arrays.vertices))
    origin = None if made.origin is None else _arrays.vector(made.origin, "mesh.origin")
    unit = _arrays.text(made.length_unit, "mesh.length_unit")
    _synthesis.write_mesh(
        file,
        arrays.vertices,
        arrays.faces,
        arrays.normals,
        labels,
        elevations,
        colors,
        unit,
        _arrays.text(made.frame, "mesh.frame"),
        _arrays.text(made.comment, "mesh.comment"),
        origin,
        made.whole_body,
        [_arrays.text(line, "mesh.legend") for line in made.legend] if labels is not None else [],
        uv,
        [(name, _arrays.column(column, f"mesh.values.{name}", np.float64, len(arrays.vertices))) for name, column in values.items()],
    )
    if unit != "km" and unit in METRES and not kind.unit:
        _warn(f'{file}: a {kind.extension} states no unit; where it is read, pass unit="{unit}"')
