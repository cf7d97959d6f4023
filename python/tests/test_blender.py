"""Blender without a window: the add-on makes and renders a body, and the tutorial's words on Blender hold.

ASTROLITH_BPY names a Python that has the module bpy, such as Blender 4's, to test with it in place of the program blender.
"""

import ast
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys

import astrolith
import numpy as np
import pytest
from conftest import png_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
ADDON = ROOT / "python" / "blender"
PAINT = {"type": "gabor", "name": "paint", "pixel_size": 0.004, "exemplar_rms": 0.2, "lobes": [[4, 0.05, 0.02, 1.0]],
         "color": {"axis": [0.8, 0.5, 0.3], "mean": [0.4, 0.35, 0.3]}}  # fmt: skip
RECIPE = {"format_version": 1, "length_unit": "km",
          "body": {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0.3, 0, 0, 1], [-0.8, 0, 0, 0.7]]},
          "layers": [{"type": "perlin", "amplitude": 0.1, "frequency": 3.0}]}  # fmt: skip


@pytest.fixture
def blender(tmp_path):
    """Runs a script in Blender and returns the JSON of the line that begins with this word."""
    python = os.environ.get("ASTROLITH_BPY")
    if not (python or shutil.which("blender")):
        pytest.skip("Blender is not installed")

    def run(word, script, *arguments):
        command = ["blender", "--background", "--factory-startup", "--python-exit-code", "3", "--python", str(script), "--"]
        if python:
            command = [python, str(script), "--"]
        # Debian's Blender heeds PYTHONPATH, and takes the modules that belong to the first python3.11 on PATH.
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        beside = os.path.dirname(shutil.which(command[0]))
        environment |= {"PATH": beside + os.pathsep + os.environ["PATH"],
                        "BLENDER_USER_SCRIPTS": str(tmp_path / "scripts"),
                        "BLENDER_USER_CONFIG": str(tmp_path / "config")}  # fmt: skip
        done = subprocess.run([*command, *map(str, arguments)], capture_output=True, text=True, env=environment, timeout=300)
        lines = [line for line in done.stdout.splitlines() if line.startswith(word + " ")]
        assert done.returncode == 0 and lines, done.stdout[-2000:] + done.stderr[-2000:]
        return json.loads(lines[-1].removeprefix(word))

    return run


def source(by):
    if by == "synth":
        folder = os.environ.get("ASTROLITH_BIN")
        if not folder:
            pytest.skip("ASTROLITH_BIN names no folder of programs")
        return ["--synth", os.path.join(folder, "synth")]
    if sys.version_info[:2] != (3, 11):
        pytest.skip("Debian's Blender has Python 3.11")
    return ["--package", pathlib.Path(astrolith.__file__).parents[1]]


@pytest.mark.parametrize("by", ["package", "synth"])
@pytest.mark.parametrize("painted", [False, True])
def test_the_addon_makes_a_body_and_renders_it(blender, tmp_path, by, painted):
    recipe = astrolith.Recipe.from_dict({**RECIPE, "layers": RECIPE["layers"] + [PAINT] * painted})
    recipe.write(tmp_path / "body.json")
    options = ["--resolution", 40, "--seed", 5, "--size", "96x72", "--samples", 4, *source(by)]
    made = blender("ASTEROID", ADDON / "render_asteroid.py", tmp_path / "body.json", tmp_path / "body.png", *options)
    expected = astrolith.mesh(recipe, resolution=40, seed=5)
    extent = np.ptp(expected.vertices.astype(float), axis=0)
    assert made["by"] == by and made["smooth"] and made["normals"] and made["seed"] == 5
    assert (made["vertices"], made["triangles"]) == (len(expected.vertices), len(expected.faces))
    np.testing.assert_allclose(made["dimensions"], extent * 2 / extent.max(), rtol=1e-5)
    assert made["metres"] == pytest.approx(1000 * extent.max() / 2, rel=1e-5)
    assert made["specular"] == [0.0]
    assert bool(made["images"]) == painted
    colors = np.reshape(made["colors"], (-1, 4))
    assert (colors[:, 3] == 1).all() and np.ptp(colors[:, 0]) > 0.02
    assert (tmp_path / "body.png").stat().st_size > 2000


