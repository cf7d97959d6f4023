"""Gravity: analytic truth, and the bytes of the program."""

import json
import types

import astrolith
import numpy as np
import pytest

G = 6.67430e-11
BALL = {"format_version": 1, "length_unit": "km", "body": {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0.3, 0.0, 0.0, 1.0]]}}
LAYERS = [{"type": "perlin", "amplitude": 0.1, "frequency": 1.0}]
CORNERS = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
CUBE = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
                 [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])  # fmt: skip


def test_a_cube_of_a_metre_has_its_mass_and_its_potential():
    made = astrolith.gravity((CORNERS, CUBE), 1000.0, unit="m", points=[[0.5, 0.5, 0.5], [1000.5, 0.5, 0.5]], exact=True)
    assert made.figures.values.potential_J_kg.min < 0
    assert made.figures.body.mass_kg == pytest.approx(1000.0) and made.figures.body.area_m2 == pytest.approx(6.0)
    # Waldvogel 1976: the potential at the centre of the unit cube is 3 ln((sqrt 3 + 1) / (sqrt 3 - 1)) - pi / 2.
    at_center = 3 * np.log((3**0.5 + 1) / (3**0.5 - 1)) - np.pi / 2
    np.testing.assert_allclose(made.potential, [-G * 1000 * at_center, -G * 1000 / 1000.0], rtol=1e-6)
    np.testing.assert_allclose(made.acceleration[1], [-G * 1000 / 1e6, 0, 0], rtol=1e-6, atol=1e-20)
    with pytest.raises(ValueError, match="^slope_deg: "):
        made.slope


def test_a_ball_has_gravity_of_a_point_level_ground_and_no_harmonics():
    made = astrolith.gravity(BALL, 2000.0, resolution=48, degree=3, at="vertices")
    mass = made.figures.body.mass_kg
    assert mass == pytest.approx(4 / 3 * np.pi * 1e9 * 2000, rel=0.01)
    np.testing.assert_allclose(made.figures.body.center_of_mass_m, [300, 0, 0], atol=1)
    np.testing.assert_allclose(made.effective_gravity, G * mass / 1e6, rtol=0.01)
    np.testing.assert_allclose(np.linalg.norm(made.acceleration, axis=1), made.effective_gravity, rtol=1e-14)
    assert made.slope.max() < 3 and np.abs(made.elevation).max() < 10
    assert made.coefficients.shape == (2, 4, 4) and made.coefficients[0, 0, 0] == pytest.approx(1)
    assert np.abs(made.coefficients.reshape(-1)[1:]).max() < 2e-3
    assert (made.geopotential == made.potential).all()


@pytest.mark.parametrize("at", ["facets", "vertices"])
def test_tables_have_the_bytes_of_gravity(example, program, tmp_path, at):
    mesh = astrolith.mesh(example("itokawa_details"), resolution=32)
    astrolith.write_mesh(mesh, tmp_path / "m.ply")
    said = json.loads(program("gravity", "m.ply", "-o", "g.npy", "--density", "1900", "--period", "12.132", "--at", at,
                              "--axis", "0.1", "0", "1", "--degree", "6", "--sample", "10", "--unit", mesh.length_unit, "--json"))  # fmt: skip
    made = astrolith.gravity(mesh, 1900.0, period=12.132, at=at, axis=(0.1, 0, 1), degree=6, sample=10)
    assert made.table.tobytes() == np.load(tmp_path / "g.npy").tobytes()
    assert made.table.tobytes() in (tmp_path / "g.npy").read_bytes()
    assert made.figures == {key: value for key, value in said.items() if key != "shape"}


def test_files_state_their_unit(tmp_path):
    ball, file = astrolith.mesh({**BALL, "length_unit": "m"}, resolution=16), tmp_path / "m.ply"
    astrolith.write_mesh(ball, file)
    assert astrolith.read_mesh(file).length_unit == "m"
    mass = astrolith.gravity(ball, 2000.0).figures.body.mass_kg
    assert astrolith.gravity(file, 2000.0).figures.body.mass_kg == pytest.approx(mass, rel=1e-6)
    with pytest.warns(UserWarning, match=r"^unit: .*m\.ply states m; it is taken in km, as the argument says") as warned:
        assert astrolith.gravity(file, 2000.0, unit="km").figures.body.mass_kg == pytest.approx(1e9 * mass, rel=1e-6)
    assert warned[0].filename == __file__
    in_km = astrolith.Mesh(ball.vertices / 1000, ball.faces, length_unit="km")
    compared = astrolith.compare(in_km, file, points=200, samples=500)
    assert compared.length_unit == "km" and compared.mean_distance < 1e-6
    with pytest.warns(UserWarning, match=r"^unit: .*m\.ply states m; it is taken in km") as warned:
        assert astrolith.compare(in_km, file, unit="km", points=200, samples=500).mean_distance > 1
    assert warned[0].filename == __file__


