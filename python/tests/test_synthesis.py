"""Recipes, fields, meshes and textures: analytic truth, and the bytes of the programs."""

import copy
import json
import pickle
import tracemalloc

import astrolith
import numpy as np
import pytest
from conftest import WORM

BALL = {"format_version": 1, "length_unit": "m", "body": {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[1.0, 0.0, 0.0, 2.0]]}}


@pytest.fixture
def ball():
    return astrolith.Recipe.from_dict(BALL)


def test_the_field_of_a_ball_is_the_distance_from_its_surface(ball):
    points = np.array([[1.0, 0.0, 0.0], [1.0, 2.0, 0.0], [1.0, 0.0, 2.1], [1.0, 0.0, -1.9]])
    field = astrolith.Field(ball)
    values = field.value(points)
    assert values.dtype == np.float64 and values.shape == (4,)
    np.testing.assert_allclose(values[1:], [0.0, -0.1, 0.1], atol=4e-3)
    assert abs(values[1]) < 1e-6
    assert field.inside(points).tolist() == [True, bool(values[1] > 0), False, True]
    np.testing.assert_allclose(field.gradient(points[2:]), [[0, 0, -1], [0, 0, 1]], atol=0.06)
    by_step = field.gradient(points[2:], step=0.5)
    ahead, behind = (field.value(points[2:] + [0, 0, side * 0.5]) for side in (1, -1))
    np.testing.assert_array_equal(by_step[:, 2], ahead - behind)
    np.testing.assert_allclose(by_step[:, :2], 0.0, atol=1e-6)
    with pytest.raises(ValueError, match="^step: "):
        field.gradient(points, step=0.0)
    assert (field.bounds[0] <= [-1, -2, -2]).all() and (field.bounds[1] >= [3, 2, 2]).all()
    assert field.left_out == []


def test_values_do_not_depend_on_threads_or_on_the_type_of_exact_points(example):
    field = astrolith.Field(example("itokawa_details"))
    points = np.random.default_rng(1).uniform(*field.bounds, (5000, 3)).astype(np.float32)
    values = field.value(points)
    assert (field.value(points, threads=1) == values).all()
    assert (field.value(points.astype(np.float64)) == values).all()
    assert field.value(np.zeros((0, 3))).shape == (0,)


def test_values_at_float64_points_take_no_temporary_arrays(ball):
    field = astrolith.Field(ball)
    points = np.random.default_rng(1).uniform(*field.bounds, (200_000, 3))
    tracemalloc.start()
    values = field.value(points)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert values.nbytes == 1_600_000 and peak < 200_000  # tracemalloc does not see the result, which is the module's


def test_a_prediction_is_near_the_mesh(ball):
    predicted = astrolith.predict(ball, resolution=64, threads=1)
    made = astrolith.mesh(ball, resolution=64)
    assert predicted.triangles == pytest.approx(len(made.faces), rel=0.1)
    assert predicted.file_bytes == pytest.approx(25 * len(made.faces), rel=0.1)
    assert 0 < predicted.seconds <= 1.01 * predicted.processor_seconds
    chosen = astrolith.predict(ball, triangles=30_000)
    assert chosen.triangles == pytest.approx(30_000, rel=0.1) and chosen.peak_bytes > 0
    with pytest.raises(ValueError, match="format"):
        astrolith.predict(ball, format=".png")


def test_a_mesh_of_a_ball_is_closed_and_of_its_size(ball):
    mesh = astrolith.mesh(ball, resolution=48)
    assert mesh.vertices.dtype == np.float32 and mesh.faces.dtype == np.uint32
    assert mesh.figures.closed and mesh.figures.manifold and mesh.figures.genus == 0
    radii = np.linalg.norm(mesh.vertices - [1, 0, 0], axis=1)
    np.testing.assert_allclose(radii, 2.0, atol=5e-3)
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-5)
    assert mesh.volume == pytest.approx(4 / 3 * np.pi * 8, rel=0.01) and mesh.area == pytest.approx(4 * np.pi * 4, rel=0.01)
    assert astrolith.Mesh(mesh.vertices, mesh.faces[:, ::-1]).volume == pytest.approx(-mesh.volume, rel=1e-12)
    for open_mesh in (astrolith.Mesh(mesh.vertices, mesh.faces[1:]), astrolith.mesh(ball, resolution=16, patch=(1, 0, 2, 1))):
        assert 0 < open_mesh.area < mesh.area
        with pytest.raises(ValueError, match="^mesh: is open"):
            open_mesh.volume