@pytest.mark.parametrize("by", ["package", "synth"])
def test_baked_maps_are_in_the_scene(blender, tmp_path, by):
    layers = [*RECIPE["layers"], PAINT, {"type": "perlin", "amplitude": 0.004, "frequency": 60.0}]
    (tmp_path / "body.json").write_text(json.dumps({**RECIPE, "layers": layers}))
    options = ["--resolution", 16, "--size", "96x72", "--samples", 4, "--maps", 128, "--blend", tmp_path / "body.blend"]
    made = blender("ASTEROID", ADDON / "render_asteroid.py", tmp_path / "body.json", tmp_path / "body.png", *options, *source(by))
    assert made["by"] == by and made["atlas"] == ["atlas"] and made["bent"] and made["normals"]
    assert sorted(made["images"]) == ["Astrolith colours", "Astrolith normal"]
    assert (tmp_path / "body.blend").stat().st_size > 100_000


@pytest.mark.parametrize("by", ["package", "synth"])
def test_colours_of_vertices_are_kept(blender, tmp_path, by):
    image = png_of(np.random.default_rng(1).integers(0, 256, (32, 32), dtype=np.uint8))
    (tmp_path / "rust.png").write_bytes(image)
    layer = {"type": "exemplar", "image": "rust.png", "image_sha256": hashlib.sha256(image).hexdigest(), "color": True,
             "height_rms": 0.01, "pixel_size": 0.05}  # fmt: skip
    (tmp_path / "body.json").write_text(json.dumps({**RECIPE, "layers": [layer]}))
    options = ["--resolution", 24, "--size", "48x36", "--samples", 1, *source(by)]
    made = blender("ASTEROID", ADDON / "render_asteroid.py", tmp_path / "body.json", tmp_path / "body.png", *options)
    srgb = astrolith.mesh(tmp_path / "body.json", resolution=24).colors / 255
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    assert made["by"] == by and not made["images"] and np.ptp(linear) > 0.3
    np.testing.assert_allclose(np.reshape(made["colors"], (-1, 4)), np.column_stack([linear, np.ones(len(linear))]), atol=1e-6)


def test_the_extension_of_blender_states_what_the_addon_states():
    tomllib = pytest.importorskip("tomllib")
    manifest = tomllib.loads((ADDON / "astrolith_addon" / "blender_manifest.toml").read_text())
    module = ast.parse((ADDON / "astrolith_addon" / "__init__.py").read_text())
    (info,) = (ast.literal_eval(line.value) for line in module.body if isinstance(line, ast.Assign) and line.targets[0].id == "bl_info")
    assert manifest["version"] == ".".join(map(str, info["version"])) and manifest["name"] == info["name"]
    assert manifest["tags"] == [info["category"]] and manifest["type"] == "add-on" and manifest["id"].isidentifier()
    assert len(manifest["tagline"]) <= 64 and manifest["tagline"][-1].isalnum()


