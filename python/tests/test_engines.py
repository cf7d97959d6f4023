"""Files of synth in the programs that they are made for, without windows. Programs and packages that are absent skip."""

import json
import shutil
import subprocess
import time

import astrolith
import numpy as np
import pytest
from astrolith import bridges

RECIPE = {"format_version": 1, "length_unit": "km",
          "body": {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0.3, 0, 0, 1], [-0.8, 0, 0.2, 0.7]]},
          "layers": [{"type": "perlin", "amplitude": 0.05, "frequency": 6.0}]}  # fmt: skip
BLENDER = """
import json, sys
import numpy
numpy.bool = bool  # Debian's importer of glTF asks for it
import bpy
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=sys.argv[-1])
found = []
for thing in bpy.context.scene.objects:
    corners = [thing.matrix_world @ type(thing.location)(corner) for corner in thing.bound_box]
    found.append({"name": thing.name, "faces": len(thing.data.polygons),
                  "size": [max(c[k] for c in corners) - min(c[k] for c in corners) for k in range(3)],
                  "materials": [m.name for m in thing.data.materials], "uv": len(thing.data.uv_layers)})
images = [[image.name, image.size[0], image.colorspace_settings.name] for image in bpy.data.images]
print("FOUND " + json.dumps({"things": found, "images": images}))
"""
GODOT = """
extends SceneTree
func _init():
    var found = []
    for thing in load("res://rock.glb").instance().get_children():
        var size = thing.transform.xform(thing.mesh.get_aabb()).size
        var material = thing.mesh.surface_get_material(0)
        found.append({"name": thing.name, "faces": thing.mesh.surface_get_array_index_len(0) / 3,
                      "size": [size.x, size.y, size.z], "normal": material.normal_texture.get_width(),
                      "occlusion": material.ao_texture.get_width()})
    print("FOUND " + to_json(found))
    quit()
"""


@pytest.fixture(scope="module")
def rock(tmp_path_factory):
    """A .glb of two levels with maps, and the figures of the run."""
    folder = tmp_path_factory.mktemp("rock")
    recipe = folder / "r.json"
    recipe.write_text(json.dumps(RECIPE))
    file = folder / "rock.glb"
    figures = astrolith.synth(recipe, output=file, resolution=32, uv="charts", bake=256, lod=2)
    return file, figures


def size_of(file):
    """The extent of the body in metres."""
    levels = bridges._glb.read_levels(file)
    return np.ptp(levels[0].vertices, axis=0)


def found_in(done):
    lines = [line for line in done.stdout.splitlines() if line.startswith("FOUND ")]
    assert lines, done.stdout[-2000:] + done.stderr[-2000:]
    return json.loads(lines[-1].removeprefix("FOUND "))


def test_blender_has_axes_units_and_maps(rock, tmp_path):
    if not shutil.which("blender"):
        pytest.skip("Blender is not installed")
    script = tmp_path / "look.py"
    script.write_text(BLENDER)
    found = found_in(subprocess.run(["blender", "--background", "--factory-startup", "--python", script, "--", rock[0]],
                                    capture_output=True, text=True, timeout=300))  # fmt: skip
    thing, coarser = sorted(found["things"], key=lambda thing: thing["name"])  # of both levels, at one place
    assert coarser["name"] == "body_lod1" and coarser["faces"] == rock[1].levels[1].triangles
    np.testing.assert_allclose(thing["size"], size_of(rock[0]), rtol=1e-3)
    np.testing.assert_allclose(coarser["size"], size_of(rock[0]), rtol=0.1)
    assert thing["faces"] == rock[1].triangles and thing["materials"][0].startswith("regolith") and thing["uv"] == 1
    assert ["rock_normal", 256, "Non-Color"] in found["images"] and ["rock_occlusion", 256, "Non-Color"] in found["images"]


