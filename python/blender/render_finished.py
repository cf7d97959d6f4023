"""Renders a body as the tutorial's Blender steps make it: mesh, colour and relief, in Cycles, without a window.

    blender --background --factory-startup --python render_finished.py -- MESH.ply COLOUR.png HEIGHT.tif LENGTH OUT.png \
        [WIDTH SAMPLES]

LENGTH is what an image covers, in Blender units: pixels times the layer's `pixel_size`. OUT.png needs its whole path.
"""

import json
import sys

import bpy
import numpy
from mathutils import Vector

arguments = sys.argv[sys.argv.index("--") + 1 :]
mesh_file, colour_file, height_file, length, out = arguments[:5]
width, samples = (int(number) for number in arguments[5:7] or (600, 24))


def texture(nodes, links, file, space, scale):
    """An image by box projection, which covers 1 / scale Blender units."""
    place, mapping, image = (nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "Mapping", "TexImage"))
    image.image = bpy.data.images.load(file)
    image.image.colorspace_settings.name = space
    image.projection, image.projection_blend = "BOX", 0.3
    mapping.inputs["Scale"].default_value = (scale, scale, scale)
    links.new(place.outputs["Object"], mapping.inputs["Vector"])
    links.new(mapping.outputs["Vector"], image.inputs["Vector"])
    return image


def material(scale):
    made = bpy.data.materials.new("rock")
    made.use_nodes = True
    (made if hasattr(made, "displacement_method") else made.cycles).displacement_method = "BOTH"  # Blender 4.1, 3.4
    nodes, links = made.node_tree.nodes, made.node_tree.links
    surface, end = nodes["Principled BSDF"], nodes["Material Output"]
    surface.inputs["Roughness"].default_value = 1.0
    specular = "Specular" if "Specular" in surface.inputs else "Specular IOR Level"  # Blender 3.4, 4.0
    surface.inputs[specular].default_value = 0.0
    colour = texture(nodes, links, colour_file, "sRGB", scale)
    links.new(colour.outputs["Color"], surface.inputs["Base Color"])
    relief = nodes.new("ShaderNodeDisplacement")
    relief.inputs["Midlevel"].default_value = 0.0
    relief.inputs["Scale"].default_value = 1.0
    links.new(texture(nodes, links, height_file, "Non-Color", scale).outputs["Color"], relief.inputs["Height"])
    links.new(relief.outputs["Displacement"], end.inputs["Displacement"])
    return made


def body():
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    if bpy.app.version < (4, 0, 0):
        bpy.ops.import_mesh.ply(filepath=mesh_file)
    else:
        bpy.ops.wm.ply_import(filepath=mesh_file)
    made = bpy.context.object
    bpy.ops.object.shade_smooth()
    made.data.materials.append(material(1.0 / float(length)))
    return made


def look_at(thing, place):
    thing.location = place
    thing.rotation_euler = (-Vector(place)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.collection.objects.link(thing)


def scene(size):
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.lens = 80.0
    camera.data.clip_end = 100.0 * size
    look_at(camera, Vector((1.5, -1.6, 0.5)).normalized() * 2.7 * size)
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.data.angle = 4.0, 0.009
    look_at(sun, (-0.4 * size, -2.0 * size, 1.2 * size))
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.004, 0.004, 0.005, 1.0)
    bpy.context.scene.camera = camera


def render():
    settings = bpy.context.scene.render
    settings.engine, settings.filepath = "CYCLES", out
    settings.resolution_x, settings.resolution_y, settings.resolution_percentage = width, width * 6 // 5, 100
    bpy.context.scene.cycles.samples = samples
    bpy.context.scene.cycles.use_denoising = False
    bpy.context.scene.view_settings.view_transform = "Standard"
    bpy.ops.render.render(write_still=True)


def brightness():
    """Rows of the small picture from the top, 0 to 1; empty for a large one, whose numbers nobody reads."""
    if width > 100:
        return []
    picture = bpy.data.images.load(out)
    pixels = numpy.array(picture.pixels[:]).reshape(picture.size[1], picture.size[0], picture.channels)
    return pixels[::-1, :, :3].mean(axis=2).round(4).tolist()


finished = body()
scene(max(finished.dimensions))
render()
print("FINISHED " + json.dumps({"vertices": len(finished.data.vertices), "size": list(finished.dimensions),
                                "smooth": all(face.use_smooth for face in finished.data.polygons),
                                "brightness": brightness()}))  # fmt: skip
