"""Scenes: cameras against the written formula, ranges against the triangles, bodies with poses, and what is refused."""

import re
import threading

import astrolith
import numpy as np
import pytest
from conftest import ROOT
from test_surface import sphere

SUN = (1.0, 0.4, 0.3)


@pytest.fixture(scope="module")
def ball():
    """A sphere of radius 1 with a normal albedo of .05."""
    return astrolith.Scene(sphere(60), albedo=0.05)


def camera(**changes):
    return astrolith.Camera(96, 64, 150.0, **changes).look_at((4.0, 0.0, 0.0), (0.0, 0.0, 0.0))


def distorted(camera, matrix, points):
    """Brown's distortion, as OpenCV writes it."""
    x, y, z = matrix @ (np.asarray(points) - camera.position).T
    x, y, r2 = x / z, y / z, (x * x + y * y) / z**2
    k1, k2, p1, p2, k3 = camera.distortion
    s = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
    u = x * s + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    v = y * s + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    return np.stack([camera.fx * u + camera.skew * v + camera.cx, camera.fy * v + camera.cy], axis=1)


def test_a_camera_follows_the_formula():
    q = np.array([0.8, 0.1, -0.5, 0.3]) / np.linalg.norm([0.8, 0.1, -0.5, 0.3])
    given = dict(fx=800.0, fy=810.0, cx=310.0, cy=242.0, skew=2.0, distortion=(-0.28, 0.09, 0.001, -0.0007, -0.01))
    made = astrolith.Camera(640, 480, position=(1.0, 2.0, 3.0), rotation=q, **given)
    w, x, y, z = q
    matrix = np.array(  # the quaternion's matrix, as spiceypy.q2m has it
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    seen = np.array([[0.3, -0.2, 1.0], [-0.3, 0.25, 1.0], [0.0, 0.0, 1.0]]) * [[2.0], [50.0], [7.0]]
    points = seen @ matrix + made.position
    np.testing.assert_allclose(made.project(points), distorted(made, matrix, points), atol=1e-9)
    spice = astrolith.Camera(640, 480, position=(1.0, 2.0, 3.0), rotation=matrix.T, axes="spice", **given)
    np.testing.assert_allclose(spice.project(points), made.project(points), atol=1e-9)
    assert np.isnan(made.project(made.position - seen @ matrix)).all()


def test_pixels_show_the_points_that_project_to_them(ball):
    made = ball.image(camera(), SUN)
    row, column = np.nonzero(made.body == 0)
    depth = made.depth[row, column]
    disk = np.pi * (150 / np.sqrt(15)) ** 2  # pixels of the whole disk, of which the picture's height shows most
    assert 0.85 * disk < len(row) < disk and 3.0 <= depth.min() < 3.01
    along = np.stack([-np.ones(len(row)), (column - 47.5) / 150, -(row - 31.5) / 150], axis=1)
    points = [4.0, 0, 0] + depth[:, None] * along
    np.testing.assert_allclose(camera().project(points), np.stack([column, row], axis=1), atol=1e-9)
    ranges = ball.ranges((4.0, 0.0, 0.0), along)
    np.testing.assert_allclose(ranges.range, depth * np.linalg.norm(along, axis=1), rtol=1e-13)
    assert (ranges.facet == made.facet[row, column]).mean() > 0.98  # some pixels are on edges


def test_light_is_that_of_the_law(ball):
    sun = np.array(SUN) / np.linalg.norm(SUN)
    for law, value in (("lambert", lambda m0, m: m0), ("lommel-seeliger", lambda m0, m: 2 * m0 / (m0 + m))):
        made = ball.image(camera(), SUN, reflectance=law)
        m0, m = np.cos(np.radians([made.incidence, made.emission]))
        np.testing.assert_allclose(made.normal @ sun, m0, atol=1e-6)
        lit = (m0 > 0.05) & (m > 0.05)
        np.testing.assert_allclose(made.radiance[lit], 0.05 * value(m0, m)[lit], rtol=1e-4)
        assert (made.radiance[m0 < 0] == 0).all() and (made.radiance[made.body < 0] == 0).all()
    fine = ball.image(camera(), SUN, reflectance="lambert", oversampling=4)
    assert fine.radiance.sum() == pytest.approx(ball.image(camera(), SUN, reflectance="lambert").radiance.sum(), rel=5e-3)


def test_bodies_move_and_eclipse():
    large, (vertices, faces) = sphere(40), sphere(20)
    scene = astrolith.Scene([large, (0.2 * vertices, faces)])
    scene.pose(1, position=(2.0, 0.8, 0.6))
    dark = scene.image(camera(), SUN).radiance.sum()
    scene.pose(1, position=(0.0, 50.0, 0.0))
    assert dark < 0.99 * scene.image(camera(), SUN).radiance.sum()
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    scene.pose(0, rotation=turn, position=(10.0, 0, 0))
    moved = scene.ranges([[20.0, 0.1, 0.2]], [[-1.0, 0, 0]])
    scene.pose(0)
    assert moved.range == pytest.approx(scene.ranges(turn.T @ [10.0, 0.1, 0.2], [turn.T @ [-1.0, 0, 0]]).range, rel=1e-14)


def test_threads_do_not_change_the_arrays(ball):
    one, two = (ball.image(camera(), SUN, oversampling=2, threads=n) for n in (1, 2))
    for name in vars(one):
        np.testing.assert_array_equal(getattr(one, name), getattr(two, name))
    rays = np.random.default_rng(1).standard_normal((5000, 3))
    first, second = (ball.ranges((0.0, 0.0, 3.0), rays, noise=0.1, beam=1.0, threads=n) for n in (1, 2))
    np.testing.assert_array_equal(first.range, second.range)
    made = [None] * 4
    workers = [threading.Thread(target=lambda k=k: made.__setitem__(k, ball.image(camera(), SUN))) for k in range(4)]
    [worker.start() for worker in workers], [worker.join() for worker in workers]
    for image in made:
        np.testing.assert_array_equal(image.radiance, made[0].radiance)


def test_ranges_are_those_of_spice(tmp_path):
    spice = pytest.importorskip("spiceypy")
    vertices, faces = sphere(30, noise=0.02)
    body = astrolith.Mesh(vertices, faces, length_unit="km")
    file = tmp_path / "ball.bds"
    astrolith.bridges.write_dsk(body, file, body=2000001, frame="J2000")
    handle = spice.dasopr(str(file))
    try:
        descriptor = spice.dlabfs(handle)
        rng = np.random.default_rng(1)
        origins = 5.0 * (lambda v: v / np.linalg.norm(v, axis=1)[:, None])(rng.standard_normal((500, 3)))
        directions = rng.uniform(-0.5, 0.5, (500, 3)) - origins
        made = astrolith.Scene((vertices, faces)).ranges(origins, directions)
        for k, (origin, direction) in enumerate(zip(origins, directions)):
            plate, point, found = spice.dskx02(handle, descriptor, origin, direction)
            assert found and plate == made.facet[k] + 1
            assert np.linalg.norm(point - origin) == pytest.approx(made.range[k], rel=1e-9)
            angle = spice.vsep(spice.dskn02(handle, descriptor, plate), -direction)
            assert np.degrees(angle) == pytest.approx(made.incidence[k], abs=1e-4)
    finally:
        spice.dascls(handle)


def test_a_recipe_is_meshed():
    body = {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0, 0, 0, 1]]}
    scene = astrolith.Scene({"format_version": 1, "length_unit": "km", "body": body}, resolution=24)
    assert scene.ranges((9.0, 0, 0), [[-1.0, 0, 0]]).range == pytest.approx(8.0, abs=0.2)
    assert repr(scene) == "<astrolith.Scene: 1 body>"
    # The albedo of its ground, from the colours of its mesh.
    made = astrolith.Scene("bennu", albedo="bennu", resolution=48).image(astrolith.Camera(64, 64, 150.0).look_at((1, 0, 0), (0, 0, 0)), (1, 0, 0))
    assert 0.03 < np.median(made.radiance[made.body == 0]) < 0.06


