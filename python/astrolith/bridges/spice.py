"""SPICE kernels of a body: its shape as a DSK of type 2, its size and rotation as a PCK, its frame as an FK."""

from __future__ import annotations

import dataclasses
import os
from typing import Any, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from astrolith import _arrays
from astrolith._arrays import PathLike
from astrolith._mesh import Mesh, MeshLike, arrays_of, unit_of
from astrolith._units import METRES
from astrolith.bridges._optional import required
from astrolith.bridges._whole_file import write_text

# The limits of type 2 (DSK Required Reading).
_MOST_VERTICES = 16_000_002
_MOST_PLATES = 32_000_000
_MOST_FINE_VOXELS = 100_000_000
_MOST_COARSE_VOXELS = 100_000

_GENERAL_CLASS = 2  # of surfaces that a ray from the centre may meet more than once
_LATITUDINAL, _RECTANGULAR = 1, 3
_CENTURY = 36525 * 86400.0


@dataclasses.dataclass
class Kernels:
    """The files that :func:`write_kernels` wrote."""

    dsk: str
    pck: str
    fk: str


def _plates(mesh: MeshLike, unit: Optional[str], name: str) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int32]]:
    """Vertices in kilometres of the body-fixed frame, and plates whose vertices are counted from 1."""
    arrays = arrays_of(mesh, name)
    scale = METRES[unit_of(mesh, unit, tuple(METRES), name)] / METRES["km"]
    origin = (mesh.origin if isinstance(mesh, Mesh) else None) or (0.0, 0.0, 0.0)
    vertices = (arrays.vertices + np.array(origin)) * scale
    if len(vertices) > _MOST_VERTICES or len(arrays.faces) > _MOST_PLATES:
        raise ValueError(
            f"{name}: has {len(vertices)} vertices and {len(arrays.faces)} faces; "
            f"a segment holds {_MOST_VERTICES} and {_MOST_PLATES}; write fewer triangles, or several patches"
        )
    return np.ascontiguousarray(vertices), np.ascontiguousarray(arrays.faces.astype(np.int32) + 1)


@dataclasses.dataclass
class _Grid:
    """The voxels of a segment's spatial index."""

    fine: float
    coarse: int
    pointers: int
    entries: int


def _grid(vertices: npt.NDArray[np.float64], plates: npt.NDArray[np.int32]) -> _Grid:
    """Fine voxels of five mean plate extents, fewer where there would be too many; coarse ones within their limit."""
    corners = vertices[plates - 1]
    least, most = corners.min(axis=1), corners.max(axis=1)
    extent = max(float((most - least).mean()), 1e-300)
    sides = np.maximum(vertices.max(axis=0) - vertices.min(axis=0), extent)
    fine = 5.0
    while np.prod(np.ceil(sides / (fine * extent)) + 3) > 0.9 * _MOST_FINE_VOXELS:
        fine *= 1.25
    cells = np.ceil(sides / (fine * extent)) + 3
    coarse = 1
    while np.prod(np.ceil(cells / coarse) + 1) > 0.5 * _MOST_COARSE_VOXELS:
        coarse += 1
    # A plate is entered in each voxel that its box touches, and the box may lie across one voxel more on either side.
    touched = np.prod(np.floor((most - least) / (fine * extent)) + 3, axis=1).sum()
    pointers = np.prod(np.ceil(cells / coarse) + 1) * coarse**3
    return _Grid(fine, coarse, int(pointers), int(2 * touched + pointers))


