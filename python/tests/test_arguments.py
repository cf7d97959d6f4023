"""Wrong arguments: a ValueError of one line that names the argument."""

import inspect
import os

import astrolith
import numpy as np
import pytest
from astrolith import bridges
from conftest import ROOT

BALL = {"format_version": 1, "length_unit": "m", "body": {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0.0, 0.0, 0.0, 1.0]]}}
VERTICES = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.uint32)


def refuse(name, call):
    with pytest.raises(ValueError) as raised:
        call()
    message = str(raised.value)
    assert message.startswith(name + ": ") and "\n" not in message
    return message


@pytest.mark.parametrize(
    "points",
    [
        np.zeros(3),
        np.zeros((4, 2)),
        np.zeros((2, 3, 3)),
        np.zeros((4, 3), np.complex128),
        np.zeros((4, 3), np.int64),
        np.zeros((4, 3), object),
        np.full((4, 3), np.nan),
        np.full((4, 3), np.inf),
        "points",
        None,
        [[0, 0], [0, 0, 0]],
    ],
)
def test_wrong_points(points):
    field = astrolith.Field(BALL)
    for call in (field.value, field.gradient, field.inside):
        refuse("points", lambda: call(points))


@pytest.mark.parametrize(
    "faces",
    [FACES.astype(float), FACES[:, :2].copy(), FACES.astype(np.int64) - 1, FACES + 1, FACES[:0]],
)
def test_wrong_faces(faces, tmp_path):
    for call in (
        lambda: astrolith.describe((VERTICES, faces)),
        lambda: astrolith.render((VERTICES, faces)),
        lambda: astrolith.write_mesh((VERTICES, faces), tmp_path / "m.ply"),
    ):
        refuse("mesh.faces", call)
    refuse("b.faces", lambda: astrolith.compare((VERTICES, FACES), (VERTICES, faces)))
    assert not list(tmp_path.iterdir())


def test_wrong_vertices():
    for vertices in (VERTICES[:0], VERTICES[:, :2].copy(), VERTICES * np.nan):
        refuse("mesh.vertices", lambda: astrolith.describe((vertices, FACES)))
    refuse("mesh", lambda: astrolith.describe(7))
    refuse("colors", lambda: astrolith.render((VERTICES, FACES), colors=np.zeros((3, 3))))


def test_numbers_out_of_range():
    refuse("resolution", lambda: astrolith.mesh(BALL, resolution=3))
    refuse("resolution", lambda: astrolith.mesh(BALL, resolution=20.5))
    refuse("triangles", lambda: astrolith.mesh(BALL, triangles=float("nan")))
    with pytest.raises(ValueError, match="^triangles excludes resolution"):
        astrolith.mesh(BALL, triangles=1000, resolution=20)
    refuse("patch", lambda: astrolith.mesh(BALL, patch=(0, 0, 0)))
    refuse("patch", lambda: astrolith.mesh(BALL, patch=(0, 0, 0, -1)))
    refuse("patch", lambda: astrolith.mesh(BALL, patch=(9, 0, 0, 0.1), resolution=8))
    refuse("tile", lambda: astrolith.mesh(BALL, tile="3/2"))
    with pytest.raises(ValueError, match="^patch excludes tile"):
        astrolith.mesh(BALL, tile=(1, 2), patch=(0, 0, 0, 1))
    refuse("seed", lambda: astrolith.mesh(BALL, seed=-1))
    refuse("threads", lambda: astrolith.mesh(BALL, threads=-1))
    refuse("sun", lambda: astrolith.render((VERTICES, FACES), sun=(0, 0, 0)))
    refuse("features", lambda: astrolith.describe((VERTICES, FACES), features="d3"))
    refuse("recipe", lambda: astrolith.mesh(7))
    refuse("recipe", lambda: astrolith.mesh({**BALL, "body": {"speres": []}}))


