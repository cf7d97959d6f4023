"""Recipes with images: found from any folder, written relative to the file, and meshed as synth does."""

import hashlib
import json
import os

import astrolith
import numpy as np
import pytest
from conftest import png_of


@pytest.fixture
def recipe_file(tmp_path):
    folder = tmp_path / "recipes"
    folder.mkdir()
    image = png_of(np.random.default_rng(1).integers(0, 256, (32, 32), dtype=np.uint8))
    (folder / "noise.png").write_bytes(image)
    layer = {
        "type": "exemplar",
        "image": "noise.png",
        "image_sha256": hashlib.sha256(image).hexdigest(),
        "height_rms": 0.02,
        "pixel_size": 0.1,
    }
    body = {"type": "metaballs", "spheres": [[0, 0, 0, 2]]}
    file = folder / "r.json"
    file.write_text(json.dumps({"format_version": 1, "length_unit": "m", "body": body, "layers": [layer]}))
    return file


def test_the_mesh_is_that_of_the_program(recipe_file, program, tmp_path, monkeypatch):
    program("synth", recipe_file, "-o", "mesh.ply", "--resolution", "40")
    wanted = astrolith.read_mesh(tmp_path / "mesh.ply")
    monkeypatch.chdir(tmp_path)
    for recipe in (astrolith.Recipe.read("recipes/r.json"), "recipes/r.json"):
        made = astrolith.mesh(recipe, resolution=40)
        assert (made.vertices == wanted.vertices).all() and (made.faces == wanted.faces).all()


def test_colors_are_those_of_the_program(recipe_file, program, tmp_path):
    document = json.loads(recipe_file.read_text())
    document["layers"][0]["color"] = True
    recipe_file.write_text(json.dumps(document))
    made = astrolith.mesh(recipe_file, resolution=40)
    assert made.colors.shape == made.vertices.shape and made.colors.dtype == np.uint8
    assert np.ptp(made.colors) > 100
    for name in ("mesh.ply", "mesh.glb"):
        program("synth", recipe_file, "-o", name, "--resolution", "40")
        astrolith.write_mesh(made, tmp_path / ("own_" + name))
        assert (tmp_path / ("own_" + name)).read_bytes() == (tmp_path / name).read_bytes()
    colors = astrolith.texture(recipe_file, 64, 64)
    assert colors.content == "color" and colors.values.shape == (64, 64, 3)
    made.colors = made.colors[:5]
    with pytest.raises(ValueError, match="mesh.colors"):
        astrolith.write_mesh(made, tmp_path / "wrong.ply")


def test_a_written_recipe_finds_its_image(recipe_file, tmp_path):
    recipe = astrolith.Recipe.read(recipe_file)
    other = tmp_path / "elsewhere"
    other.mkdir()
    recipe.write(other / "copy.json")
    image = json.loads((other / "copy.json").read_text())["layers"][0]["image"]
    assert image == os.path.join("..", "recipes", "noise.png")
    assert astrolith.mesh(other / "copy.json", resolution=16).vertices.shape[1] == 3


def test_a_missing_image_is_named(recipe_file):
    os.remove(recipe_file.parent / "noise.png")
    with pytest.raises(ValueError, match=r"layers\[0\]\.image: .*noise\.png"):
        astrolith.mesh(recipe_file, resolution=16)
