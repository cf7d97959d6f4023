#!/usr/bin/env python3
"""Reads the maps of `synth --preview-maps` with numpy and holds them to the mesh and to the feature list.

    preview_maps_test.py SYNTH
"""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is not installed")
    sys.exit(77)

RECIPE = """{"format_version": 1, "length_unit": "m",
 "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100], [80, 0, 0, 60]]},
 "layers": [{"type": "simplex", "amplitude": 1, "frequency": 0.01, "octaves": 2},
  {"type": "craters", "craters": [{"direction": [0, 0, 1], "diameter": 60},
                                  {"direction": [0.1, 0, 1], "diameter": 25}]},
  {"type": "boulders", "boulders": [{"direction": [0.3, -1, 0.4], "axes": [30, 22, 18]},
                                    {"direction": [1, -0.4, 0.1], "axes": [20, 15, 12]}]}]%s}"""
FAMILY = ', "family": {"any_view": true, "fields": []}'


def run(synth, *arguments):
    done = subprocess.run([synth, *map(str, arguments)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def read_ply(file):
    """Vertices, their normals and the triangles of a binary PLY file that synth wrote."""
    data = file.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    words = [line.split() for line in data[:end].decode().splitlines()]
    counts = {w[1]: int(w[2]) for w in words if w[0] == "element"}
    columns = [w[2] for w in words if w[:2] == ["property", "float"]]
    vertices = np.frombuffer(data, "<f4", len(columns) * counts["vertex"], end).reshape(-1, len(columns))
    faces = np.frombuffer(data, [("n", "u1"), ("v", "<i4", 3)], counts["face"], end + vertices.nbytes)
    at = lambda names: vertices[:, [columns.index(n) for n in names]].astype(float)
    return at(["x", "y", "z"]), at(["nx", "ny", "nz"]), faces["v"]


def points_of(maps, rows, columns):
    """Where the pixels' rays begin, and their directions, as docs/datasets.md states."""
    view = maps["view"][rows, columns]
    right, up, origin = maps["right"][view], maps["up"][view], maps["corner"][view]
    pixel = maps["pixel"]
    plane = origin + ((columns + 0.5) * pixel)[:, None] * right - ((rows + 0.5) * pixel)[:, None] * up
    eye = maps["eye"][view]
    if np.isnan(eye).all():
        return plane, -maps["from"][view]
    return eye, (plane - eye) / np.linalg.norm(plane - eye, axis=1)[:, None]


def first_hit(begin, along, vertices, normals, faces):
    """Depth and interpolated normal where a ray meets the mesh first; nothing where it misses."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    p = np.cross(along, c - a)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = 1.0 / np.einsum("ij,ij->i", b - a, p)
        u = np.einsum("ij,ij->i", begin - a, p) * scale
        q = np.cross(begin - a, b - a)
        v = q @ along * scale
        depth = np.einsum("ij,ij->i", c - a, q) * scale
        hit = np.flatnonzero((u >= 0) & (v >= 0) & (u + v <= 1) & (depth > 0))
    if not len(hit):
        return None
    k = hit[np.argmin(depth[hit])]
    corners = normals[faces[k]]
    normal = (1 - u[k] - v[k]) * corners[0] + u[k] * corners[1] + v[k] * corners[2]
    return depth[k], normal / np.linalg.norm(normal)


def check_geometry(maps, mesh):
    rng = np.random.default_rng(1)
    height, width = maps["depth"].shape
    rows, columns = rng.integers(0, height, 400), rng.integers(0, width, 400)
    begin, along = points_of(maps, rows, columns)
    hits = misses = 0
    for i, (row, column) in enumerate(zip(rows, columns)):
        found = first_hit(begin[i], along[i], *mesh)
        depth = maps["depth"][row, column]
        assert (found is None) == np.isnan(depth), (row, column, found, depth)
        if found is None:
            misses += 1
            assert not maps["normal"][row, column].any()
            continue
        hits += 1
        # A thousandth of a pixel, where single precision of rays resolves a ten-thousandth.
        assert abs(found[0] - depth) < 1e-3 * maps["pixel"], (row, column, found[0], depth)
        # A patch is open, and its surface may be seen from below. Normals are turned to the viewer there.
        assert abs(found[1] @ maps["normal"][row, column]) > 0.9999
    assert min(hits, misses) > 20, (hits, misses)


def check_features(maps, features):
    seen = np.argwhere(~np.isnan(maps["depth"]))
    begin, along = points_of(maps, seen[:, 0], seen[:, 1])
    points = begin + maps["depth"][tuple(seen.T)][:, None] * along
    instance, layer = maps["instance"][tuple(seen.T)], maps["layer"][tuple(seen.T)]
    assert (maps["instance"][np.isnan(maps["depth"])] == -1).all()
    assert (maps["layer"][np.isnan(maps["depth"])] == -1).all() and (layer >= 0).all()
    assert set(instance) == {-1, *range(len(features))}
    center = np.array([[float(f[f"center_{c}"]) for c in "xyz"] for f in features])
    diameter = np.array([float(f["diameter"]) for f in features])
    distance = np.linalg.norm(points[:, None] - center, axis=2)
    for k, feature in enumerate(features):
        mine = instance == k
        assert distance[mine, k].max() < 0.55 * diameter[k], (k, distance[mine, k].max())
        if feature["kind"] == "boulder":
            # At its foot a boulder changes the surface less than the simplex noise does.
            share = (layer[mine] == int(feature["layer"]) + 1).mean()
            assert share > 0.8, share
    # The younger crater lies within the older one, and hides it there.
    assert (instance[distance[:, 1] < 0.45 * diameter[1]] == 1).all()
    assert (instance[(distance[:, 0] < 0.45 * diameter[0]) & (distance[:, 1] > 0.55 * diameter[1])] == 0).all()
    # The top of each boulder is that boulder's.
    top = np.array([[float(f[c]) for c in "xyz"] for f in features])
    for k in (2, 3):
        assert (instance[np.linalg.norm(points - top[k], axis=1) < 2.0] == k).all()


def main():
    synth = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        recipe = folder / "recipe.json"
        recipe.write_text(RECIPE % "")
        options = ["--resolution", 48, "--preview", folder / "p.png", "--feature-list", folder / "f.csv"]
        for threads in (1, 2):
            maps = folder / f"{threads}.npz"
            run(synth, recipe, "-o", folder / "b.ply", *options, "--preview-maps", maps, "--threads", threads)
        assert (folder / "1.npz").read_bytes() == (folder / "2.npz").read_bytes()
        maps = dict(np.load(folder / "1.npz"))
        assert maps["depth"].dtype == np.float32 and maps["normal"].shape == (*maps["depth"].shape, 3)
        check_geometry(maps, read_ply(folder / "b.ply"))
        check_features(maps, list(csv.DictReader((folder / "f.csv").open())))

        # A pinhole, and maps of a size of their own.
        camera = ["--camera", "lat 30 lon -60 fov 40 radii 3", "--maps-size", "200x150", "--preview-maps", folder / "d.npz"]
        run(synth, recipe, "-o", folder / "b.ply", *options, *camera)
        maps = dict(np.load(folder / "d.npz"))
        assert maps["depth"].shape == (150, 200)
        check_geometry(maps, read_ply(folder / "b.ply"))

        # In a patch, points are relative to its centre, as the mesh is.
        cube = ["--patch", 0, 0, 95, 60]
        run(synth, recipe, "-o", folder / "c.ply", *options, "--preview-maps", folder / "c.npz", *cube)
        maps = dict(np.load(folder / "c.npz"))
        check_geometry(maps, read_ply(folder / "c.ply"))
        assert set(np.unique(maps["instance"])) == {-1, 0, 1}

        recipe.write_text(RECIPE % FAMILY)
        run(synth, recipe, "--members", "0:2", "-o", folder / "{member}.ply", "--manifest", folder / "m.jsonl",
            "--preview", folder / "{member}.png", "--preview-maps", folder / "{member}.npz", "--resolution", 32)  # fmt: skip
        for line in map(json.loads, (folder / "m.jsonl").read_text().splitlines()):
            files = [file["name"] for file in line["files"]]
            assert f"{line['member']:07}.npz" in files, files
            maps = np.load(folder / f"{line['member']:07}.npz")
            assert np.allclose(maps["from"], [line["view"]])
    print("preview maps: depth, normals, layers and instances agree with the mesh and the feature list")


if __name__ == "__main__":
    main()
