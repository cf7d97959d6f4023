"""Bodies in other packages' terms: trimesh, PyVista, Open3D, PyTorch, xarray, GeoTIFF, SPICE, USD, SDF, URDF, MJCF, PDS4, Croissant.

Nothing of these packages is loaded before a function needs it. Each is an optional extra, such as
``pip install astrolith[trimesh]``; a function whose package is missing raises an ImportError that says so.
"""

from __future__ import annotations

from astrolith.bridges.collision import convex_parts, hull, write_collision, write_model
from astrolith.bridges.data_card import write_data_card
from astrolith.bridges.datasets import Bodies, torch_dataset, torch_loader
from astrolith.bridges.finished_set import FinishedSet
from astrolith.bridges.geo import to_xarray, write_geotiff
from astrolith.bridges.meshes import (
    from_open3d,
    from_pyvista,
    from_trimesh,
    to_open3d,
    to_pyvista,
    to_trimesh,
)
from astrolith.bridges.pds4 import write_pds4_label
from astrolith.bridges.points import read_points
from astrolith.bridges.shapes import shape_harmonics
from astrolith.bridges.spice import Kernels, write_dsk, write_kernels
from astrolith.bridges.usd import write_usd

__all__ = [
    "Bodies",
    "FinishedSet",
    "Kernels",
    "convex_parts",
    "from_open3d",
    "from_pyvista",
    "from_trimesh",
    "hull",
    "read_points",
    "shape_harmonics",
    "to_open3d",
    "to_pyvista",
    "to_trimesh",
    "to_xarray",
    "torch_dataset",
    "torch_loader",
    "write_collision",
    "write_data_card",
    "write_dsk",
    "write_geotiff",
    "write_kernels",
    "write_model",
    "write_pds4_label",
    "write_usd",
]