def test_arrays_of_any_layout_and_byte_order_are_taken():
    """A column of a larger table, a transposed array and one of the other byte order give what a plain copy gives."""
    points = np.random.default_rng(1).normal(size=(5, 3))
    field = astrolith.Field(BALL)
    expected = field.value(points)
    wide = np.zeros((5, 6))
    wide[:, ::2] = points
    for same in (wide[:, ::2], np.asfortranarray(points), points.astype(">f8"), points.tolist(), points[::-1].copy()[::-1]):
        assert (field.value(same) == expected).all()
    mesh = astrolith.mesh(BALL, resolution=16, labels=True)
    other = astrolith.Mesh(
        np.asfortranarray(mesh.vertices), mesh.faces.astype(">u4"), mesh.normals.astype(">f4"), labels=mesh.labels.astype(">i4"),
        elevations=np.repeat(mesh.elevations, 2)[::2], length_unit="m", comment=mesh.comment, legend=mesh.legend,
    )  # fmt: skip
    assert astrolith.describe(other, points=100).histogram.tobytes() == astrolith.describe(mesh, points=100).histogram.tobytes()


def test_labels_of_any_layout_are_written(tmp_path):
    mesh = astrolith.mesh(BALL, resolution=16, labels=True)
    astrolith.write_mesh(mesh, tmp_path / "a.ply")
    mesh.labels, mesh.elevations = mesh.labels.astype(">i4"), np.repeat(mesh.elevations, 2)[::2]
    mesh.faces, mesh.vertices = np.asfortranarray(mesh.faces), mesh.vertices.astype(">f4")
    astrolith.write_mesh(mesh, tmp_path / "b.ply")
    assert (tmp_path / "a.ply").read_bytes() == (tmp_path / "b.ply").read_bytes()


def test_names_of_files_are_taken_as_python_takes_them(tmp_path):
    mesh = astrolith.mesh(BALL, resolution=16)
    recipe = astrolith.Recipe.from_dict(BALL)
    folder = os.fsencode(tmp_path)
    for name in (folder + b"/plain.ply", folder + b"/latin \xe9.ply", os.fsdecode(folder + b"/\xff.ply")):
        astrolith.write_mesh(mesh, name)
        assert os.path.getsize(name) > 1000
        assert len(astrolith.read_mesh(name).faces) == len(mesh.faces)
        assert astrolith.describe(name, points=100).points == 100
        assert astrolith.compare(name, name, points=100, samples=100).max_distance < 1e-6
        assert astrolith.gravity(name, 2000.0, sample=0).figures.facets == len(mesh.faces)
    for name in (folder + b"/a \xe9.json", os.fsdecode(folder + b"/\xff.astro")):
        recipe.write(name)
        assert astrolith.Recipe.read(name) == recipe
        assert len(astrolith.mesh(name, resolution=16).faces) == len(mesh.faces)


def test_a_name_with_nul_replaces_no_file(tmp_path):
    kept = tmp_path / "keep"
    kept.write_bytes(b"mine")
    mesh = astrolith.mesh(BALL, resolution=16)
    for name in (f"{kept}\0.ply", os.fsencode(kept) + b"\0.ply"):
        assert "no file's name has" in refuse("file", lambda: astrolith.write_mesh(mesh, name))
        refuse("file", lambda: astrolith.read_mesh(name))
        refuse("mesh", lambda: astrolith.describe(name))
        refuse("recipe", lambda: astrolith.mesh(name))
        refuse("file", lambda: astrolith.Recipe.from_dict(BALL).write(name))
    assert kept.read_bytes() == b"mine" and [file.name for file in tmp_path.iterdir()] == ["keep"]


