"""Meshes, patches and datasets in the terms of other packages, and what their absence says."""

import json
import pickle
import subprocess
import sys
from pathlib import Path

import astrolith
import numpy as np
import pytest
from astrolith import bridges

BALL = {"format_version": 1, "length_unit": "m", "body": {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[1.0, 0.0, 0.0, 2.0]]}}
ROUGH = {**BALL, "layers": [{"type": "perlin", "amplitude": 0.2, "frequency": 2.0}]}


@pytest.fixture
def ball():
    return astrolith.mesh(BALL, resolution=24)


def same(a, b):
    return (a.vertices == b.vertices).all() and (a.faces == b.faces).all() and np.allclose(a.normals, b.normals, atol=1e-6)


def test_trimesh_there_and_back(ball):
    pytest.importorskip("trimesh")
    made = bridges.to_trimesh(ball)
    assert made.is_watertight and made.is_winding_consistent and made.units == "m"
    assert made.volume == pytest.approx(4 / 3 * np.pi * 8, rel=0.02)
    np.testing.assert_allclose(made.vertex_normals, ball.normals, atol=1e-6)
    back = bridges.from_trimesh(made)
    assert same(back, ball) and back.length_unit == "m"
    assert astrolith.describe(made, points=200).points == 200
    masses = [astrolith.gravity(mesh, 2000.0).figures.body.mass_kg for mesh in (made, ball)]
    assert masses[0] == pytest.approx(masses[1])


def test_pyvista_there_and_back(ball):
    pytest.importorskip("pyvista")
    gravity = astrolith.gravity(ball, 2000.0)
    made = bridges.to_pyvista(ball, {"slope": gravity.slope, "height": ball.vertices[:, 2]})
    assert made.n_open_edges == 0 and made.volume == pytest.approx(4 / 3 * np.pi * 8, rel=0.02)
    assert (made.cell_data["slope"] == gravity.slope).all() and len(made.point_data["height"]) == len(ball.vertices)
    assert same(bridges.from_pyvista(made), ball)
    with pytest.raises(ValueError, match="^values"):
        bridges.to_pyvista(ball, {"slope": [1.0, 2.0]})


def test_open3d_there_and_back(ball):
    pytest.importorskip("open3d")
    made = bridges.to_open3d(ball)
    assert made.is_watertight() and made.get_volume() == pytest.approx(4 / 3 * np.pi * 8, rel=0.02)
    assert same(bridges.from_open3d(made), ball)


def test_harmonics_of_a_shape_are_those_that_made_it():
    made = astrolith.mesh({**BALL, "body": {**BALL["body"], "spheres": [[0, 0, 0, 2.0]]}}, resolution=96)
    x, y, z = (made.vertices / np.linalg.norm(made.vertices, axis=1)[:, None]).astype(float).T
    p20, p32 = np.sqrt(5) * (1.5 * z * z - 0.5), np.sqrt(7 * 2 / 120) * 15 * z  # times u^2 cos 2 longitude = x^2 - y^2
    radius = 2.0 + 0.2 * p20 + 0.1 * p32 * (x * x - y * y) - 0.05 * np.sqrt(3) * y
    body = astrolith.Mesh(radius[:, None] * np.stack([x, y, z], axis=1), made.faces, length_unit="m")
    found = bridges.shape_harmonics(body, 6)
    expected = np.zeros((2, 7, 7))
    expected[0, 0, 0], expected[0, 2, 0], expected[0, 3, 2], expected[1, 1, 1] = 2.0, 0.2, 0.1, -0.05
    np.testing.assert_allclose(found, expected, atol=1e-3)
    with pytest.raises(ValueError, match="^mesh: does not have one surface"):
        bridges.shape_harmonics((body.vertices + [0, 0, 9.0], body.faces), 2)


def test_what_is_no_mesh_of_triangles_is_a_value_error():
    for package, call in (
        ("pyvista", lambda p: bridges.from_pyvista(p.ImageData(dimensions=(3, 3, 3)))),
        ("pyvista", lambda p: bridges.from_pyvista(p.PolyData(np.eye(3)))),
        ("pyvista", lambda p: bridges.from_pyvista("rock.vtp")),
        ("open3d", lambda o: bridges.from_open3d(o.geometry.PointCloud())),
        ("trimesh", lambda t: bridges.from_trimesh(t.Scene())),
        ("trimesh", lambda t: bridges.from_trimesh(t.PointCloud(np.eye(3)))),
    ):
        try:
            module = __import__(package)
        except ImportError:
            continue
        with pytest.raises(ValueError, match="^mesh: "):
            call(module)


