"""Clouds of points in the formats of lidar and of scanners."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import numpy.typing as npt

from astrolith._arrays import PathLike
from astrolith.bridges._optional import required


def _las(name: str) -> Any:
    return required("laspy", "points").read(name).xyz


def _e57(name: str) -> Any:
    file = required("pye57", "points").E57(name)
    scans = [file.read_scan(k, ignore_missing_fields=True) for k in range(file.scan_count)]
    return np.concatenate([np.column_stack([scan[f"cartesian{axis}"] for axis in "XYZ"]) for scan in scans])


def _pcd(name: str) -> Any:
    return required("pypcd4", "points").PointCloud.from_path(name).numpy(("x", "y", "z"))


_READERS = {".las": _las, ".laz": _las, ".e57": _e57, ".pcd": _pcd}


def read_points(file: PathLike) -> npt.NDArray[np.float64]:
    """Read the places of a ``.las``, ``.laz``, ``.e57`` or ``.pcd``, of all its scans, as (n, 3) float64.

    ``astrolith.repair_mesh(points, wrap=True)`` lays a surface through them. Points that are not finite are left out.

    Raises
    ------
    ImportError
        laspy, pye57 or pypcd4 is missing; ``pip install astrolith[points]``.
    ValueError
        The file is of another kind, damaged or empty.
    """
    name = os.fspath(file)
    name = os.fsdecode(name)
    reader = _READERS.get(os.path.splitext(name)[1].lower())
    if reader is None:
        raise ValueError(f"{name}: is no {', '.join(_READERS)}; the programs read other clouds of points")
    try:
        points = np.asarray(reader(name), dtype=np.float64).reshape(-1, 3)
    except (ImportError, OSError):
        raise
    except Exception as error:  # of any library
        raise ValueError(f"{name}: cannot be read ({error}); fetch it again") from error
    points = np.ascontiguousarray(points[np.isfinite(points).all(axis=1)])
    if len(points) == 0:
        raise ValueError(f"{name}: holds no points; give another file")
    return points