def test_an_even_mesh_states_its_quality(ball):
    even, plain = astrolith.mesh(ball, resolution=48, even=True), astrolith.mesh(ball, resolution=48)
    np.testing.assert_array_equal(even.faces, plain.faces)
    moves = np.linalg.norm(even.vertices - plain.vertices, axis=1)
    stated = even.figures.even
    assert stated["quality_before"]["first_percentile"] < 0.1 and stated["quality_after"]["first_percentile"] > 0.5
    assert stated["mean_move"] == pytest.approx(moves.mean(), rel=1e-3)
    assert stated["largest_move"] == pytest.approx(moves.max(), rel=1e-3)
    radii = np.linalg.norm(even.vertices - [1, 0, 0], axis=1)
    np.testing.assert_allclose(radii, 2.0, atol=2 * stated["largest_value"])
    assert "even" not in plain.figures


@pytest.mark.parametrize(
    "name, options, arguments",
    [
        ("itokawa_details", {"resolution": 40}, ["--resolution", "40"]),
        ("itokawa_details", {"resolution": 40, "labels": True}, ["--resolution", "40", "--labels"]),
        ("boulders", {"triangles": 6000, "threads": 1}, ["--triangles", "6000"]),
        ("rubble_pile", {"resolution": 40, "seed": 7, "min_component": 0.01},
         ["--resolution", "40", "--seed", "7", "--min-component", "0.01"]),
        ("boulders", {"resolution": 40, "even": True}, ["--resolution", "40", "--even"]),
        ("craters_power_law", {"resolution": 48, "tile": (2, 3)}, ["--resolution", "48", "--tile", "2/3"]),
        ("eroded_slopes", {"resolution": 32}, ["--resolution", "32"]),
    ],
)  # fmt: skip
def test_meshes_have_the_bytes_of_synth(example, program, tmp_path, name, options, arguments):
    program("synth", example(name), "-o", "synth.ply", "--device", "cpu", *arguments)
    astrolith.write_mesh(astrolith.mesh(example(name), **options), tmp_path / "package.ply")
    assert (tmp_path / "package.ply").read_bytes() == (tmp_path / "synth.ply").read_bytes()


def test_texture_coordinates_have_the_bytes_of_synth(ball, program, tmp_path):
    ball.write(tmp_path / "ball.json")
    program("synth", "ball.json", "-o", "synth.glb", "--resolution", "24", "--uv")
    mesh = astrolith.mesh(ball, resolution=24)
    astrolith.write_mesh(mesh, tmp_path / "package.glb", uv=True)
    assert (tmp_path / "package.glb").read_bytes() == (tmp_path / "synth.glb").read_bytes()
    assert b"TEXCOORD_0" in (tmp_path / "synth.glb").read_bytes()
    with pytest.raises(ValueError, match="a .ply gets no texture"):
        astrolith.write_mesh(mesh, tmp_path / "package.ply", uv=True)


def test_files_keep_the_unit_of_the_file_that_they_are_written_from(ball, tmp_path):
    astrolith.write_mesh(astrolith.mesh(ball, resolution=16), tmp_path / "m.ply")
    for name in ("m.obj", "m.stl"):
        astrolith.write_mesh(tmp_path / "m.ply", tmp_path / name)
        assert astrolith.read_mesh(tmp_path / name).length_unit == "m"
    for name in ("m.tab", "m.icq"):
        with pytest.warns(UserWarning, match='states no unit; where it is read, pass unit="m"') as warned:
            astrolith.write_mesh(tmp_path / "m.ply", tmp_path / name)
        assert warned[0].filename == __file__