def test_bodies_are_the_same_whenever_they_are_made():
    bodies = bridges.Bodies([BALL, ROUGH], seeds=[3, 4, 5], resolution=16)
    assert len(bodies) == 6 and [(item["recipe"], item["seed"]) for item in bodies][2:4] == [(0, 5), (1, 3)]
    expected = astrolith.mesh(ROUGH, resolution=16, seed=4)
    again = pickle.loads(pickle.dumps(bodies))
    for item in (bodies[4], again[4], bodies[-2]):
        assert (item["vertices"] == expected.vertices).all() and item["faces"].dtype == np.int64
    assert not np.array_equal(bodies[3]["vertices"], bodies[4]["vertices"])
    with pytest.raises(IndexError):
        bodies[6]


def test_a_finished_set_is_read_member_by_member(program, tmp_path):
    family = {"fields": [{"field": "body.spheres[0].radius", "distribution": "uniform", "low": 1, "high": 2}]}
    recipe = {"format_version": 1, "length_unit": "m", "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]}}
    (tmp_path / "family.json").write_text(json.dumps({**recipe, "family": family}))
    program("synth", "family.json", "--members", "0:2", "--resolution", "16", "-o", "set/{member}.ply.zst", "--preview",
            "set/{member}.png", "--view", 1, 0, 0, "--preview-maps", "set/{member}.npz", "--manifest", "set/m.jsonl")  # fmt: skip
    made = bridges.FinishedSet(tmp_path / "set/m.jsonl", check=True)
    assert [item["member"] for item in made] == [0, 1]
    for item in made:
        radius = item["drawn"]["body.spheres[0].radius"]
        assert np.linalg.norm(item["vertices"], axis=1).max() == pytest.approx(radius, rel=0.05)
        assert item["vertices"].dtype == np.float32 and item["faces"].dtype == np.int64 and "normals" in item
        assert item["maps"]["depth"].dtype == np.float32 and Path(item["files"][".png"]).is_file()
    (tmp_path / "set/0000001.npz").write_bytes(b"damaged")
    with pytest.raises(ValueError, match="0000001.npz: is not the file"):
        made[1]
    (tmp_path / "set/0000000.ply.zst").unlink()
    with pytest.raises(ValueError, match="is missing"):
        made[0]
    with (tmp_path / "set/m.jsonl").open("a") as manifest:
        manifest.write('{"member": 7, "se')  # a run that was cut off, and another that goes on
    assert len(bridges.FinishedSet(tmp_path / "set/m.jsonl")) == 2
    with (tmp_path / "set/m.jsonl").open("a") as manifest:
        manifest.write('\n{"member": 8, "seed": 1, "drawn": {}, "files": [5]}\n')
    assert len(bridges.FinishedSet(tmp_path / "set/m.jsonl")) == 2
    (tmp_path / "other.jsonl").write_text("{}\n")
    for wrong in ("none.jsonl", "other.jsonl"):
        with pytest.raises(ValueError, match=wrong):
            bridges.FinishedSet(tmp_path / wrong)


def test_a_finished_set_has_labels_and_variations(program, tmp_path):
    (tmp_path / "rough.json").write_text(json.dumps(ROUGH))
    program("synth", "rough.json", "--members", "0:2", "--vary", 0.3, "--labels", "--resolution", "16",
            "-o", "set/{member}.ply", "--manifest", "set/m.jsonl")  # fmt: skip
    made = bridges.FinishedSet(tmp_path / "set/m.jsonl", check=True)
    for item in made:
        count = len(item["vertices"])
        assert item["labels"].shape == (count,) and item["labels"].dtype == np.int32 and item["labels"].max() == 1
        assert item["elevations"].shape == (count,) and item["elevations"].dtype == np.float32
        assert 0 < item["variation"]["mean_distance"] <= item["variation"]["max_distance"]
    assert not np.array_equal(made[0]["vertices"], made[1]["vertices"])


def test_points_of_bodies_lie_on_them_and_are_uniform():
    bodies = bridges.Bodies([BALL], seeds=[1, 2], resolution=32, points=4000)
    points, normals = bodies[0]["points"] - np.array([1, 0, 0], np.float32), bodies[0]["point_normals"]
    assert points.shape == normals.shape == (4000, 3) and points.dtype == np.float32
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 2.0, atol=0.02)
    assert (np.einsum("ij,ij->i", points, normals) > 1.9).all()
    np.testing.assert_allclose(points.mean(axis=0), 0, atol=5 * 2 / np.sqrt(3 * 4000))
    assert not np.array_equal(points, bodies[1]["points"])


