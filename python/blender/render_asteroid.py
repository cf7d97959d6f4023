"""Installs the add-on in a Blender without a window, makes an asteroid and renders it with Cycles.

    blender --background --factory-startup --python python/blender/render_asteroid.py -- RECIPE.json PICTURE.jpg
        [--resolution N] [--seed N] [--package FOLDER] [--synth PROGRAM] [--size WxH] [--samples N]
        [--maps N] [--blend SCENE.blend]
"""

import argparse
import json
import math
import os
import pathlib
import shutil
import sys
import tempfile

import bpy

NAME = "astrolith_addon"


def arguments():
    parser = argparse.ArgumentParser(prog="render_asteroid.py")
    parser.add_argument("recipe", type=pathlib.Path)
    parser.add_argument("picture", type=pathlib.Path)
    parser.add_argument("--resolution", type=int, default=128)
    parser.add_argument("--seed", type=int)
    parser.add_argument("--package", default="")
    parser.add_argument("--synth", default="synth")
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--maps", type=int, default=0)
    parser.add_argument("--blend", type=pathlib.Path)
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])


def look_at(thing, position, target=(0.0, 0.0, 0.0)):
    from mathutils import Vector

    thing.location = position
    thing.rotation_euler = (Vector(target) - Vector(position)).to_track_quat("-Z", "Y").to_euler()


def light_and_camera(center):
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy, sun.data.angle = 5.0, math.radians(0.5)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.lens = 70
    for thing, offset in ((sun, (-3.0, -2.0, 2.5)), (camera, (1.2, -4.2, 1.4))):
        bpy.context.collection.objects.link(thing)
        look_at(thing, tuple(c + o for c, o in zip(center, offset)), center)
    bpy.context.scene.camera = camera


def main():
    options = arguments()
    with tempfile.TemporaryDirectory() as folder:
        archive = shutil.make_archive(os.path.join(folder, NAME), "zip", pathlib.Path(__file__).parent, NAME)
        bpy.ops.preferences.addon_install(filepath=archive)
    bpy.ops.preferences.addon_enable(module=NAME)
    chosen = bpy.context.preferences.addons[NAME].preferences
    chosen.package, chosen.synth = options.package, options.synth
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    own = options.seed is None
    bpy.ops.mesh.asteroid_add(filepath=str(options.recipe.resolve()), resolution=options.resolution, own_seed=own,
                              seed=0 if own else options.seed, maps=options.maps)
    made = bpy.context.object
    corners = [made.matrix_world @ type(made.location)(corner) for corner in made.bound_box]
    light_and_camera(tuple(sum(c[k] for c in corners) / 8 for k in range(3)))
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples, scene.cycles.seed = "CYCLES", options.samples, 1
    scene.cycles.use_denoising = False
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    scene.render.resolution_x, scene.render.resolution_y = map(int, options.size.split("x"))
    scene.render.image_settings.file_format = "JPEG" if options.picture.suffix == ".jpg" else "PNG"
    scene.render.image_settings.quality = 85
    scene.view_settings.view_transform = "Standard"
    scene.render.filepath = str(options.picture.resolve())
    bpy.ops.render.render(write_still=True)
    if options.blend:
        bpy.ops.wm.save_as_mainfile(filepath=str(options.blend.resolve()))
    mesh = made.data
    colors = [0.0] * (4 * len(mesh.vertices))
    if options.maps == 0:
        mesh.color_attributes["astrolith_color"].data.foreach_get("color", colors)
    surface = mesh.materials[0].node_tree.nodes["Principled BSDF"]
    print("ASTEROID " + json.dumps({
        "vertices": len(mesh.vertices), "triangles": len(mesh.polygons), "smooth": all(p.use_smooth for p in mesh.polygons),
        "dimensions": list(made.dimensions), "metres": made["metres_per_blender_unit"], "by": made["made_by"],
        "atlas": [layer.name for layer in mesh.uv_layers], "bent": surface.inputs["Normal"].is_linked,
        "colors": colors, "images": [i.name for i in bpy.data.images if i.packed_file],
        "normals": mesh.has_custom_normals, "seed": made["astrolith_seed"],
        "specular": [i.default_value for i in surface.inputs if i.name in ("Specular", "Specular IOR Level")],
    }))  # fmt: skip


main()