def test_units_of_unknown_length_scale_nothing():
    ball = astrolith.mesh(BALL, resolution=16)
    in_feet = astrolith.Mesh(ball.vertices, ball.faces, length_unit="ft")
    for a, b in ((ball, in_feet), (in_feet, ball)):
        with pytest.warns(UserWarning, match="^b: is in .*, and a in .*; nothing was scaled"):
            compared = astrolith.compare(a, b, points=200, samples=500)
        assert compared.length_unit == a.length_unit and compared.mean_distance < 1e-6


def test_a_trimesh_states_its_unit():
    ball = astrolith.mesh(BALL, resolution=16)
    mass = astrolith.gravity(ball, 2000.0).figures.body.mass_kg
    for word, share in (("kilometers", 1.0), ("km", 1.0), ("meters", 1e-9), (None, 1.0)):
        other = types.SimpleNamespace(vertices=ball.vertices, faces=ball.faces, units=word)
        assert astrolith.gravity(other, 2000.0).figures.body.mass_kg == pytest.approx(share * mass, rel=1e-6)
    other.units = "inches"
    with pytest.raises(ValueError, match="^unit: is missing; body states inches"):
        astrolith.gravity(other, 2000.0)


def test_recipes_and_points_have_the_bytes_of_gravity(example, program, tmp_path):
    points = np.array([[0.0, 0.0, 0.0], [0.5, 0.25, -0.125], [10.0, 0.0, 0.0]])
    np.savetxt(tmp_path / "points.txt", points)
    options = ["--density", "1900", "--resolution", "24", "--seed", "3"]
    program("gravity", example("itokawa_details"), "-o", "p.npy", "--points", "points.txt", *options)
    program("gravity", example("itokawa_details"), "-o", "f.npy", *options)
    made = astrolith.gravity(example("itokawa_details"), 1900.0, points=points, resolution=24, seed=3)
    assert made.table.tobytes() in (tmp_path / "p.npy").read_bytes()
    assert (made.points == points).all() and len(made.columns) == 9
    made = astrolith.gravity(astrolith.Recipe.read(example("itokawa_details")), 1900.0, resolution=24, threads=1)
    assert made.table.tobytes() in (tmp_path / "f.npy").read_bytes()


def test_landing_sites_are_those_of_gravity(example, program, tmp_path):
    program("gravity", example("itokawa_details"), "--density", "1900", "--resolution", "48", "--sites", "3",
            "--site-size", "60", "--summary", "s.json")  # fmt: skip
    made = astrolith.gravity(example("itokawa_details"), 1900.0, resolution=48, sites=3, site_size=60)
    assert made.sites == json.loads((tmp_path / "s.json").read_text())["sites"]
    assert len(made.sites) == 3 and made.sites[0].cost_deg <= made.sites[1].cost_deg
    far = astrolith.gravity(example("itokawa_details"), 1900.0, resolution=48, sites=3, site_size=60, site_distance=200)
    assert np.linalg.norm(np.subtract(far.sites[0].center, far.sites[1].center)) >= 200
    assert astrolith.gravity(BALL, 1000.0, resolution=16).sites == []
    with pytest.raises(ValueError, match="^site_size: .* is less than 4 edges of the mesh"):
        astrolith.gravity(BALL, 1000.0, resolution=16, sites=1, site_size=1e-3)


@pytest.mark.parametrize(
    "name, options",
    [
        ("density", {"density": 0.0}),
        ("density", {"density": float("nan")}),
        ("period", {"period": -1.0}),
        ("axis", {"axis": (0, 0, 0)}),
        ("unit", {"unit": "px"}),
        ("at", {"at": "edges"}),
        ("points", {"points": np.zeros((0, 3))}),
        ("points", {"points": [[0, 0, np.inf]]}),
        ("tolerance", {"tolerance": 1.0}),
        ("degree", {"degree": 51}),
        ("sites", {"sites": 1001, "site_size": 0.5}),
        ("sites", {"sites": -1}),
        ("sites", {"sites": 1, "site_size": 0.5, "at": "vertices"}),
        ("site_size", {"sites": 1}),
        ("site_size", {"site_size": 0.5}),
        ("site_distance", {"sites": 1, "site_size": 0.5, "site_distance": 0.0}),
    ],
)
def test_wrong_arguments(name, options):
    with pytest.raises(ValueError, match=f"^{name}: ") as raised:
        astrolith.gravity((CORNERS, CUBE), **{"density": 1000.0, **options})
    assert "\n" not in str(raised.value)


def test_wrong_bodies():
    with pytest.raises(ValueError, match="^body: .*open"):
        astrolith.gravity((CORNERS, CUBE[1:]), 1000.0)
    with pytest.warns(UserWarning, match="^body: turned 12 facets"):
        inside_out = astrolith.gravity((CORNERS, CUBE[:, ::-1].copy()), 1000.0)
    assert inside_out.figures.body.mass_kg == pytest.approx(astrolith.gravity((CORNERS, CUBE), 1000.0).figures.body.mass_kg)
    with pytest.raises(ValueError, match="^unit: "):
        astrolith.gravity(BALL, 1000.0, unit="m")
    with pytest.raises(ValueError, match="^body: .*without a body"):
        astrolith.gravity({"format_version": 1, "length_unit": "m", "layers": LAYERS}, 1000.0)
