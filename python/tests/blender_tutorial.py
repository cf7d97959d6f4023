"""What docs/tutorial.md says of Blender, measured inside Blender: prints one line of JSON.

    blender --background --factory-startup --python blender_tutorial.py -- BODY.ply BODY.glb HEIGHT.tif COLOUR.png
"""

import json
import sys
import tempfile

import bpy
import numpy

# Debian 12 has a NumPy that the glTF importer of its Blender does not know.
numpy.bool = bool

PLY, GLB, HEIGHT, COLOUR = sys.argv[sys.argv.index("--") + 1 :][:4]


def empty():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)


def imported(operator, file):
    empty()
    operator(filepath=file)
    (thing,) = (o for o in bpy.data.objects if o.type == "MESH")
    bpy.context.view_layer.update()
    corners = [thing.matrix_world @ type(thing.location)(corner) for corner in thing.bound_box]
    return {
        "box": [[least(c[k] for c in corners) for k in range(3)] for least in (min, max)],
        "custom_normals": thing.data.has_custom_normals,
        "smooth": all(p.use_smooth for p in thing.data.polygons),
    }


def image(file, space=None):
    made = bpy.data.images.load(file)
    default = made.colorspace_settings.name
    if space:
        made.colorspace_settings.name = space
    values = made.pixels[:][0::4]
    return {"float": made.is_float, "space": default, "least": min(values), "most": max(values),
            "mean": sum(values) / len(values)}  # fmt: skip


def displaced(height, midlevel, method, scale=1.0):
    """The height of a plane at 0 that a constant texture displaces: 10 less the depth that a camera above it sees."""
    empty()
    bpy.ops.mesh.primitive_plane_add(size=4)
    material = bpy.data.materials.new("displaced")
    material.use_nodes = True
    if method:
        (material if hasattr(material, "displacement_method") else material.cycles).displacement_method = method
    nodes, links = material.node_tree.nodes, material.node_tree.links
    texture, displacement = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeDisplacement")
    texture.image = bpy.data.images.new("height", 8, 8, float_buffer=True)
    texture.image.colorspace_settings.name = "Non-Color"
    texture.image.pixels = [height, height, height, 1.0] * 64
    if midlevel is not None:
        displacement.inputs["Midlevel"].default_value = midlevel
    displacement.inputs["Scale"].default_value = scale
    links.new(texture.outputs["Color"], displacement.inputs["Height"])
    links.new(displacement.outputs["Displacement"], nodes["Material Output"].inputs["Displacement"])
    bpy.context.object.data.materials.append(material)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location = (0, 0, 10)
    bpy.context.collection.objects.link(camera)
    scene = bpy.context.scene
    scene.camera, scene.render.engine, scene.cycles.samples = camera, "CYCLES", 1
    scene.cycles.use_denoising = False  # Debian builds Blender without it
    scene.render.resolution_x = scene.render.resolution_y = 9
    bpy.context.view_layer.use_pass_z = True
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()
    layers, composite = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("CompositorNodeComposite")
    tree.links.new(layers.outputs["Depth"], composite.inputs["Image"])
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = folder + "/depth.exr"
        bpy.ops.render.render(write_still=True)
        pixels = bpy.data.images.load(scene.render.filepath).pixels[:]
    return 10 - pixels[4 * (4 * 9 + 4)]


found = {
    "version": list(bpy.app.version),
    "ply": imported(bpy.ops.import_mesh.ply if bpy.app.version < (4, 0, 0) else bpy.ops.wm.ply_import, PLY),
    "glb": imported(bpy.ops.import_scene.gltf, GLB),
    "height": image(HEIGHT, "Non-Color"),
    "colour": image(COLOUR),
    "default_midlevel": displaced(0.3, None, "DISPLACEMENT"),
    "midlevel_0": displaced(0.3, 0.0, "DISPLACEMENT"),
    "midlevel_0_scale_3": displaced(0.3, 0.0, "DISPLACEMENT", 3.0),
    "default_method": displaced(0.3, 0.0, None),
}
print("FOUND " + json.dumps(found))