def test_the_descent_of_the_page_ends_above_the_ground(capsys):
    page = (ROOT / "docs" / "cameras.md").read_text()
    (code,) = [code for mark, code in re.findall(r"(<!-- not run.*?-->\n)?```python\n(.*?)```", page, re.DOTALL) if not mark]
    exec(compile(code.replace("triangles=2e5", "resolution=48"), "cameras.md", "exec"), {})
    count, altitude = re.match(r"(\d+) pictures, \d+ steps; ([\d.]+) m above", capsys.readouterr().out).groups()
    assert int(count) == 8 and 19 < float(altitude) < 20


@pytest.mark.parametrize(
    "words, call",
    [
        ("sun: 0 0 0 is no direction", lambda s: s.image(camera(), (0, 0, 0))),
        ("inside body 0", lambda s: s.image(astrolith.Camera(8, 8, 8.0), SUN)),
        ("camera.width: must be from 1 to 16384", lambda s: s.image(astrolith.Camera(0, 8, 8.0), SUN)),
        ("distortion folds", lambda s: s.image(camera(distortion=[-9.0]), SUN)),
        ("camera: rotation: is no rotation", lambda s: s.image(astrolith.Camera(8, 8, 8.0, rotation=np.ones((3, 3))), SUN)),
        ("the quaternion has the length 2", lambda s: s.pose(rotation=(2, 0, 0, 0))),
        ("mirrors", lambda s: s.pose(rotation=np.diag([1, 1, -1]))),
        ("camera.axes: must be one of opencv, spice", lambda s: s.image(astrolith.Camera(8, 8, 8.0, axes="x"), SUN)),
        ("body: must be from 0 to 0", lambda s: s.pose(1)),
        ("row 0 is 0 0 0", lambda s: s.ranges((9.0, 0, 0), [[0.0, 0, 0]])),
        ("2 origins and 3 directions", lambda s: s.ranges(np.ones((2, 3)), np.ones((3, 3)))),
        ("beam: must be from 0 to 10", lambda s: s.ranges((9.0, 0, 0), [[1.0, 0, 0]], beam=11)),
        ("is no law of reflection", lambda s: s.image(camera(), SUN, reflectance="shiny")),
        ("albedo: has the shape", lambda s: astrolith.Scene(sphere(8), albedo=[0.1, 0.2])),
        ("is a word for recipes", lambda s: astrolith.Scene(sphere(8), albedo="bennu")),
        ("resolution: are for recipes", lambda s: astrolith.Scene(sphere(8), resolution=9)),
        ("up: is along the boresight", lambda s: camera().look_at((0, 0, 4), (0, 0, 0))),
    ],
)
def test_what_cannot_be_is_refused(ball, words, call):
    with pytest.raises(ValueError, match=words) as refusal:
        call(ball)
    assert "\n" not in str(refusal.value)


