#!/usr/bin/env python3
"""Renders a mesh by Blender's Cycles and by `render`, with one camera, one sun and Lambert's law, and compares greys.

    blender_picture.py BIN MESH.obj [MESH.obj ...]

BIN holds `render`; `blender` is on the PATH. Both draw the mesh with smooth normals, no ambient light, hard shadows
of a sun of 1.5 degrees radius, and an albedo of the `render` program's neutral grey. A difference is that of sRGB
values in [0, 1], over the pixels that one of the two pictures covers.
"""
import json
import pathlib
import sys
import tempfile

import numpy as np

from measure import Run, arguments_of

SIZE, FOV = 512, 30.0
EYE, SUN = (2.2, 2.6, 1.6), (1.0, -0.3, 0.3)

# What Blender runs. The mesh is an .obj in the mesh's own axes; eye, target and sun are vectors in them.
SCENE = """
import bpy, json, math, sys
from mathutils import Vector
job = json.loads(sys.argv[-1])
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.wm.obj_import(filepath=job["mesh"], forward_axis="Y", up_axis="Z")
body = bpy.context.selected_objects[0]
for face in body.data.polygons:
    face.use_smooth = True
material = bpy.data.materials.new("grey")
material.use_nodes = True
nodes, links = material.node_tree.nodes, material.node_tree.links
nodes.clear()
diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
diffuse.inputs["Color"].default_value = (0.58, 0.56, 0.535, 1.0)
diffuse.inputs["Roughness"].default_value = 0.0
links.new(diffuse.outputs["BSDF"], output.inputs["Surface"])
body.data.materials.clear()
body.data.materials.append(material)
sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
sun.data.energy = math.pi
sun.data.angle = math.radians(3.0)
sun.rotation_euler = Vector(job["sun"]).to_track_quat("Z", "Y").to_euler()
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.data.sensor_fit = "HORIZONTAL"
camera.data.angle = math.radians(job["fov"])
distance = (Vector(job["eye"]) - Vector(job["target"])).length
camera.data.clip_start, camera.data.clip_end = 0.01 * distance, 100 * distance
camera.location = job["eye"]
camera.rotation_euler = (Vector(job["eye"]) - Vector(job["target"])).to_track_quat("Z", "Y").to_euler()
scene = bpy.context.scene
for thing in (sun, camera):
    scene.collection.objects.link(thing)
scene.camera = camera
scene.world = bpy.data.worlds.new("black")
scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0, 0, 0, 1)
scene.render.engine = "CYCLES"
scene.cycles.device, scene.cycles.samples = "CPU", job["samples"]
scene.cycles.max_bounces = 0
scene.cycles.pixel_filter_type = "BOX"
scene.cycles.use_denoising = False
scene.render.film_transparent = True
scene.render.resolution_x = scene.render.resolution_y = job["size"]
scene.render.resolution_percentage = 100
scene.view_settings.view_transform = "Standard"
scene.render.image_settings.file_format = "PNG"
scene.render.image_settings.color_mode = "RGBA"
scene.render.image_settings.color_depth = "16"
scene.render.filepath = job["picture"]
bpy.ops.render.render(write_still=True)

import numpy as np

def read_picture(file):
    # Grey values of sRGB over black, and coverage, both in [0, 1].
    image = bpy.data.images.load(file)
    image.colorspace_settings.name = "Non-Color"
    image.alpha_mode = "CHANNEL_PACKED"
    values = np.array(image.pixels[:]).reshape(-1, 4)
    return values[:, 1] * values[:, 3], values[:, 3]

(a, cover_a), (b, cover_b) = read_picture(job["ours"]), read_picture(job["picture"])
body = np.maximum(cover_a, cover_b) > 0
difference = np.abs(a - b)[body]
found = {"pixels": int(body.sum()), "mean_difference": float(difference.mean()),
         "p99_difference": float(np.quantile(difference, 0.99)), "mean_grey": float(b[body].mean()),
         "cover_difference": float(np.abs(cover_a - cover_b)[body].mean())}
open(job["found"], "w").write(json.dumps(found))
"""


def compare(binary, mesh, folder, samples):
    points = np.array([line.split()[1:4] for line in mesh.read_text().splitlines() if line.startswith("v ")], float)
    target = 0.5 * (points.min(0) + points.max(0))
    eye = target + np.array(EYE) * np.linalg.norm(points - target, axis=1).max()
    ours, theirs, found = folder / "ours.png", folder / "theirs.png", folder / "found.json"
    Run(binary, mesh, "-o", ours, "--quiet", "--camera", "at {} {} {} target {} {} {} fov {}".format(*eye, *target, FOV),
        "--sun-body", *SUN, "--picture-size", f"{SIZE}x{SIZE}", "--picture-bits", 16, "--background", "transparent",
        "--reflectance", "lambert", "--ambient", 0, "--no-marks")  # fmt: skip
    script = folder / "scene.py"
    script.write_text(SCENE)
    job = {"mesh": str(mesh), "ours": str(ours), "picture": str(theirs), "found": str(found), "eye": list(eye),
           "target": list(target), "sun": SUN, "fov": FOV, "size": SIZE, "samples": samples}  # fmt: skip
    run = Run("blender", "--background", "--factory-startup", "--python", script, "--", json.dumps(job), check=False)
    if not found.exists():
        sys.exit(f"Blender compared nothing:\n{run.output[-2000:]}{run.errors[-2000:]}")
    return {"mesh": mesh.name, **json.loads(found.read_text())}


if __name__ == "__main__":
    given = arguments_of(__doc__, "bin", "meshes", samples=64,
                         keep={"type": pathlib.Path, "help": "a folder that keeps the pictures of the last mesh"})  # fmt: skip
    with tempfile.TemporaryDirectory() as name:
        for mesh in given.meshes:
            print(compare(given.bin.resolve() / "render", mesh.resolve(), given.keep or pathlib.Path(name), given.samples))
