"""Meshes as those of trimesh, PyVista and Open3D, and back.

Vertices keep their values, their order and their unit. Those of a patch stay relative to its centre; `Mesh.origin` is
passed on where the other package has a place for it.
"""

from __future__ import annotations

from typing import Any, Mapping, Optional

import numpy as np
import numpy.typing as npt

from astrolith._arrays import is_file_name
from astrolith._mesh import Mesh, MeshLike, arrays_of, read_mesh
from astrolith._units import name_of
from astrolith.bridges._optional import required


def _mesh_of(mesh: MeshLike) -> Mesh:
    if isinstance(mesh, Mesh):
        return mesh
    if is_file_name(mesh):
        return read_mesh(mesh)
    arrays = arrays_of(mesh, "mesh")
    return Mesh(arrays.vertices, arrays.faces, arrays.normals)


def _normals(array: Any) -> Optional[npt.NDArray[np.float64]]:
    return None if array is None or len(array) == 0 else np.ascontiguousarray(array, np.float64)


def _require(mesh: Any, names: tuple[str, ...], kind: str, remedy: str) -> None:
    """Raises ValueError for an object that lacks what a function takes of it."""
    if not all(hasattr(mesh, name) for name in names):
        raise ValueError(f"mesh: is {type(mesh).__name__}, and no {kind}; {remedy}")


def to_trimesh(mesh: MeshLike) -> Any:
    """Make a ``trimesh.Trimesh`` of a mesh.

    Its metadata has the frame, the origin and the figures, and its units are the mesh's. Nothing is merged or removed.

    Raises
    ------
    ImportError
        trimesh is missing; ``pip install astrolith[trimesh]``.
    """
    trimesh = required("trimesh", "trimesh")
    made = _mesh_of(mesh)
    metadata = {"frame": made.frame, "origin": made.origin, "figures": dict(made.figures)}
    result = trimesh.Trimesh(
        vertices=made.vertices,
        faces=made.faces.astype(np.int64),
        vertex_normals=made.normals,
        metadata=metadata,
        process=False,
    )
    result.units = made.length_unit or None
    return result


def from_trimesh(mesh: Any) -> Mesh:
    """Make a :class:`astrolith.Mesh` of a ``trimesh.Trimesh``.

    Its unit is kept; "meters" become "m". Normals are kept where they were given or have been computed. ValueError for
    what is no such mesh.
    """
    _require(mesh, ("vertices", "faces", "vertex_normals"), "trimesh.Trimesh", "of a scene take scene.to_mesh()")
    arrays = arrays_of((mesh.vertices, mesh.faces), "mesh")
    return Mesh(
        arrays.vertices,
        arrays.faces,
        _normals(mesh.vertex_normals) if "vertex_normals" in mesh._cache else None,
        length_unit=name_of(mesh.units),
    )


def to_pyvista(mesh: MeshLike, values: Optional[Mapping[str, npt.ArrayLike]] = None) -> Any:
    """Make a ``pyvista.PolyData`` of a mesh, with its normals, labels and elevations as point data.

    Parameters
    ----------
    values
        More data by name, with a row for each vertex (point data) or for each face (cell data), such as
        ``{"slope": made.slope}`` of :func:`astrolith.gravity`.

    Raises
    ------
    ValueError
        A value has a row neither for each vertex nor for each face.
    ImportError
        PyVista is missing; ``pip install astrolith[pyvista]``.
    """
    pyvista = required("pyvista", "pyvista")
    made = _mesh_of(mesh)
    vertices, faces = len(made.vertices), len(made.faces)
    cells = np.column_stack([np.full(faces, 3, np.int64), made.faces.astype(np.int64)])
    result = pyvista.PolyData(np.array(made.vertices), cells.ravel())
    for name, column in (("Normals", made.normals), ("labels", made.labels), ("elevations", made.elevations)):
        if column is not None:
            result.point_data[name] = column
    for name, given in (values or {}).items():
        array = np.ascontiguousarray(given)
        if len(array) not in (vertices, faces):
            raise ValueError(f"values[{name!r}]: has {len(array)} rows; there are {vertices} vertices and {faces} faces")
        (result.point_data if len(array) == vertices else result.cell_data)[name] = array
    return result


def from_pyvista(mesh: Any) -> Mesh:
    """Make a :class:`astrolith.Mesh` of a ``pyvista.PolyData``. Its polygons are cut into triangles.

    ValueError for a grid, and for a mesh without polygons.
    """
    _require(mesh, ("triangulate", "faces", "points"), "pyvista.PolyData", "of a grid take mesh.extract_surface()")
    if len(mesh.faces) == 0:
        raise ValueError("mesh: has no polygons; points alone are no surface")
    triangles = mesh.triangulate()
    arrays = arrays_of((triangles.points, triangles.faces.reshape(-1, 4)[:, 1:]), "mesh")
    return Mesh(arrays.vertices, arrays.faces, _normals(triangles.point_data.get("Normals")))


def to_open3d(mesh: MeshLike) -> Any:
    """Make an ``open3d.geometry.TriangleMesh`` of a mesh, with its normals.

    Raises
    ------
    ImportError
        Open3D is missing; ``pip install astrolith[open3d]``.
    """
    open3d = required("open3d", "open3d")
    made = _mesh_of(mesh)
    result = open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(np.asarray(made.vertices, np.float64)),
        open3d.utility.Vector3iVector(made.faces.astype(np.int32)),
    )
    if made.normals is not None:
        result.vertex_normals = open3d.utility.Vector3dVector(np.asarray(made.normals, np.float64))
    return result


def from_open3d(mesh: Any) -> Mesh:
    """Make a :class:`astrolith.Mesh` of an ``open3d.geometry.TriangleMesh``. ValueError for points and other kinds."""
    _require(mesh, ("vertices", "triangles", "vertex_normals"), "open3d.geometry.TriangleMesh",
             "of points make a mesh first, such as by create_from_point_cloud_poisson()")  # fmt: skip
    arrays = arrays_of((np.array(mesh.vertices), np.array(mesh.triangles)), "mesh")
    return Mesh(arrays.vertices, arrays.faces, _normals(np.array(mesh.vertex_normals)))