def test_a_detector_spreads_counts_and_adds_noise():
    radiance = np.zeros((40, 60))
    radiance[20, 30] = 0.5
    sharp = astrolith.expose(radiance, bits=8)
    assert sharp.dtype == np.uint16 and sharp[20, 30] == 128 and sharp.sum() == 128
    wide = astrolith.expose(100 * radiance, spread=2.0, white=100.0, bits=16).astype(float)
    assert abs(wide.sum() - 32768) < 40  # the light is spread, not lost
    away = np.hypot(*(np.indices(wide.shape) - np.array([20, 30])[:, None, None]))
    assert np.sqrt((wide * away**2).sum() / wide.sum() / 2) == pytest.approx(2.0, rel=0.02)
    flat = np.full((200, 200), 0.25)
    noisy = astrolith.expose(flat, shot_noise=True, read_noise=20.0, full_well=40000.0, bits=16, seed=3)
    electrons = noisy / 65535 * 40000
    assert electrons.mean() == pytest.approx(10000, rel=1e-3)
    assert electrons.std() == pytest.approx(np.sqrt(10000 + 400), rel=0.02)
    assert (noisy == astrolith.expose(flat, shot_noise=True, read_noise=20.0, full_well=40000.0, bits=16, seed=3)).all()
    assert astrolith.expose([[7.0]], bits=10)[0, 0] == 1023
    for name, call in (
        ("radiance", lambda: astrolith.expose([[-1.0]])),
        ("bits", lambda: astrolith.expose(flat, bits=17)),
        ("spread", lambda: astrolith.expose(flat, spread=-1.0)),
    ):
        with pytest.raises(ValueError, match=name):
            call()


