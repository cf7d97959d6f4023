"""Bodies that bump: convex parts, a coarse hull, and models of robot simulators with mass and inertia."""

from __future__ import annotations

import os
from typing import Any, Iterable, Optional, Sequence
from xml.sax.saxutils import escape, quoteattr

import numpy as np
import numpy.typing as npt

from astrolith import _arrays
from astrolith._arrays import PathLike
from astrolith._gravity import gravity
from astrolith._mesh import Mesh, MeshLike, arrays_of, unit_of, write_mesh
from astrolith._units import METRES
from astrolith.bridges._optional import required
from astrolith.bridges._whole_file import write_text

_MOST_HULL = 10_000


def _unit(mesh: MeshLike, unit: Optional[str]) -> str:
    return unit_of(mesh, unit, tuple(METRES), "mesh")


def _directions(count: int) -> npt.NDArray[np.float64]:
    """Directions of a spiral from pole to pole, spread evenly."""
    i = np.arange(count) + 0.5
    z, angle = 1.0 - 2.0 * i / count, i * np.pi * (3.0 - np.sqrt(5.0))
    r = np.sqrt(1.0 - z * z)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)


def _outward(vertices: npt.NDArray[np.float64], faces: npt.NDArray[Any]) -> npt.NDArray[np.uint32]:
    """The faces of a convex body, counter-clockwise seen from outside."""
    faces = np.array(faces, np.uint32)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a - vertices.mean(axis=0)) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    return faces


def _convex(points: npt.NDArray[np.float64], unit: str) -> Mesh:
    """The convex hull of points."""
    spatial = required("scipy.spatial", "collision")
    try:
        hull = spatial.ConvexHull(points)
    except spatial.QhullError as error:
        raise ValueError(f"{len(points)} points of the hull span no volume; ask for more directions") from error
    used = np.sort(hull.vertices)
    number = np.zeros(len(points), np.uint32)
    number[used] = np.arange(len(used), dtype=np.uint32)
    vertices = np.ascontiguousarray(points[used])
    return Mesh(vertices, _outward(vertices, number[hull.simplices]), length_unit=unit)


def hull(mesh: MeshLike, directions: int = 64, *, unit: Optional[str] = None) -> Mesh:
    """Make a coarse convex hull of a body, closed and of few triangles.

    Its corners are the vertices that lie farthest along directions spread over the sphere, so that it lies within the
    body's convex hull and touches it in those directions.

    Parameters
    ----------
    mesh
        The body.
    directions
        How many directions, 4 to 10,000. The hull has at most as many corners.
    unit
        The unit of the mesh's coordinates; None: what the mesh or its file states.

    Raises
    ------
    ImportError
        SciPy is missing; ``pip install astrolith[collision]``.
    """
    directions = _arrays.integer(directions, "directions", 4, _MOST_HULL)
    vertices = arrays_of(mesh, "mesh").vertices
    farthest = {int(np.argmax(vertices @ d)) for d in _directions(directions)}
    return _convex(vertices[sorted(farthest)], _unit(mesh, unit))


def convex_parts(
    mesh: MeshLike, *, threshold: float = 0.05, most: Optional[int] = None, seed: int = 1, unit: Optional[str] = None
) -> list[Mesh]:
    """Cut a body into convex parts, of which physics engines know when they touch.

    Parameters
    ----------
    mesh
        A closed body. A mesh of some thousand triangles will do: ``synth --triangles 5000``.
    threshold
        The concavity that a part may have, as a share of the body's size, 0.01 to 1 (CoACD).
    most
        The most parts; None: as many as the threshold asks for.
    seed
        Of CoACD's search.
    unit
        The unit of the mesh's coordinates; None: what the mesh or its file states.

    Returns
    -------
    list of Mesh
        Closed convex meshes in the frame and the unit of the body.

    Raises
    ------
    ImportError
        CoACD is missing; ``pip install astrolith[collision]``.
    """
    arrays = arrays_of(mesh, "mesh")
    threshold = _arrays.number(threshold, "threshold", 0.01, 1.0)
    coacd = required("coacd", "collision")
    coacd.set_log_level("error")
    parts = coacd.run_coacd(
        coacd.Mesh(arrays.vertices, arrays.faces.astype(np.int32)),
        threshold=threshold,
        max_convex_hull=-1 if most is None else _arrays.integer(most, "most", 1, 10_000),
        seed=_arrays.integer(seed, "seed", 0, 2**31 - 1),
    )
    name = _unit(mesh, unit)
    return [_convex(np.asarray(vertices, np.float64), name) for vertices, _ in parts]


def _in_metres(mesh: MeshLike, unit: str) -> Mesh:
    arrays = arrays_of(mesh, "mesh")
    return Mesh(arrays.vertices * METRES[unit], arrays.faces, arrays.normals, length_unit="m")


def _words(values: Iterable[float]) -> str:
    return " ".join(f"{float(value):.9g}" for value in values)


