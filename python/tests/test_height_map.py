"""Height maps of patches, as GDAL reads them."""

import json

import numpy as np
import pytest

BALL = {
    "format_version": 1,
    "length_unit": "km",
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]},
}
PIXELS = 48


@pytest.fixture
def height_map(program, tmp_path):
    """A patch of 100 m beside the point (0, 0.6, 0.8) of a ball of 1 km: the opened GeoTIFF and its frame."""
    rasterio = pytest.importorskip("rasterio", reason="rasterio is absent; scripts/python_venv.sh installs it")
    (tmp_path / "ball.json").write_text(json.dumps(BALL))
    program("synth", "ball.json", "-o", "patch.ply", "--patch", 0, 0.6, 0.8, 0.1, "--resolution", PIXELS,
            "--height-map", "site.tif")
    with rasterio.open(tmp_path / "site.tif") as file:
        yield file, json.loads((tmp_path / "site.json").read_text())


def test_gdal_reads_the_frame(height_map):
    file, frame = height_map
    assert (file.driver, file.count, file.width, file.height) == ("GTiff", 1, PIXELS, PIXELS)
    assert file.dtypes == ("float32",)
    assert np.isnan(file.nodata)
    pixel = 100 / PIXELS
    assert frame["metres_per_pixel"] == pytest.approx(pixel)
    # Column and row of a pixel's corner to metres right of and ahead of the origin.
    assert file.transform.to_gdal() == pytest.approx((-50, pixel, 0, 50, 0, -pixel))
    assert file.tags()["TIFFTAG_IMAGEDESCRIPTION"] == json.dumps(frame, separators=(",", ":"))


def test_pixels_lie_on_the_ball(height_map):
    file, frame = height_map
    heights = file.read(1).astype(float)
    assert np.isfinite(heights).all() and frame["pixels_without_data"] == 0
    rows, columns = np.mgrid[0:PIXELS, 0:PIXELS]
    right, ahead = file.xy(rows.ravel(), columns.ravel())
    axes = [np.array(frame[name]) for name in ("right", "ahead", "up")]
    places = np.array(frame["origin_m"]) + sum(
        np.outer(values, axis) for values, axis in zip((right, ahead, heights.ravel()), axes))
    # The mesh's chords lie below the ball by a cell squared over 8 km, and floats round to 0.1 mm.
    assert np.abs(np.linalg.norm(places, axis=1) - 1000).max() < 0.01