@pytest.mark.parametrize("extension", ["obj", "stl", "glb"])
def test_other_formats_and_patches_have_the_bytes_of_synth(ball, program, tmp_path, extension):
    ball.write(tmp_path / "ball.json")
    patch = (-1.0, 0.0, 0.0, 0.5)
    program("synth", "ball.json", "-o", f"synth.{extension}", "--resolution", "24", "--patch", *patch)
    astrolith.write_mesh(astrolith.mesh(ball, resolution=24, patch=patch), tmp_path / f"package.{extension}")
    assert (tmp_path / f"package.{extension}").read_bytes() == (tmp_path / f"synth.{extension}").read_bytes()


@pytest.mark.parametrize("tileable", [False, True])
def test_textures_have_the_floats_of_synth(example, program, tmp_path, tileable):
    drawn = astrolith.texture(example("photo_textures"), 300, 200, content="height", tileable=tileable)
    assert drawn.values.shape == (200, 300) and drawn.values.dtype == np.float32
    program("synth", example("photo_textures"), "-o", "t.tif", "--texture", "300x200", "--texture-of", "height",
            *(["--tileable"] if tileable else []))  # fmt: skip
    assert drawn.values.tobytes() in (tmp_path / "t.tif").read_bytes()


def test_descriptions_and_comparisons_have_the_figures_of_the_programs(example, program, tmp_path):
    a, b = astrolith.mesh(example("itokawa_details"), resolution=32), astrolith.mesh(example("steins"), resolution=32)
    astrolith.write_mesh(a, tmp_path / "a.ply")
    astrolith.write_mesh(b, tmp_path / "b.ply")
    program("describe", "a.ply", "-o", "h.npy", "--points", "1000", "--device", "cpu")
    described = astrolith.describe(a, points=1000)
    assert described.histogram.tobytes() == np.load(tmp_path / "h.npy").tobytes()
    assert described.histogram.shape == (5,) * 6 and described.points == 1000
    options = ["--points", "500", "--samples", "1000"]
    said = json.loads(program("compare", "a.ply", "b.ply", *options))
    compared = astrolith.compare(a, b, points=500, samples=1000)
    assert compared == {key: value for key, value in said.items() if key not in ("a", "b", "features", "bins", "points")}


def test_variations_have_the_bytes_of_synth(program, varied, tmp_path):
    astrolith.Recipe.from_dict(WORM).write(tmp_path / "worm.json")
    program("synth", "worm.json", "-o", "synth.ply", "--resolution", "24", "--vary", "0.3",
            "--seed", "4", "--summary", "s.json")  # fmt: skip
    astrolith.write_mesh(astrolith.mesh(varied.recipe, resolution=24), tmp_path / "package.ply")
    assert (tmp_path / "package.ply").read_bytes() == (tmp_path / "synth.ply").read_bytes()
    assert json.loads((tmp_path / "s.json").read_text())["variation"]["strength"] == varied.strength


def test_a_picture_shows_a_bright_ball_on_black(ball):
    picture = astrolith.render(astrolith.mesh(ball, resolution=24), views=[(1, 0, 0)], width=64, height=48)
    assert picture.shape == (48, 64, 3) and picture.dtype == np.uint8
    assert picture[24, 32].mean() > 60 and picture[0, 0].max() < 60


def test_a_mesh_shows_its_own_colors(ball):
    dark, bright = (
        astrolith.render(astrolith.mesh(ball, resolution=24, albedo=word), views=[(1, 0, 0)], width=64, height=48)
        for word in ("bennu", "vesta")
    )
    assert dark[24, 32].mean() < 0.8 * bright[24, 32].mean()


