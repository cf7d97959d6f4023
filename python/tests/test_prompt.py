"""What somebody meets who tries the package at a prompt: names to complete, short reprs, messages that say what to do."""

import pathlib
import subprocess
import sys

import astrolith
import numpy as np
import pytest
from astrolith import bridges

BALL = {"format_version": 1, "length_unit": "m", "body": {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0.0, 0.0, 0.0, 1.0]]},
        "layers": [{"type": "gabor", "name": "grit", "pixel_size": 0.01, "height_rms": 0.01, "lobes": [[4, 0.05, 0.02, 1.0]]}]}  # fmt: skip


@pytest.fixture(scope="module")
def ball():
    return astrolith.mesh(BALL, resolution=16)


def test_all_names_are_completed_before_the_fits_are_loaded():
    code = "import astrolith; print(set(astrolith.__all__) - set(dir(astrolith)), 'annotations' in dir(astrolith))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "set() False\n"


def test_results_show_in_a_line(ball, varied):
    top = ball.vertices[ball.vertices[:, 2].argmax()]
    shown = [
        ball, astrolith.Field(BALL), astrolith.describe(ball, points=200), astrolith.gravity(ball, 2000.0, sample=0),
        astrolith.gravity(ball, 2000.0, sample=0, points=[[3.0, 0.0, 0.0]]), astrolith.texture(BALL, 64, 64),
        varied, astrolith.height_map(BALL, (*top, 0.2), resolution=8), bridges.Bodies([BALL]),
    ]  # fmt: skip
    for result in shown:
        assert repr(result).startswith("<astrolith.") and len(repr(result)) < 250 and "\n" not in repr(result)


def test_fits_show_in_a_line(ball, fit_of_metres):
    pytest.importorskip("astrolith._estimation")
    rows, columns = np.indices((48, 48))
    image = (128 + 40 * np.sin(0.7 * columns + 0.2 * rows) + (rows * 7 + columns * 3) % 23).astype(np.uint8)
    assert repr(astrolith.fit_texture(image, lobes=3)) == "<astrolith.TextureFit: gabor, layers: 1>"
    assert repr(astrolith.pack_spheres(ball, spheres=2)).startswith("<astrolith.Packing: 2 spheres fill ")
    assert repr(fit_of_metres).startswith("<astrolith.ShapeFit: ") and len(repr(fit_of_metres)) < 250


def said(call):
    with pytest.raises(ValueError) as raised:
        call()
    assert "\n" not in str(raised.value)
    return str(raised.value)


def test_a_recipe_in_place_of_a_mesh_is_told_to_be_meshed(ball):
    assert said(lambda: astrolith.render(BALL)) == "mesh: is a recipe, and must be a mesh; pass astrolith.mesh(mesh)"
    assert said(lambda: astrolith.compare(ball, astrolith.Recipe(BALL))).startswith("b: is a recipe, and must be a mesh")


def test_a_file_is_not_taken_for_the_fields_of_a_recipe():
    for file in ("body.json", pathlib.Path("body.json")):
        assert said(lambda: astrolith.Recipe(file)).startswith("recipe: a file is read by Recipe.read(file)")
    assert astrolith.Recipe(BALL) == BALL and astrolith.Recipe(a=1).a == 1


def test_an_image_with_alpha_is_told_how_to_lose_it():
    pytest.importorskip("astrolith._estimation")
    assert said(lambda: astrolith.fit_texture(np.zeros((64, 64, 4), np.uint8))).startswith("image: has four channels")


def test_bodies_are_a_sequence():
    bodies = bridges.Bodies([BALL], seeds=range(5), resolution=8)
    assert [item["seed"] for item in bodies[1:4]] == [1, 2, 3] and bodies[:0] == []
    assert said(lambda: bridges.Bodies([BALL], seeds=3)) == "seeds: must be whole numbers, such as range(100), and is 3"
    assert said(lambda: bridges.Bodies(pathlib.Path("body.json"))) == "recipes: must be a list of recipes; put the one into a list"
