"""Patches as xarray's arrays and as GeoTIFF."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from astrolith._arrays import PathLike, file_name
from astrolith._height_map import HeightMap
from astrolith.bridges._optional import required

# A plane in metres without a datum.
_PLANE = 'LOCAL_CS["mean plane of the patch",UNIT["metre",1,AUTHORITY["EPSG","9001"]],AXIS["x",EAST],AXIS["y",NORTH]]'


def _frame(height_map: HeightMap) -> dict[str, Any]:
    return {
        "origin_m": list(height_map.origin),
        "right": list(height_map.right),
        "ahead": list(height_map.ahead),
        "up": list(height_map.up),
        "body_frame": height_map.body_frame,
    }


def to_xarray(height_map: HeightMap) -> Any:
    """Make an ``xarray.DataArray`` "height" of a patch, metres over x (to the right) and y (ahead), in metres, too.

    Its attributes place the plane in the body-fixed frame: a point is origin_m + x right + y ahead + height up.

    Raises
    ------
    ImportError
        xarray is missing; ``pip install astrolith[geo]``.
    """
    xarray = required("xarray", "geo")
    side = len(height_map.heights)
    across = (np.arange(side) + 0.5 - side / 2) * height_map.pixel
    attributes = {"units": "m", "long_name": "height over the mean plane", **_frame(height_map)}
    result = xarray.DataArray(
        height_map.heights, dims=("y", "x"), coords={"y": -across, "x": across}, name="height", attrs=attributes
    )
    result.x.attrs["units"] = result.y.attrs["units"] = "m"
    return result


def write_geotiff(height_map: HeightMap, file: PathLike) -> None:
    """Write a patch as a GeoTIFF of float32 metres with rasterio, whole or not at all.

    The map is a plane in metres without a datum: zero in the middle, x to the right, y up. The file's tags place it
    in the body-fixed frame.

    Raises
    ------
    OSError
        The file cannot be written.
    ImportError
        rasterio is missing; ``pip install astrolith[geo]``.
    """
    file = file_name(file, "file")
    rasterio = required("rasterio", "geo")
    side, pixel = len(height_map.heights), height_map.pixel
    half = side * pixel / 2
    partial = f"{file}.part"
    tags = {name: str(value) for name, value in _frame(height_map).items()}
    try:
        with rasterio.open(
            partial,
            "w",
            driver="GTiff",
            width=side,
            height=side,
            count=1,
            dtype="float32",
            nodata=float("nan"),
            crs=rasterio.crs.CRS.from_wkt(_PLANE),
            transform=rasterio.transform.Affine(pixel, 0, -half, 0, -pixel, half),
            compress="deflate",
            predictor=3,
        ) as out:
            out.write(height_map.heights, 1)
            out.update_tags(**tags)
            out.set_band_description(1, "height over the mean plane, m")
        os.replace(partial, file)
    finally:
        if os.path.exists(partial):
            os.remove(partial)