def test_torch_loads_batches_in_workers():
    torch = pytest.importorskip("torch")
    bodies = bridges.Bodies([ROUGH], seeds=range(4), resolution=16, points=32)
    dataset = bridges.torch_dataset(bodies)
    loader = torch.utils.data.DataLoader(dataset, batch_size=2, num_workers=1, multiprocessing_context="spawn")
    batches = list(loader)
    assert [b["points"].shape for b in batches] == [(2, 32, 3)] * 2
    assert (batches[1]["points"][1].numpy() == bodies[3]["points"]).all()


def test_height_maps_are_those_of_synth(example, program, tmp_path):
    rasterio = pytest.importorskip("rasterio")
    pytest.importorskip("xarray")
    mesh = astrolith.mesh(example("itokawa_details"), resolution=40)
    patch = (*mesh.vertices[mesh.vertices[:, 2].argmax()].astype(float).tolist(), 60.0)
    program("synth", example("itokawa_details"), "-o", "p.ply", "--patch", *patch, "--resolution", "32",
            "--height-map", "p.tif")  # fmt: skip
    made = astrolith.height_map(example("itokawa_details"), patch, resolution=32)
    bridges.write_geotiff(made, tmp_path / "q.tif")
    with rasterio.open(tmp_path / "p.tif") as p, rasterio.open(tmp_path / "q.tif") as q:
        assert p.read(1).tobytes() == made.heights.tobytes() and p.read(1).tobytes() == q.read(1).tobytes()
        assert p.transform.almost_equals(q.transform, 1e-9) and np.isnan(q.nodata)
        assert "up" in q.tags()
    array = bridges.to_xarray(made)
    assert array.dims == ("y", "x") and float(array.x[1] - array.x[0]) == pytest.approx(made.pixel)
    # Pixels placed by the attributes lie on the body.
    field = astrolith.Field(example("itokawa_details"))
    x, y = np.meshgrid(array.x[8:24], array.y[8:24])
    place = [np.array(array.attrs[name]) for name in ("origin_m", "right", "ahead", "up")]
    points = place[0] + x[..., None] * place[1] + y[..., None] * place[2] + array.values[8:24, 8:24, None] * place[3]
    points = points[np.isfinite(points).all(axis=2)]
    assert len(points) > 100 and np.abs(field.value(np.ascontiguousarray(points))).max() < made.pixel


@pytest.mark.parametrize("name, side", [("itokawa_details", 60.0), ("itokawa_relief", 0.06)])
def test_height_maps_are_in_metres(example, name, side):
    top = astrolith.mesh(example(name), resolution=40).vertices.astype(float)
    made = astrolith.height_map(example(name), (*top[top[:, 2].argmax()].tolist(), side), resolution=32)
    assert made.pixel == pytest.approx(60.0 / 32)
    assert 100.0 < made.origin[2] < 130.0


def test_an_aligned_map_is_full(example, program, tmp_path):
    top = astrolith.mesh(example("itokawa_details"), resolution=40).vertices.astype(float)
    patch = (*top[np.abs(top[:, 2] - top[:, 1]).argmin()].tolist(), 40.0)
    made = astrolith.height_map(example("itokawa_details"), patch, resolution=32, aligned=True)
    assert np.isfinite(made.heights).all()
    program("synth", example("itokawa_details"), "-o", "p.ply", "--patch", *patch, "--resolution", "32", "--aligned",
            "--height-map", "p.tif")
    frame = json.loads((tmp_path / "p.json").read_text())
    assert frame["pixels_without_data"] == 0 and frame["up"] == list(made.up)
    with pytest.raises(ValueError, match="^aligned requires patch"):
        astrolith.mesh(example("itokawa_details"), aligned=True)


def test_what_is_missing_is_named_with_the_extra():
    code = """
import sys
sys.modules.update(dict.fromkeys(("trimesh", "pyvista", "open3d", "torch", "xarray", "rasterio", "spiceypy")))
from astrolith import bridges
for call in (bridges.to_trimesh, bridges.to_pyvista, bridges.to_open3d, bridges.torch_dataset, bridges.to_xarray,
             lambda x: bridges.write_geotiff(x, "f.tif"), lambda x: bridges.write_dsk(x, "f", body=1, frame="J2000")):
    try:
        call(None)
    except ImportError as error:
        print(error)
"""
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert [line.split("pip install ")[1] for line in said.splitlines()] == [
        f"astrolith[{extra}]" for extra in ("trimesh", "pyvista", "open3d", "torch", "geo", "geo", "spice")
    ]


def test_bridges_load_nothing_before_it_is_needed():
    code = "import astrolith.bridges, sys; print([m for m in ('trimesh', 'torch', 'rasterio', 'spiceypy') if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"