def _write_segment(
    spice: Any,
    handle: int,
    vertices: npt.NDArray[np.float64],
    plates: npt.NDArray[np.int32],
    whole: bool,
    surface: int,
    body: int,
    frame: str,
) -> None:
    grid = _grid(vertices, plates)
    fixed = 100_007  # the part of the integer index that has a fixed size
    doubles, integers = spice.dskmi2(
        vertices, plates, grid.fine, grid.coarse, grid.entries, grid.pointers, grid.entries, False,
        fixed + grid.pointers + grid.entries,
    )  # fmt: skip
    if whole:
        system, first, second = _LATITUDINAL, (-np.pi, np.pi), (-np.pi / 2, np.pi / 2)
    else:
        system = _RECTANGULAR
        first, second = ((float(vertices[:, k].min()), float(vertices[:, k].max())) for k in range(2))
    third = spice.dskrb2(vertices, plates, system, np.zeros(10))
    spice.dskw02(
        handle, body, surface, _GENERAL_CLASS, frame, system, np.zeros(10), *first, *second, *third,
        -_CENTURY, _CENTURY, vertices, plates, doubles, integers,
    )  # fmt: skip


def _segments(meshes: Union[MeshLike, Sequence[MeshLike]]) -> list[tuple[str, MeshLike]]:
    if isinstance(meshes, list):
        if not meshes:
            raise ValueError("meshes: is empty; give at least one mesh")
        return [(f"meshes[{k}]", mesh) for k, mesh in enumerate(meshes)]
    return [("meshes", meshes)]


def write_dsk(
    meshes: Union[MeshLike, list[MeshLike]],
    file: PathLike,
    *,
    body: int,
    frame: str,
    surfaces: Optional[Sequence[int]] = None,
    unit: Optional[str] = None,
) -> None:
    """Write meshes as the segments of a DSK of type 2, whole or not at all.

    A mesh with an origin is a patch: its vertices are placed by that origin, and the segment states the box that it
    covers. Other segments cover the whole body. Coordinates are written in kilometres as float64.

    Parameters
    ----------
    meshes
        A mesh, or a list of meshes with one segment each, such as the body and a patch of it.
    file
        The DSK, usually ``.bds``.
    body
        The NAIF code of the body, such as 2025143 for Itokawa.
    frame
        The name of its body-fixed frame. SPICE must know it: load its frame kernel first.
    surfaces
        The surface numbers of the segments, 1, 2, ... by default. A ray that is asked for all surfaces meets the
        nearest, be it of the body or of the patch; ask for one number to choose.
    unit
        The unit of all meshes: "m", "km", "cm" or "mm". None: what each mesh or its file states, else km.

    Raises
    ------
    ValueError
        A mesh is wrong, too large or without a length.
    ImportError
        spiceypy is missing; ``pip install astrolith[spice]``.
    spiceypy.exceptions.SpiceyError
        SPICE refuses the frame, the numbers or the file.
    """
    file = _arrays.file_name(file, "file")
    spice = required("spiceypy", "spice")
    segments = _segments(meshes)
    numbers = list(range(1, len(segments) + 1)) if surfaces is None else list(surfaces)
    if len(numbers) != len(segments):
        raise ValueError(f"surfaces: has {len(numbers)} numbers; there are {len(segments)} segments")
    code = _arrays.integer(body, "body", -(2**31), 2**31 - 1)
    prepared = [(*_plates(mesh, unit, name), mesh) for name, mesh in segments]
    partial = f"{file}.part"
    if os.path.exists(partial):
        os.remove(partial)
    try:
        handle = spice.dskopn(partial, "astrolith", 0)
        try:
            for number, (vertices, plates, mesh) in zip(numbers, prepared):
                whole = not (isinstance(mesh, Mesh) and mesh.origin is not None and not mesh.whole_body)
                _write_segment(spice, handle, vertices, plates, whole, int(number), code, frame)
        finally:
            spice.dskcls(handle, True)
        os.replace(partial, file)
    finally:
        if os.path.exists(partial):
            os.remove(partial)


def _write_text(file: str, kind: str, lines: Sequence[str]) -> None:
    text = f"KPL/{kind}\n\n\\begindata\n\n" + "\n".join("   " + line for line in lines) + "\n\n\\begintext\n"
    write_text(file, text, encoding="ascii")


