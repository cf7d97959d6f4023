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
from astrolith.bridges._glb import read_levels, read_origin, with_parts
from astrolith.bridges._optional import required
from astrolith.bridges._whole_file import write_bytes, write_text

_MOST_HULL = 10_000


def _unit(mesh: MeshLike, unit: Optional[str]) -> str:
    return unit_of(mesh, unit, tuple(METRES), "mesh")


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


def _enclosing(points: npt.NDArray[np.float64], most: int, unit: str) -> Mesh:
    """A convex body of at most `most` corners around points: their hull, or planes that touch it.

    Planes are those of the hull's own facets, on which the body can rest. The next one cuts off the corner that lies
    farthest outside of the hull.
    """
    exact = _convex(points, unit)
    if len(exact.vertices) <= most:
        return exact
    spatial = required("scipy.spatial", "collision")
    planes = spatial.ConvexHull(points).equations  # outward normals n and offsets d, n . p + d <= 0 within
    inside = exact.vertices.mean(axis=0)
    axes = np.vstack([np.eye(3), -np.eye(3)])
    chosen = np.column_stack([axes, -(points @ axes.T).max(axis=0)])
    best = None
    while True:
        corners = _corners(spatial, chosen, inside)
        if len(corners) > most:
            break
        best = corners
        outside = planes[:, :3] @ corners.T + planes[:, 3:]
        if outside.max() <= 1e-12 * np.ptp(points, axis=0).max():
            break  # no corner lies outside of the hull
        chosen = np.vstack([chosen, planes[outside.max(axis=1).argmax()]])
    assert best is not None  # a box has 8 corners
    center = best.mean(axis=0)
    rounding = 1e-7  # of .obj and .glb in float32
    return _convex(center + (1.0 + rounding) * (best - center), unit)


def _corners(spatial: Any, planes: npt.NDArray[np.float64], inside: npt.NDArray[np.float64]) -> Any:
    """The corners of the body within all planes; corners at one place are one."""
    corners = spatial.HalfspaceIntersection(planes, inside).intersections
    size = np.ptp(corners, axis=0).max()
    _, first = np.unique(np.round(corners / (1e-9 * size)), axis=0, return_index=True)
    return corners[np.sort(first)]


def hull(mesh: MeshLike, most_vertices: int = 64, *, unit: Optional[str] = None) -> Mesh:
    """Make a coarse convex hull around a body, closed and of few triangles.

    It encloses the body and touches it in each of its faces, so that a body at rest on its hull rests on its ground. It is
    the exact hull where that has as few vertices as asked for.

    Parameters
    ----------
    mesh
        The body.
    most_vertices
        The most vertices of the hull, 8 to 10,000. PhysX takes 64 on a GPU and 255 on a CPU.
    unit
        The unit of the mesh's coordinates; None: what the mesh or its file states.

    Raises
    ------
    ImportError
        SciPy is missing; ``pip install astrolith[collision]``.
    """
    most = _arrays.integer(most_vertices, "most_vertices", 8, _MOST_HULL)
    return _enclosing(arrays_of(mesh, "mesh").vertices.astype(np.float64), most, _unit(mesh, unit))