def test_godot_has_axes_units_and_maps(rock, tmp_path):
    if not shutil.which("godot3-server"):
        pytest.skip("Godot is not installed")
    shutil.copy(rock[0], tmp_path / "rock.glb")
    (tmp_path / "project.godot").write_text('[application]\nconfig/name="rock"\n')
    (tmp_path / "look.gd").write_text(GODOT.replace("    ", "\t"))
    environment = {"HOME": str(tmp_path), "PATH": "/usr/bin:/bin", "LANG": "en_US.UTF-8"}
    command = ["godot3-server", "--path", tmp_path]
    # The editor imports the file, but does not always end by itself.
    editor = subprocess.Popen([*command, "--editor"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment)
    try:
        end = time.monotonic() + 150
        while not list(tmp_path.glob(".import/rock.glb-*.md5")) and time.monotonic() < end:
            time.sleep(0.5)
        time.sleep(2)  # for images that follow
    finally:
        editor.kill()
        editor.wait()
    looked = subprocess.run([*command, "-s", "look.gd"], capture_output=True, text=True, timeout=100, env=environment)
    thing, coarser = sorted(found_in(looked), key=lambda thing: thing["name"])
    assert coarser["name"] == "body_lod1" and coarser["normal"] == 128
    x, y, z = size_of(rock[0])
    np.testing.assert_allclose(thing["size"], [x, z, y], rtol=1e-3)  # +y is up
    assert thing["faces"] == rock[1].triangles and thing["normal"] == thing["occlusion"] == 256


def test_bare_geometry_is_in_metres(rock):
    """Readers that pass over nodes find metres, in the body's frame."""
    box = np.ptp(astrolith.mesh(RECIPE, resolution=32).vertices, axis=0) * 1000.0
    found = {}
    trimesh = pytest.importorskip("trimesh")
    loaded = trimesh.load(rock[0])
    names = sorted(loaded.geometry)
    assert names[0].startswith("body")
    found["trimesh"] = np.ptp(loaded.geometry[names[0]].vertices, axis=0)
    document, binary = glb_parts(rock[0])
    assert "scale" not in document["nodes"][0] and document["asset"]["extras"]["length_unit"] == "m"
    view = document["bufferViews"][document["accessors"][0]["bufferView"]]
    array = np.frombuffer(binary[view["byteOffset"] :][: view["byteLength"]], np.float32).reshape(-1, 3)
    found["numpy"] = np.ptp(array, axis=0)
    try:
        import pyvista  # VTK's reader takes nodes along

        found["vtk"] = np.ptp(np.array(pyvista.read(rock[0]).combine().points), axis=0)[[0, 2, 1]]
    except ImportError:
        pass
    for reader, size in found.items():
        np.testing.assert_allclose(size, box, rtol=1e-5, err_msg=reader)


def glb_parts(file):
    data = file.read_bytes()
    length = int.from_bytes(data[12:16], "little")
    return json.loads(data[20 : 20 + length]), data[28 + length :]


def test_pygltflib_reads_it(rock):
    pygltflib = pytest.importorskip("pygltflib")
    document = pygltflib.GLTF2().load(str(rock[0]))
    assert [image.name for image in document.images] == ["rock_normal", "rock_occlusion", "rock_lod1_normal", "rock_lod1_occlusion"]


def test_usd_is_valid_and_has_levels_as_variants(rock, tmp_path):
    usd = pytest.importorskip("pxr.Usd")
    from pxr import UsdGeom, UsdShade

    files = bridges.write_usd(rock[0], tmp_path / "rock.usda")
    assert len(files) == 5
    stage = usd.Stage.Open(files[0])
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0 and UsdGeom.GetStageUpAxis(stage) == "Z"
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/body/mesh"))
    assert len(mesh.GetFaceVertexCountsAttr().Get()) == rock[1].triangles
    assert UsdShade.MaterialBindingAPI(mesh).ComputeBoundMaterial()[0]
    assert stage.GetDefaultPrim().GetVariantSet("lod").GetVariantNames() == ["lod0", "lod1"]
    validation = pytest.importorskip("pxr.UsdValidation")
    context = validation.ValidationContext(validation.ValidationRegistry().GetOrLoadAllValidators())
    assert not context.Validate(stage)


def test_usd_has_the_colours_of_vertices(tmp_path):
    usd = pytest.importorskip("pxr.Usd")
    from pxr import UsdGeom

    recipe = {**RECIPE, "albedo": {"normal": 0.05, "color": [1.1, 1.0, 0.9]}}
    (tmp_path / "r.json").write_text(json.dumps(recipe))
    astrolith.synth(tmp_path / "r.json", output=tmp_path / "r.glb", resolution=24)
    stage = usd.Stage.Open(bridges.write_usd(tmp_path / "r.glb", tmp_path / "r.usda")[0])
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/body/mesh"))
    colors = np.array(mesh.GetDisplayColorPrimvar().Get())
    assert colors.shape == np.array(mesh.GetPointsAttr().Get()).shape
    light = 0.36 * (0.05 / 0.1) ** (1 / 3)  # for viewing (docs/recipe.md#albedo)
    assert np.median(colors, axis=0) == pytest.approx([1.1 * light, light, 0.9 * light], rel=0.02)
    shader = stage.GetPrimAtPath("/body/regolith/vertices")
    assert shader.GetAttribute("inputs:varname").Get() == "displayColor"


def test_usd_is_a_rigid_body(rock, tmp_path):
    usd = pytest.importorskip("pxr.Usd")
    pytest.importorskip("scipy")
    from pxr import Gf, UsdGeom, UsdPhysics

    (packed,) = bridges.write_usd(rock[0], tmp_path / "rock.usdz", density=2000.0)
    assert [path.name for path in tmp_path.iterdir()] == ["rock.usdz"]
    stage = usd.Stage.Open(packed)
    root = stage.GetDefaultPrim()
    assert root.HasAPI(UsdPhysics.RigidBodyAPI)
    body = astrolith.gravity(astrolith.mesh(RECIPE, resolution=32), 2000.0).figures.body
    mass = UsdPhysics.MassAPI(root)
    assert mass.GetMassAttr().Get() == pytest.approx(body.mass_kg, rel=1e-5)
    np.testing.assert_allclose(mass.GetCenterOfMassAttr().Get(), body.center_of_mass_m, rtol=1e-4, atol=1e-2)
    turn = np.array(Gf.Matrix3d(Gf.Rotation(Gf.Quatd(mass.GetPrincipalAxesAttr().Get()))))  # rows are axes
    inertia = turn.T @ np.diag(mass.GetDiagonalInertiaAttr().Get()) @ turn
    np.testing.assert_allclose(inertia, body.inertia_kg_m2, atol=1e-4 * np.abs(body.inertia_kg_m2).max())
    part = stage.GetPrimAtPath("/body/collision/part0")
    assert part.HasAPI(UsdPhysics.CollisionAPI)
    assert UsdPhysics.MeshCollisionAPI(part).GetApproximationAttr().Get() == "convexHull"
    assert len(UsdGeom.Mesh(part).GetPointsAttr().Get()) <= 64
    with pytest.raises(ValueError, match="^parts: "):
        bridges.write_usd(rock[0], tmp_path / "a.usda", parts=[bridges.hull(ball())])


def ball():
    return astrolith.mesh({"format_version": 1, "length_unit": "m", "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]}},
                          resolution=16)  # fmt: skip


@pytest.mark.parametrize("most", [8, 20, 64, 255])
def test_a_hull_encloses_the_body_and_keeps_its_limit(most):
    spatial = pytest.importorskip("scipy.spatial")
    body = astrolith.mesh(RECIPE, resolution=48)
    made = bridges.hull(body, most)
    assert 4 <= len(made.vertices) <= most
    planes = spatial.ConvexHull(made.vertices).equations
    beyond = planes[:, :3] @ body.vertices.T.astype(float) + planes[:, 3:]
    assert beyond.max() <= 0.0
    # Each face touches the body, so that the body rests where its hull does.
    assert beyond.max(axis=1).min() > -2e-6 * np.ptp(body.vertices)
    exact = spatial.ConvexHull(body.vertices).volume
    assert exact < made.volume < {8: 2.2, 20: 1.6, 64: 1.12, 255: 1.02}[most] * exact


def test_convex_parts_go_into_a_glb_by_the_names_of_engines(rock, tmp_path):
    pytest.importorskip("scipy")
    trimesh = pytest.importorskip("trimesh")
    for engine, name in (("godot", "body_part0-convcolonly"), ("unreal", "UCX_body_00")):
        file = tmp_path / f"{engine}.glb"
        assert bridges.write_collision(rock[0], file, engine=engine) == str(file)
        document, _ = glb_parts(file)
        assert [node["name"] for node in document["nodes"]] == ["body", "body_lod1", name]
        assert document["scenes"][0]["nodes"] == [0, 2]
        loaded = trimesh.load(file)
        part = loaded.geometry[next(key for key in loaded.geometry if key.startswith(name))]
        body = bridges._glb.read_levels(file)
        assert [level.name for level in body] == ["body", "body_lod1"]  # parts are not seen
        hull = bridges.hull(astrolith.Mesh(body[0].vertices, body[0].faces, length_unit="m"))
        np.testing.assert_allclose(part.bounds, trimesh.Trimesh(hull.vertices, hull.faces).bounds, rtol=1e-6)
    with pytest.raises(ValueError, match="^engine: "):
        bridges.write_collision(rock[0], tmp_path / "b.glb", engine="unity")
    with pytest.raises(ValueError, match="also the file that is read"):
        bridges.write_collision(tmp_path / "godot.glb", tmp_path / "godot.glb", engine="godot")


def test_a_rock_rests_on_its_hull_in_mujoco(tmp_path):
    """Dropped onto a floor, the seen surface ends at most .5 % of its length above it, and never below."""
    mujoco = pytest.importorskip("mujoco")
    pytest.importorskip("scipy")
    body = astrolith.mesh({**RECIPE, "length_unit": "m"}, resolution=32)
    bridges.write_model(tmp_path / "rock.xml", body, 2000.0)
    floor = '<worldbody><geom type="plane" size="50 50 1" pos="0 0 -4"/></worldbody>'
    (tmp_path / "scene.xml").write_text(f'<mujoco><include file="rock.xml"/>{floor}</mujoco>')
    loaded = mujoco.MjModel.from_xml_path(str(tmp_path / "scene.xml"))
    state = mujoco.MjData(loaded)
    while state.time < 12.0:
        mujoco.mj_step(loaded, state)
    seen = state.body("rock")
    gap = (body.vertices @ seen.xmat.reshape(3, 3).T + seen.xpos)[:, 2].min() + 4.0
    length = np.ptp(body.vertices, axis=0).max()
    assert 0.0 <= gap <= 0.005 * length


def test_two_models_go_into_one_scene_of_mujoco(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    pytest.importorskip("scipy")
    body = astrolith.mesh(RECIPE, resolution=16)
    for name in ("first", "second"):
        bridges.write_model(tmp_path / f"{name}.xml", body, 2000.0)
    (tmp_path / "scene.xml").write_text('<mujoco><include file="first.xml"/><include file="second.xml"/></mujoco>')
    assert mujoco.MjModel.from_xml_path(str(tmp_path / "scene.xml")).nbody == 3  # with the world


def test_a_model_has_mass_and_inertia_of_gravity(tmp_path):
    pytest.importorskip("scipy")
    body = astrolith.mesh(RECIPE, resolution=24)
    hull = bridges.hull(body, 40)
    assert len(hull.vertices) <= 40 and hull.length_unit == "km"
    figures = astrolith.gravity(body, 2000.0).figures.body
    for name in ("rock.sdf", "rock.urdf", "rock.xml"):
        model, *meshes = bridges.write_model(tmp_path / name, body, 2000.0, parts=[hull])
        text = open(model, encoding="utf-8").read()
        assert f"{figures.mass_kg:.9g}" in text and len(meshes) == 2
    seen = astrolith.read_mesh(tmp_path / "rock_visual.obj")
    assert seen.length_unit == "m" and np.ptp(seen.vertices[:, 0]) == pytest.approx(1000 * np.ptp(body.vertices[:, 0]))
    with open(tmp_path / "rock.xml", encoding="utf-8") as before:
        bridges.write_model(tmp_path / "rock.xml", body, 3000.0, parts=[hull])
        assert before.read() == text  # the old file is whole for those who have opened it
    bridges.write_model(tmp_path / "rock.xml", body, 2000.0, parts=[hull])
    assert not list(tmp_path.glob("*.part"))
    with pytest.raises(ValueError, match="is no .sdf"):
        bridges.write_model(tmp_path / "rock.dae", body, 2000.0)
    mujoco = pytest.importorskip("mujoco")
    loaded = mujoco.MjModel.from_xml_path(str(tmp_path / "rock.xml"))
    assert loaded.body_mass[1] == pytest.approx(figures.mass_kg)
    np.testing.assert_allclose(loaded.body_ipos[1], figures.center_of_mass_m, rtol=1e-5, atol=1e-3)


def test_convex_parts_hold_the_body():
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("coacd")
    body = astrolith.mesh(RECIPE, resolution=24)
    parts = [bridges.to_trimesh(part) for part in bridges.convex_parts(body, threshold=0.2)]
    assert all(part.is_watertight and part.is_convex and part.volume > 0 for part in parts)
    assert sum(part.volume for part in parts) == pytest.approx(trimesh.Trimesh(body.vertices, body.faces).volume, rel=0.3)


def test_other_files_are_refused(tmp_path):
    (tmp_path / "a.glb").write_bytes(b"glTF and nothing else of it")
    with pytest.raises(ValueError, match="is no .glb of synth"):
        bridges._glb.read_levels(tmp_path / "a.glb")
    with pytest.raises(FileNotFoundError):
        bridges._glb.read_levels(tmp_path / "b.glb")
    with pytest.raises(ValueError, match="is no .usda"):
        bridges.write_usd(tmp_path / "a.glb", tmp_path / "a.txt")
