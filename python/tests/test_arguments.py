"""Wrong arguments: a ValueError of one line that names the argument."""

import astrolith
import numpy as np
import pytest

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
        np.zeros((3, 4)).T,
        np.zeros((4, 6))[:, ::2],
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
    [FACES.astype(float), FACES[:, :2].copy(), FACES.astype(np.int64) - 1, FACES + 1, FACES[:0], FACES[:, ::-1]],
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
    for vertices in (VERTICES[:0], VERTICES[:, :2].copy(), VERTICES * np.nan, np.asfortranarray(VERTICES)):
        refuse("mesh.vertices", lambda: astrolith.describe((vertices, FACES)))
    refuse("mesh", lambda: astrolith.describe(7))
    refuse("colors", lambda: astrolith.render((VERTICES, FACES), colors=np.zeros((3, 3))))


def test_numbers_out_of_range():
    refuse("resolution", lambda: astrolith.mesh(BALL, resolution=3))
    refuse("resolution", lambda: astrolith.mesh(BALL, resolution=20.5))
    refuse("triangles", lambda: astrolith.mesh(BALL, triangles=float("nan")))
    refuse("triangles", lambda: astrolith.mesh(BALL, triangles=1000, resolution=20))
    refuse("patch", lambda: astrolith.mesh(BALL, patch=(0, 0, 0)))
    refuse("patch", lambda: astrolith.mesh(BALL, patch=(0, 0, 0, -1)))
    refuse("patch", lambda: astrolith.mesh(BALL, patch=(9, 0, 0, 0.1), resolution=8))
    refuse("tile", lambda: astrolith.mesh(BALL, tile="3/2"))
    refuse("tile", lambda: astrolith.mesh(BALL, tile=(1, 2), patch=(0, 0, 0, 1)))
    refuse("seed", lambda: astrolith.mesh(BALL, seed=-1))
    refuse("threads", lambda: astrolith.mesh(BALL, threads=-1))
    refuse("sun", lambda: astrolith.render((VERTICES, FACES), sun=(0, 0, 0)))
    refuse("features", lambda: astrolith.describe((VERTICES, FACES), features="d3"))
    refuse("recipe", lambda: astrolith.mesh(7))
    refuse("recipe", lambda: astrolith.mesh({**BALL, "body": {"speres": []}}))