STONY = {
    "format_version": 1,
    "length_unit": "m",
    "seed": 3,
    "origin": [1000.0, 0.0, 0.0],
    "albedo": {"normal": 0.05},
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100], [90, 0, 0, 70]]},
    "layers": [
        {"type": "simplex", "amplitude": 2.0, "frequency": 0.02, "octaves": 6},
        {
            "type": "boulders",
            "population": {"density": 0.5, "least_diameter": 0.5, "greatest_diameter": 5, "exponent": 2.5, "by_cells": True},
        },
    ],
}


def above(scene, height, **changes):
    """A camera this far above the ground below (1000, 0, 300)."""
    top = scene.ranges((1000.0, 0.0, 300.0), [[0.0, 0.0, -1.0]]).range[0]
    place = np.array([1000.0, 0.0, 300.0 - top])
    return astrolith.Camera(64, 64, 80.0, **changes).look_at(place + (0.0, 0.1 * height, height), place, up=(1, 0, 0))


def test_detail_follows_the_camera():
    scene = astrolith.Scene(STONY, detail=2.0)
    far = above(scene, 900.0)
    assert scene.look(far) > 1.0
    near = above(scene, 20.0)
    assert 0.25 < scene.look(near) / (2.0 * 20.0 / 80.0) <= 1.2
    image = scene.image(near, SUN, threads=2)
    assert (image.body == 0).all()  # no gap between two levels
    fresh = astrolith.Scene(STONY, detail=2.0).image(near, SUN, threads=1)
    for name in ("radiance", "depth", "facet"):
        np.testing.assert_array_equal(getattr(fresh, name), getattr(image, name))
    # The law's value from above is 1/2; the brightest ground has its albedo, whatever its slope.
    assert 0.03 < np.percentile(image.radiance, 99) < 0.08


def test_detail_lies_on_the_surface():
    plain = {**STONY, "layers": STONY["layers"][:1]}
    scene = astrolith.Scene(plain, detail=1.0)
    camera = above(scene, 30.0)
    cell = scene.look(camera)
    image = scene.image(camera, SUN)
    row, column = np.nonzero(image.body == 0)
    x, y = (column - 31.5) / 80.0, (row - 31.5) / 80.0
    seen = np.stack([x, y, np.ones_like(x)], axis=1) * image.depth[row, column, None]
    points = seen @ np.asarray(camera.rotation) + camera.position
    assert np.abs(astrolith.Field(plain).value(points)).max() < 0.1 * cell


def test_detail_keeps_poses_and_several_bodies():
    scene = astrolith.Scene([STONY, sphere(20)], detail=2.0, albedo=["bennu", 0.1])
    quarter = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    scene.pose(0, rotation=quarter, position=(10.0, 0.0, 0.0))
    camera = astrolith.Camera(32, 32, 40.0).look_at((10.0, 1000.0, 130.0), (10.0, 1000.0, 0.0), up=(1, 0, 0))
    assert scene.look(camera) < 2.0
    image = scene.image(camera, SUN)
    assert (image.body == 0).all()
    assert 0.01 < np.median(image.radiance[image.radiance > 0]) < 0.1


@pytest.mark.parametrize(
    "arguments, words",
    [
        (dict(detail=40), "detail"),
        (dict(detail=2, triangles=1000), "triangles: are for recipes that are meshed once"),
        (dict(detail=2, albedo="mars"), "albedo: there is none of mars"),
    ],
)
def test_detail_refuses(arguments, words):
    with pytest.raises(ValueError, match=words):
        astrolith.Scene(STONY, **arguments)


def test_detail_refuses_meshes_and_erosion():
    with pytest.raises(ValueError, match="detail: is for recipes"):
        astrolith.Scene(sphere(10), detail=2)
    with pytest.raises(ValueError, match="erosion: acts on a whole mesh"):
        astrolith.Scene({**STONY, "erosion": {"talus_angle": 30}}, detail=2)