class _Model:
    """A body with its mass, and the files of its meshes in metres."""

    def __init__(self, name: str, body: Any, visual: str, parts: Sequence[str]) -> None:
        self.name, self.visual, self.parts = name, visual, parts
        self.mass = float(body.mass_kg)
        self.center = _words(body.center_of_mass_m)
        i = np.array(body.inertia_kg_m2, float)
        self.inertia = {"ixx": i[0, 0], "iyy": i[1, 1], "izz": i[2, 2], "ixy": i[0, 1], "ixz": i[0, 2], "iyz": i[1, 2]}

    def sdf(self) -> str:
        def geometry(file: str) -> str:
            return f"<geometry><mesh><uri>{escape(file)}</uri></mesh></geometry>"

        moments = "".join(f"<{k}>{v:.9g}</{k}>" for k, v in self.inertia.items())
        collisions = "".join(
            f"\n      <collision name='part{k}'>{geometry(file)}</collision>" for k, file in enumerate(self.parts)
        )
        return f"""<?xml version='1.0'?>
<sdf version='1.9'>
  <model name={quoteattr(self.name)}>
    <link name='body'>
      <inertial>
        <pose>{self.center} 0 0 0</pose>
        <mass>{self.mass:.9g}</mass>
        <inertia>{moments}</inertia>
      </inertial>
      <visual name='surface'>{geometry(self.visual)}</visual>{collisions}
    </link>
  </model>
</sdf>
"""

    def urdf(self) -> str:
        def geometry(file: str) -> str:
            return f"<geometry><mesh filename={quoteattr(file)}/></geometry>"

        moments = " ".join(f'{k}="{v:.9g}"' for k, v in self.inertia.items())
        collisions = "".join(f"\n    <collision>{geometry(file)}</collision>" for file in self.parts)
        return f"""<?xml version="1.0"?>
<robot name={quoteattr(self.name)}>
  <link name="body">
    <inertial>
      <origin xyz="{self.center}"/>
      <mass value="{self.mass:.9g}"/>
      <inertia {moments}/>
    </inertial>
    <visual>{geometry(self.visual)}</visual>{collisions}
  </link>
</robot>
"""

    def mjcf(self) -> str:
        i = self.inertia
        moments = _words(i[k] for k in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
        files = [("surface", self.visual)] + [(f"part{k}", file) for k, file in enumerate(self.parts)]
        assets = "".join(f'\n    <mesh name="{name}" file={quoteattr(file)}/>' for name, file in files)
        parts = "".join(f'\n      <geom type="mesh" mesh="part{k}" group="3"/>' for k in range(len(self.parts)))
        return f"""<mujoco model={quoteattr(self.name)}>
  <asset>{assets}
  </asset>
  <worldbody>
    <body name="body">
      <freejoint/>
      <inertial pos="{self.center}" mass="{self.mass:.9g}" fullinertia="{moments}"/>
      <geom type="mesh" mesh="surface" contype="0" conaffinity="0"/>{parts}
    </body>
  </worldbody>
</mujoco>
"""


def write_model(
    file: PathLike,
    mesh: MeshLike,
    density: float,
    *,
    parts: Optional[Sequence[MeshLike]] = None,
    unit: Optional[str] = None,
) -> list[str]:
    """Write a body as a model of a robot simulator, with mass, centre and inertia of uniform density.

    Meshes stand beside the model as .obj files in metres, in the body's frame with +z up.

    Parameters
    ----------
    file
        The model: .sdf (Gazebo), .urdf (ROS, Isaac) or .xml (MuJoCo's MJCF).
    mesh
        The closed body that is seen, and whose mass counts.
    density
        kg/m3, above 0.
    parts
        Convex meshes that collide, such as those of :func:`convex_parts`, in the unit that they
        state, else the body's; None: its :func:`hull`.
    unit
        The unit of the mesh's coordinates; None: what the mesh or its file states.

    Returns
    -------
    list of str
        The files that were written, the model first.

    Raises
    ------
    ValueError
        The mesh is open, or the file has another extension.
    """
    name = _arrays.file_name(file, "file")
    stem, extension = os.path.splitext(name)
    if extension not in (".sdf", ".urdf", ".xml"):
        raise ValueError(f"{name}: is no .sdf, .urdf or .xml file; name it with that extension")
    known = _unit(mesh, unit)
    seen = _in_metres(mesh, known)
    given = [hull(mesh, unit=known)] if parts is None else parts
    bumping = [_in_metres(part, unit_of(part, None, tuple(METRES), "parts", known)) for part in given]
    body = gravity(seen, density, degree=0, sample=0).figures.body
    written = [name, f"{stem}_visual.obj"]
    write_mesh(seen, written[1])
    for k, part in enumerate(bumping):
        written.append(f"{stem}_part{k}.obj")
        write_mesh(part, written[-1])
    files = [os.path.basename(path) for path in written[1:]]
    model = _Model(os.path.basename(stem), body, files[0], files[1:])
    text = {".sdf": model.sdf, ".urdf": model.urdf, ".xml": model.mjcf}[extension]()
    write_text(name, text)
    return written