def test_cameras_suns_and_transparency_are_those_of_synth(ball):
    body = astrolith.mesh(ball, resolution=24)
    look = dict(cameras="from 1 0 0", width=64, height=48, reflectance="lambert", ambient=0)
    picture = astrolith.render(body, sun_body=(0, 1, 0), transparent=True, **look)
    assert picture.shape == (48, 64, 4) and picture[0, 0, 3] == 0 and picture[24, 32, 3] == 255
    assert picture[24, 44, 0] > 150 and picture[24, 24, 0] == 0  # +y is to the right
    with pytest.raises(ValueError, match="cameras"):
        astrolith.render(body, cameras="lat 100")
    whole = astrolith.render(body, map="equirectangular", width=128, height=64)
    assert whole[32, 16].min() > 20 and whole.shape == (64, 128, 3)
    with pytest.raises(ValueError, match="map: must be"):
        astrolith.render(body, map="mercator")
    with pytest.raises(ValueError, match="leave out views"):
        astrolith.render(body, map="hemispheres", views=[(1, 0, 0)])
    with pytest.raises(ValueError, match="reflectance"):
        astrolith.render(body, reflectance="hapke w 1.2")


def test_recipes_are_edited_as_attributes_and_checked(ball, tmp_path):
    ball.seed = 5
    ball.body.spheres[0][3] = 3.0
    assert astrolith.Recipe.from_json(ball.to_json()) == ball and ball.to_dict()["seed"] == 5
    ball.write(tmp_path / "r.json")
    assert astrolith.Recipe.read(tmp_path / "r.json") == ball
    other = ball.copy()
    other.body.spheres[0][3] = -1.0
    with pytest.raises(ValueError, match=r"^recipe: body\.spheres\[0\]"):
        other.validate()
    assert ball.body.spheres[0][3] == 3.0
    with pytest.raises(AttributeError, match="sed"):
        ball.sed = 5
    with pytest.raises(ValueError, match="NaN|nan|Out of range"):
        astrolith.Recipe.from_dict({**BALL, "seed": float("nan")})


def test_fields_win_over_the_methods_of_dictionaries():
    figures = astrolith._recipe.records('{"values": {"slope": 3.5}, "keys": 2, "get": 1, "items": 4, "n": [{"pop": 5}]}')
    assert figures.values.slope == 3.5 and figures.keys == 2 and figures.get == 1 and figures.n[0].pop == 5
    plain = {"values": {"slope": 3.5}, "keys": 2, "get": 1, "items": 4, "n": [{"pop": 5}]}
    assert figures == plain and plain == figures and dict(figures) == plain and {**figures} == plain
    assert dict(**figures) == plain and list(figures) == list(plain) and repr(figures) == repr(plain)
    assert json.loads(json.dumps(figures)) == json.loads(json.dumps(figures, indent=1)) == plain
    for twin in (pickle.loads(pickle.dumps(figures)), copy.deepcopy(figures), copy.copy(figures)):
        assert twin == figures and type(twin) is type(figures) and twin.values.slope == 3.5
    figures.keys = 3
    assert figures["keys"] == 3
    assert list(astrolith._recipe.Record(a=1).values()) == [1]


def test_a_written_recipe_is_the_text_of_the_recipe(example, tmp_path):
    recipe = astrolith.Recipe.read(example("itokawa_details"))
    recipe.write(tmp_path / "r.json")
    assert astrolith.Recipe.read(tmp_path / "r.json").to_json() == (tmp_path / "r.json").read_text()


def test_read_meshes_keep_their_digits(ball, tmp_path):
    mesh = astrolith.mesh(ball, resolution=16)
    astrolith.write_mesh(mesh, tmp_path / "m.ply")
    read = astrolith.read_mesh(tmp_path / "m.ply")
    assert (read.vertices == mesh.vertices).all() and (read.faces == mesh.faces).all()
    with pytest.raises(ValueError, match="absent.ply"):
        astrolith.read_mesh(tmp_path / "absent.ply")


def test_the_synthesis_module_links_nothing_of_the_fits():
    import subprocess

    from astrolith import _synthesis

    linked = subprocess.run(["ldd", _synthesis.__file__], capture_output=True, text=True, check=True).stdout
    assert "tbb" in linked
    assert not [name for name in ("fftw", "ceres", "opencv", "nlopt", "cholmod") if name in linked]


def test_a_body_is_drawn_from_the_population_of_the_library(ball):
    drawn = astrolith.draw("asteroids", seed=7, diameter="330", class_="top", details="none")
    assert drawn.body.type == "morph" and drawn.seed == 7
    assert astrolith.draw("asteroids", seed=7, diameter="330", class_="top", details="none") == drawn
    volume = astrolith.mesh(drawn, resolution=48).volume
    assert (6 * volume / np.pi) ** (1 / 3) == pytest.approx(330, rel=0.01)
    with pytest.raises(ValueError, match="is one body"):
        astrolith.draw(ball, diameter="330")