def write_kernels(
    meshes: Union[MeshLike, list[MeshLike]],
    folder: PathLike,
    name: str,
    *,
    body: int,
    period: float,
    pole: Sequence[float] = (0.0, 90.0),
    meridian: float = 0.0,
    surfaces: Optional[Sequence[int]] = None,
    unit: Optional[str] = None,
    frame_id: Optional[int] = None,
) -> Kernels:
    """Write NAME.bds, NAME.tpc and NAME.tf: shape, size with rotation, and the frame NAME_FIXED.

    The body turns about its +z at a constant rate, as the IAU's models do. All three kernels are left unloaded.

    Parameters
    ----------
    meshes, body, surfaces, unit
        As of :func:`write_dsk`. The radii of the PCK are half the sides of the box of the first mesh.
    folder
        A folder that exists.
    name
        The body's name: a letter, then letters, digits and "_", at most 26 in all.
    period
        The period of rotation in hours; below 0 for one that turns backwards.
    pole
        Right ascension and declination of +z at J2000, degrees.
    meridian
        The angle of the prime meridian at J2000, degrees.
    frame_id
        The number of the frame, 1,400,000 to 2,000,000, as NAIF leaves it to users; None: one by the number of the body.

    Returns
    -------
    Kernels
        The names of the files; give them to ``spiceypy.furnsh``.

    Raises
    ------
    ValueError
        An argument is wrong.
    ImportError
        spiceypy is missing; ``pip install astrolith[spice]``.
    """
    folder = _arrays.file_name(folder, "folder")
    spice = required("spiceypy", "spice")
    if not (name.isascii() and name.isidentifier() and name[0].isalpha() and len(name) <= 26):
        raise ValueError(f"name: must be a letter, then letters, digits and _, at most 26, and is {name!r}")
    code = _arrays.integer(body, "body", -(2**31), 2**31 - 1)
    hours = _arrays.number(period, "period", -1e9, 1e9)
    if hours == 0.0:
        raise ValueError("period: must not be 0 hours")
    ascension, declination = _arrays.vector(pole, "pole", 2)
    (zero,) = _arrays.vector((meridian,), "meridian", 1)
    first_name, first_mesh = _segments(meshes)[0]
    vertices, _ = _plates(first_mesh, unit, first_name)
    radii = (vertices.max(axis=0) - vertices.min(axis=0)) / 2
    frame = f"{name.upper()}_FIXED"
    if frame_id is None:
        # A prime: the bodies of a pair, as 920065803 and 120065803, differ by a multiple of many round numbers.
        frame_id = 1_400_000 + abs(code) % 599_999
    frame_id = _arrays.integer(frame_id, "frame_id", 1_400_000, 2_000_000)
    paths = [os.path.join(folder, name + extension) for extension in (".bds", ".tpc", ".tf")]
    files = Kernels(*paths)
    _write_text(
        files.pck,
        "PCK",
        [
            f"BODY{code}_RADII    = ( {' '.join(repr(float(radius)) for radius in radii)} )",
            f"BODY{code}_POLE_RA  = ( {ascension!r} 0. 0. )",
            f"BODY{code}_POLE_DEC = ( {declination!r} 0. 0. )",
            f"BODY{code}_PM       = ( {zero!r} {360.0 * 24.0 / hours!r} 0. )",
        ],
    )
    _write_text(
        files.fk,
        "FK",
        [
            f"NAIF_BODY_NAME += ( '{name.upper()}' )",
            f"NAIF_BODY_CODE += ( {code} )",
            f"FRAME_{frame} = {frame_id}",
            f"FRAME_{frame_id}_NAME     = '{frame}'",
            f"FRAME_{frame_id}_CLASS    = 2",
            f"FRAME_{frame_id}_CLASS_ID = {code}",
            f"FRAME_{frame_id}_CENTER   = {code}",
            f"OBJECT_{code}_FRAME       = '{frame}'",
        ],
    )
    spice.furnsh(files.fk)
    try:
        write_dsk(meshes, files.dsk, body=code, frame=frame, surfaces=surfaces, unit=unit)
    finally:
        spice.unload(files.fk)
    return files