def convex_parts(
    mesh: MeshLike,
    *,
    threshold: float = 0.05,
    most: Optional[int] = None,
    most_vertices: int = 64,
    seed: int = 1,
    unit: Optional[str] = None,
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
    most_vertices
        The most vertices of a part, 8 to 10,000. A part that would have more becomes the coarser body around it that
        :func:`hull` makes.
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
    limit = _arrays.integer(most_vertices, "most_vertices", 8, _MOST_HULL)
    coacd = required("coacd", "collision")
    coacd.set_log_level("error")
    parts = coacd.run_coacd(
        coacd.Mesh(arrays.vertices, arrays.faces.astype(np.int32)),
        threshold=threshold,
        max_convex_hull=-1 if most is None else _arrays.integer(most, "most", 1, 10_000),
        seed=_arrays.integer(seed, "seed", 0, 2**31 - 1),
    )
    name = _unit(mesh, unit)
    return [_enclosing(np.asarray(vertices, np.float64), limit, name) for vertices, _ in parts]


def in_metres(mesh: MeshLike, unit: str) -> Mesh:
    """The mesh with its vertices in metres."""
    arrays = arrays_of(mesh, "mesh")
    return Mesh(arrays.vertices * METRES[unit], arrays.faces, arrays.normals, length_unit="m")


def _words(values: Iterable[float]) -> str:
    return " ".join(f"{float(value):.9g}" for value in values)


def write_collision(
    glb: PathLike,
    file: PathLike,
    *,
    engine: str,
    parts: Optional[Sequence[MeshLike]] = None,
    most_vertices: int = 64,
    unit: Optional[str] = None,
) -> str:
    """Write a .glb of ``synth`` anew, with convex parts that an engine takes for collisions by their names.

    Parameters
    ----------
    glb
        A file of ``synth -o rock.glb``, without parts.
    file
        The new .glb, of another name.
    engine
        "godot": nodes ``body_part0-convcolonly`` and so on; "unreal": ``UCX_body_00`` and so on.
    parts
        Convex meshes such as those of :func:`convex_parts`, in the unit that they state; None: the body's :func:`hull`.
    most_vertices
        Of that hull.
    unit
        The unit of parts that state none; None: metres.

    Returns
    -------
    str
        The file that was written.

    Raises
    ------
    ValueError
        The .glb is none of ``synth``, or the engine is another.
    """
    name = _arrays.file_name(file, "file")
    if engine not in ("godot", "unreal"):
        raise ValueError(f"engine: must be godot or unreal, and is {engine!r}")
    if not name.endswith(".glb"):
        raise ValueError(f"{name}: is no .glb file; name it with that extension")
    if os.path.exists(name) and os.path.samefile(name, _arrays.file_name(glb, "glb")):
        raise ValueError(f"{name}: is also the file that is read; name another one")
    body = read_levels(glb)[0]
    if parts is None:
        parts = [hull(Mesh(body.vertices + read_origin(glb), body.faces, length_unit="m"), most_vertices)]
    named = []
    for k, part in enumerate(parts):
        made = in_metres(part, unit_of(part, unit, tuple(METRES), "parts", "m"))
        named.append((f"body_part{k}-convcolonly" if engine == "godot" else f"UCX_body_{k:02}", made.vertices, made.faces))
    write_bytes(name, with_parts(glb, named))
    return name


class _Model:
    """A body with its mass, and the files of its meshes in metres."""

    def __init__(self, name: str, body: Any, visual: str, parts: Sequence[str], length: float) -> None:
        self.name, self.visual, self.parts = name, visual, parts
        # Contacts of MuJoCo give way by a tenth of a millimetre under the Earth's gravity. They begin so far from the
        # body that it does not rest below its ground.
        self.margin = 5e-4 * length
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
        # Names are the model's own, so that several models go into one scene.
        i = self.inertia
        moments = _words(i[k] for k in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
        names = [f"{self.name}_surface"] + [f"{self.name}_part{k}" for k in range(len(self.parts))]
        assets = "".join(
            f"\n    <mesh name={quoteattr(name)} file={quoteattr(file)}/>"
            for name, file in zip(names, [self.visual, *self.parts])
        )
        parts = "".join(
            f'\n      <geom name={quoteattr(name)} type="mesh" mesh={quoteattr(name)} group="3" margin="{self.margin:.4g}"/>'
            for name in names[1:]
        )
        surface = quoteattr(names[0])
        return f"""<mujoco model={quoteattr(self.name)}>
  <asset>{assets}
  </asset>
  <worldbody>
    <body name={quoteattr(self.name)}>
      <freejoint name={quoteattr(self.name + "_free")}/>
      <inertial pos="{self.center}" mass="{self.mass:.9g}" fullinertia="{moments}"/>
      <geom name={surface} type="mesh" mesh={surface} contype="0" conaffinity="0"/>{parts}
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
    seen = in_metres(mesh, known)
    given = [hull(mesh, unit=known)] if parts is None else parts
    bumping = [in_metres(part, unit_of(part, None, tuple(METRES), "parts", known)) for part in given]
    body = gravity(seen, density, degree=0, sample=0).figures.body
    written = [name, f"{stem}_visual.obj"]
    write_mesh(seen, written[1])
    for k, part in enumerate(bumping):
        written.append(f"{stem}_part{k}.obj")
        write_mesh(part, written[-1])
    files = [os.path.basename(path) for path in written[1:]]
    length = float(np.ptp(seen.vertices, axis=0).max())
    model = _Model(os.path.basename(stem), body, files[0], files[1:], length)
    text = {".sdf": model.sdf, ".urdf": model.urdf, ".xml": model.mjcf}[extension]()
    write_text(name, text)
    return written