def test_the_finished_body_of_the_tutorial_is_rendered(blender, program, tmp_path):
    """A ball with a layer's colour and relief fills the middle of the picture, and the sky about it stays dark."""
    ball = {"format_version": 1, "length_unit": "km", "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]}}
    astrolith.Recipe.from_dict(ball).write(tmp_path / "ball.json")
    layer = astrolith.Recipe.from_dict({**RECIPE, "layers": [{**PAINT, "height_rms": 0.01}]})
    layer.write(tmp_path / "r.json")
    program("synth", "ball.json", "-o", "b.ply", "--resolution", "64")
    program("synth", "r.json", "--texture", "64x64", "--texture-of", "height", "--tileable", "-o", "h.tif")
    program("synth", "r.json", "--texture", "64x64", "--texture-of", "color", "--tileable", "--bits", "8", "-o", "c.png")
    files = [tmp_path / name for name in ("b.ply", "c.png", "h.tif")]
    made = blender("FINISHED", ADDON / "render_finished.py", *files, 0.256, tmp_path / "out.png", 60, 4)
    np.testing.assert_allclose(made["size"], [2.0, 2.0, 2.0], rtol=1e-3)
    assert made["smooth"]
    bright = np.asarray(made["brightness"])
    assert bright.shape == (72, 60)
    assert bright[30:42, 20:30].mean() > 0.05 and bright[30:42, 20:30].std() > 0.01
    assert bright[:3].max() < 0.1


def test_wrong_recipes_and_missing_programs_are_said(blender, tmp_path):
    script = tmp_path / "wrong.py"
    archive = shutil.make_archive(str(tmp_path / "addon"), "zip", ADDON, "astrolith_addon")
    script.write_text(f"""
import bpy, json
bpy.ops.preferences.addon_install(filepath={archive!r})
bpy.ops.preferences.addon_enable(module="astrolith_addon")
bpy.context.preferences.addons["astrolith_addon"].preferences.synth = "no_such_program"
said = []
for file in ({str(script)!r}, {str(ROOT / "synthesis/examples/steins.json")!r}):
    try:
        bpy.ops.mesh.asteroid_add(filepath=file)
    except RuntimeError as error:
        said.append(str(error).strip())
print("SAID " + json.dumps(said))
""")
    said = blender("SAID", script)
    assert "is no recipe" in said[0] and "neither the package astrolith nor the program synth" in said[1]


@pytest.mark.parametrize("by", ["package", "synth"])
def test_a_measured_body_needs_no_file(blender, tmp_path, by):
    script = tmp_path / "body.py"
    archive = shutil.make_archive(str(tmp_path / "addon"), "zip", ADDON, "astrolith_addon")
    option, place = source(by)
    script.write_text(f"""
import bpy, json
bpy.ops.preferences.addon_install(filepath={archive!r})
bpy.ops.preferences.addon_enable(module="astrolith_addon")
bpy.context.preferences.addons["astrolith_addon"].preferences.{option[2:]} = {str(place)!r}
bpy.ops.mesh.asteroid_add(body="ky26", resolution=24)
made = bpy.context.object
print("BODY " + json.dumps([made.name, made["made_by"], len(made.data.polygons)]))
""")
    assert blender("BODY", script) == ["ky26", by, len(astrolith.mesh("ky26", resolution=24).faces)]


def test_the_tutorial_is_right_about_blender(blender, program, tmp_path):
    recipe = astrolith.Recipe.from_dict({**RECIPE, "layers": [{**PAINT, "height_rms": 0.02}]})
    recipe.write(tmp_path / "r.json")
    for extension in ("ply", "glb"):
        program("synth", "r.json", "-o", f"b.{extension}", "--resolution", "24")
    program("synth", "r.json", "--texture", "64x64", "--texture-of", "height", "--tileable", "-o", "h.tif")
    program("synth", "r.json", "--texture", "64x64", "--texture-of", "color", "--tileable", "--bits", "8", "-o", "c.png")
    found = blender("FOUND", ROOT / "python" / "tests" / "blender_tutorial.py",
                    *(tmp_path / name for name in ("b.ply", "b.glb", "h.tif", "c.png")))  # fmt: skip
    vertices = astrolith.mesh(recipe, resolution=24).vertices.astype(float)
    least, most = vertices.min(axis=0), vertices.max(axis=0)
    np.testing.assert_allclose(found["ply"]["box"], [least, most], rtol=1e-5)
    np.testing.assert_allclose(found["glb"]["box"], 1000 * np.array([least, most]), rtol=1e-5)
    assert found["ply"]["custom_normals"] == found["ply"]["smooth"] == (found["version"] >= [4, 0, 0])
    assert found["glb"]["smooth"]
    heights = astrolith.texture(recipe, 64, 64, content="height", tileable=True).values
    assert found["height"]["float"] and found["height"]["least"] < 0
    assert found["height"]["least"] == pytest.approx(heights.min(), rel=1e-5)
    assert found["height"]["most"] == pytest.approx(heights.max(), rel=1e-5)
    assert found["colour"]["space"] == "sRGB"
    assert found["midlevel_0"] == pytest.approx(0.3, abs=1e-4)
    assert found["midlevel_0_scale_3"] == pytest.approx(0.9, abs=1e-4)
    assert found["default_midlevel"] == pytest.approx(-0.2, abs=1e-4)
    assert found["default_method"] == pytest.approx(0.0, abs=1e-4)