def test_missing_files_are_file_not_found_errors(tmp_path):
    image = {"type": "exemplar", "image": "no.png", "image_sha256": "0" * 64, "pixel_size": 1.0, "height_rms": 0.1}
    for call in (
        lambda: astrolith.read_mesh(tmp_path / "no.ply"),
        lambda: astrolith.describe(str(tmp_path / "no.ply")),
        lambda: astrolith.Recipe.read(tmp_path / "no.json"),
        lambda: astrolith.mesh(tmp_path / "no.json"),
        lambda: astrolith.mesh({**BALL, "layers": [image]}, resolution=16),
        lambda: bridges.FinishedSet(tmp_path / "no.jsonl"),
    ):
        with pytest.raises(FileNotFoundError, match="no.*; check the name") as raised:
            call()
        assert isinstance(raised.value, ValueError) and raised.value.errno == 2
    (tmp_path / "empty.ply").write_bytes(b"")
    with pytest.raises(ValueError) as raised:
        astrolith.read_mesh(tmp_path / "empty.ply")
    assert not isinstance(raised.value, OSError)


ODD = [None, 7, -1.5, float("nan"), "x", "\ud800", b"x", "", [], [None], {}, object(), lambda: 7, np.zeros((2, 2)), 2**70]


MESH_OPTIONS = ["resolution", "triangles", "patch", "aligned", "tile", "seed", "min_component", "labels", "even", "finer", "fill_unseen",
                "gravity", "members", "device"]  # fmt: skip


def public_calls():
    """Each public function with arguments that suit it."""
    mesh, recipe = (VERTICES, FACES), astrolith.Recipe.from_dict(BALL)
    yield astrolith.mesh, {"recipe": BALL, "resolution": 4}
    yield astrolith.predict, {"recipe": BALL, "resolution": 4}
    yield astrolith.describe, {"mesh": mesh, "points": 16}
    yield astrolith.compare, {"a": mesh, "b": mesh, "points": 16, "samples": 100}
    yield astrolith.describe_surface, {"mesh": mesh}
    yield astrolith.find_craters, {"mesh": mesh}
    yield astrolith.realism, {"a": mesh, "b": mesh}
    yield astrolith.gravity, {"body": mesh, "density": 1.0, "sample": 0}
    yield astrolith.render, {"mesh": mesh, "width": 16, "height": 16}
    yield astrolith.texture, {"recipe": str(ROOT / "synthesis/examples/photo_textures.json"), "width": 8, "height": 8}
    yield astrolith.height_map, {"recipe": BALL, "patch": (0.0, 0.0, 1.0, 0.5), "resolution": 4}
    yield astrolith.vary, {"recipe": {**BALL, "body": None}, "delta": 0.3}
    yield astrolith.read_mesh, {"file": "absent.ply"}
    yield astrolith.write_mesh, {"mesh": mesh, "file": "absent/m.ply"}
    yield astrolith.Field(BALL).value, {"points": VERTICES}
    yield astrolith.Recipe.from_json, {"text": recipe.to_json()}
    yield astrolith.Recipe.from_dict, {"fields": BALL}
    yield astrolith.Recipe.read, {"file": "absent.json"}
    yield recipe.to_json, {}
    yield recipe.laid_on, {"base": BALL}
    yield recipe.finished, {"body": "itokawa", "to": 1.0}


@pytest.mark.parametrize("call, suits", list(public_calls()), ids=lambda given: getattr(given, "__qualname__", ""))
def test_wrong_arguments_are_named(call, suits, tmp_path, monkeypatch):
    """Whatever is passed for one argument: it is taken, or the error is one line with the argument's name in it."""
    monkeypatch.chdir(tmp_path)
    names = list(inspect.signature(call).parameters)
    if "options" in names:
        names[names.index("options") :] = MESH_OPTIONS
    for name in names:
        for odd in ODD:
            if name == "progress" and callable(odd):
                continue  # what it raises is its own
            try:
                call(**{**suits, name: odd})
            except (ValueError, TypeError, RuntimeError) as error:
                said = str(error)
                assert "incompatible function arguments" not in said and "\n" not in said, (name, odd, said)
                named = (*suits, name, "recipe", "finish", "site_size", "texture size", "absent", "x")  # the last two are names of files
                assert isinstance(error, RuntimeError) or said.startswith(named), (name, odd, said)