def test_a_finished_recipe_has_the_landforms_of_a_known_body(ball):
    asteroid = ball.copy()
    asteroid.body.spheres = [[0.0, 0.0, 0.0, 180.0]]
    finished = asteroid.finished("itokawa", 0.2, start=4)
    drawn = finished.layers[-1].population
    assert (drawn.least_diameter, drawn.greatest_diameter, drawn.by_cells) == (0.2, 4, True)
    assert drawn.density == pytest.approx(373 / 0.393e6 * ((5 / 0.2) ** 3.05 - (5 / 4) ** 3.05), rel=1e-3)
    patch = astrolith.mesh(finished, resolution=48, patch=(0, 0, 180, 8))
    assert patch.figures.manifold and len(patch.faces) > 48 * 48
    assert astrolith.Recipe.from_json(finished.to_json()) == finished
    with pytest.raises(ValueError, match="no known body; name one of itokawa"):
        asteroid.finished("vesta", 0.2)


def test_reliefs_go_on_below_their_models_as_in_synth(ball, example, program, tmp_path):
    relief, patch = example("itokawa_relief"), (0.0, 0.0, 0.1, 0.05)
    program("synth", relief, "--finer", "2", "--fill-unseen", "--patch", *patch, "--resolution", "24", "-o", "finer.ply")
    finer, made = astrolith.mesh(relief, finer=2, fill_unseen=True, patch=patch, resolution=24), astrolith.read_mesh(tmp_path / "finer.ply")
    assert (finer.vertices == made.vertices).all() and (finer.faces == made.faces).all()
    assert len(finer.vertices) != len(astrolith.mesh(relief, patch=patch, resolution=24).vertices)
    for wrong, message in (({"finer": 7}, "^finer: must be a number between 0 and 6"), ({"finer": 1}, "hold no relief")):
        with pytest.raises(ValueError, match=message):
            astrolith.mesh(relief if wrong["finer"] == 7 else ball, resolution=16, **wrong)


def test_a_body_of_the_kind_is_that_of_synth(ball, example, program, tmp_path):
    relief = astrolith.Recipe.read(example("itokawa_relief"))
    program("synth", example("itokawa_relief"), "--like", "--seed", "5", "--resolution", "40", "-o", "like.ply")
    like, made = astrolith.mesh(relief.like(5), resolution=40), astrolith.read_mesh(tmp_path / "like.ply")
    assert (like.vertices == made.vertices).all() and (like.faces == made.faces).all()
    assert relief.layers[-1].arrangement == "measured"
    with pytest.raises(ValueError, match="has no relief"):
        ball.like(5)


def test_all_options_of_synth_make_arrays(ball, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    first, second = astrolith.mesh({**WORM, "layers": [{"type": "simplex", "amplitude": 0.1, "frequency": 1}]}, resolution=24, members="3:5")
    assert first.figures.triangles == len(first.faces) and (first.vertices[:100] != second.vertices[:100]).any()
    heavy = astrolith.mesh(ball, resolution=24, gravity=(2000, 6), output="heavy.ply", preview="p.png", picture_size="64x48")
    assert set(heavy.values) >= {"slope_deg", "potential_J_kg"} and (tmp_path / "p.png").exists()
    astrolith.write_mesh(heavy, "again.ply")
    assert (tmp_path / "again.ply").read_bytes() == (tmp_path / "heavy.ply").read_bytes()
    assert len(astrolith.mesh(ball, resolution=24, points=True).faces) == 0
    for options, said in (({"texture": "8x8"}, "^texture"), ({"uv": "charts"}, "^lod, uv: are of a file"), ({"members": "0:2", "patch": (9, 9, 9, 1)}, "^mesh: member 0")):
        with pytest.raises(ValueError, match=said):
            astrolith.mesh(ball, resolution=8, **options)
