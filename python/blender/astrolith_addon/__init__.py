"""Blender add-on: Add > Mesh > Asteroid makes a body of an Astrolith recipe.

A zip archive of this folder is an add-on for Blender 3.4 and newer, and an extension for Blender 4.2 and newer. It takes
the Python package ``astrolith`` where Blender can import it, and the program ``synth`` otherwise; the add-on's
preferences say where either is.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile

import bpy
import numpy as np
from bpy.props import BoolProperty, FloatProperty, IntProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

bl_info = {
    "name": "Astrolith: asteroids from recipes",
    "author": "Astrolith",
    "version": (0, 3, 0),
    "blender": (3, 4, 0),
    "location": "View3D > Add > Mesh > Asteroid",
    "description": "Makes asteroids from Astrolith's recipes",
    "category": "Add Mesh",
}

METRES = {"m": 1.0, "km": 1000.0, "body": 1.0}
TEXTURE_SIDE = 1024  # pixels of a recipe's colours, which repeat


class RecipeError(Exception):
    """What the user is told: one line."""


class AsteroidPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    package: StringProperty(name="Folder of the package", subtype="DIR_PATH",
                            description="Holds the folder 'astrolith', such as venv/lib/python3.11/site-packages")
    synth: StringProperty(name="Program synth", subtype="FILE_PATH", default="synth",
                          description="Used where the package cannot be imported")

    def draw(self, context):
        self.layout.prop(self, "package")
        self.layout.prop(self, "synth")


def preferences():
    return bpy.context.preferences.addons[__package__].preferences


def package():
    """The module astrolith, or None."""
    folder = bpy.path.abspath(preferences().package)
    if folder and folder not in sys.path:
        sys.path.append(folder)
    try:
        import astrolith
    except ImportError:
        return None
    return astrolith


# A body, by the package or by the program: arrays by name.


def body_by_package(astrolith, file, resolution, seed, labels):
    try:
        mesh = astrolith.mesh(file, resolution=resolution, seed=seed, labels=labels)
    except (ValueError, RuntimeError) as error:
        raise RecipeError(str(error)) from None
    body = {"vertices": mesh.vertices, "faces": mesh.faces, "normals": mesh.normals}
    if mesh.colors is not None:
        body["colors"] = mesh.colors
    if labels:
        body.update(label=mesh.labels, elevation=mesh.elevations)
    return body


def run_synth(arguments):
    program = bpy.path.abspath(preferences().synth)
    if not (os.path.isfile(program) or shutil.which(program)):
        raise RecipeError("neither the package astrolith nor the program synth is there; see the add-on's preferences")
    done = subprocess.run([program, *map(str, arguments), "--quiet"], capture_output=True, text=True)
    if done.returncode != 0:
        raise RecipeError((done.stderr.strip().splitlines() or ["synth failed"])[-1])


def read_ply(file):
    """The columns of a PLY that synth wrote: little-endian, the faces triangles."""
    types = {"float": "<f4", "int": "<i4", "uchar": "u1"}
    with open(file, "rb") as stream:
        columns, counts = [], {}
        while (line := stream.readline().split()) != [b"end_header"]:
            if line[:1] == [b"element"]:
                counts[line[1]] = int(line[2])
            elif line[:1] == [b"property"] and line[1] != b"list":
                columns.append((line[2].decode(), types[line[1].decode()]))
        vertices = np.fromfile(stream, columns, counts[b"vertex"])
        faces = np.fromfile(stream, [("count", "u1"), ("corners", "<u4", 3)], counts[b"face"])
    body = {name: vertices[name] for name in ("label", "elevation") if name in vertices.dtype.names}
    body["vertices"] = np.column_stack([vertices[axis] for axis in "xyz"])
    body["normals"] = np.column_stack([vertices["n" + axis] for axis in "xyz"])
    if "red" in vertices.dtype.names:
        body["colors"] = np.column_stack([vertices[name] for name in ("red", "green", "blue")])
    return {**body, "faces": faces["corners"]}


def body_by_program(file, resolution, seed, labels):
    with tempfile.TemporaryDirectory() as folder:
        output = os.path.join(folder, "body.ply")
        options = ["--resolution", resolution, *(["--seed", seed] if seed is not None else [])]
        run_synth([file, "-o", output, *options, *(["--labels"] if labels else [])])
        return read_ply(output)


def read_obj(file):
    """An .obj of synth with an atlas: vertices, normals, triangles, and the atlas's coordinates of their corners."""
    rows = {"v": [], "vt": [], "vn": [], "f": []}
    with open(file, encoding="utf-8") as stream:
        for line in stream:
            kind, *values = line.split()
            if kind in rows:
                rows[kind].append(values)
    corners = np.array([[corner.split("/") for corner in row] for row in rows["f"]], np.int64) - 1
    vertices, coordinates, normals = (np.array(rows[kind], float) for kind in ("v", "vt", "vn"))
    return {"vertices": vertices, "normals": normals, "faces": corners[..., 0], "uv": coordinates[corners[..., 1]]}


def body_with_maps(astrolith, file, resolution, seed, side):
    """A body with an atlas, and its baked maps of normals and colours as images that are stored in the scene."""
    with tempfile.TemporaryDirectory() as folder:
        output = os.path.join(folder, "body.obj")
        if astrolith:
            try:
                astrolith.synth(file, output=output, resolution=resolution, seed=seed, uv="charts", bake=side)
            except (ValueError, RuntimeError) as error:
                raise RecipeError(str(error)) from None
        else:
            options = ["--resolution", resolution, *(["--seed", seed] if seed is not None else [])]
            run_synth([file, "-o", output, "--uv", "charts", "--bake", side, *options])
        images = {}
        for use in ("normal", "color"):
            png = os.path.join(folder, f"body_{use}.png")
            if os.path.exists(png):
                images[use] = bpy.data.images.load(png)
                images[use].name = f"Astrolith {use}"
                images[use].pack()
        return read_obj(output), images


def texture_of(astrolith, file, seed):
    """The recipe's colours as an image that is stored in the scene."""
    with tempfile.TemporaryDirectory() as folder:
        if astrolith:
            colors = astrolith.texture(file, TEXTURE_SIDE, TEXTURE_SIDE, content="color", tileable=True, seed=seed).values
            image = bpy.data.images.new("Astrolith colours", TEXTURE_SIDE, TEXTURE_SIDE)
            pixels = np.ones((TEXTURE_SIDE, TEXTURE_SIDE, 4), np.float32)
            pixels[..., :3] = np.clip(colors[::-1], 0, 1)  # Blender's first row is the lowest
            image.pixels.foreach_set(pixels.ravel())
        else:
            output = os.path.join(folder, "colours.png")
            size = f"{TEXTURE_SIDE}x{TEXTURE_SIDE}"
            options = ["--seed", seed] if seed is not None else []
            run_synth([file, "--texture", size, "--texture-of", "color", "--tileable", "--bits", 8, "-o", output, *options])
            image = bpy.data.images.load(output)
            image.name = "Astrolith colours"
        image.pack()
        return image


# Blender's data.


def mesh_data(name, body, scale):
    """A mesh with the body's normals, smooth, and with what is known of its vertices as attributes."""
    data = bpy.data.meshes.new(name)
    vertices, faces = body["vertices"] * np.float32(scale), np.ascontiguousarray(body["faces"], np.int32)
    data.vertices.add(len(vertices))
    data.vertices.foreach_set("co", np.ascontiguousarray(vertices, np.float32).ravel())
    data.loops.add(faces.size)
    data.loops.foreach_set("vertex_index", faces.ravel())
    data.polygons.add(len(faces))
    data.polygons.foreach_set("loop_start", np.arange(0, faces.size, 3, dtype=np.int32))
    if bpy.app.version < (4, 0, 0):
        data.polygons.foreach_set("loop_total", np.full(len(faces), 3, np.int32))
        data.use_auto_smooth = True
    data.polygons.foreach_set("use_smooth", np.ones(len(faces), bool))
    data.update(calc_edges=True)
    data.validate()
    if len(data.vertices) == len(vertices):
        data.normals_split_custom_set_from_vertices(body["normals"])
    if "uv" in body:
        data.uv_layers.new(name="atlas").data.foreach_set("uv", np.ascontiguousarray(body["uv"], np.float32).ravel())
    add_attributes(data, body, scale)
    return data


def linear_colors(body):
    """The colours of the vertices in linear light: those that layers paint, else heights as brightness, else None."""
    if "colors" in body:
        srgb = body["colors"] / 255.0
        return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    if "elevation" not in body:
        return None
    heights = body["elevation"].astype(np.float32)  # two standard deviations from dark to bright
    brightness = 0.18 + 0.12 * np.clip((heights - heights.mean()) / (2 * heights.std() + 1e-30), -1, 1)
    return np.column_stack([brightness, brightness * 0.96, brightness * 0.9])


def add_attributes(data, body, scale):
    if "elevation" in body:
        heights = body["elevation"].astype(np.float32) * np.float32(scale)
        data.attributes.new("astrolith_layer", "INT", "POINT").data.foreach_set("value", np.ascontiguousarray(body["label"]))
        data.attributes.new("astrolith_elevation", "FLOAT", "POINT").data.foreach_set("value", heights)
    colors = linear_colors(body)
    if colors is not None:
        opaque = np.column_stack([colors, np.ones(len(colors))]).astype(np.float32)
        data.color_attributes.new("astrolith_color", "FLOAT_COLOR", "POINT").data.foreach_set("color", opaque.ravel())


def material_of(name, image, texture_length, with_colors):
    """A rough surface: the recipe's colours by box projection where there is an image, else the vertices' colours."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    surface = nodes["Principled BSDF"]
    surface.inputs["Roughness"].default_value = 1.0
    surface.inputs["Base Color"].default_value = (0.18, 0.173, 0.162, 1.0)
    specular = "Specular" if "Specular" in surface.inputs else "Specular IOR Level"  # Blender 3.4, 4.0
    surface.inputs[specular].default_value = 0.0
    if image:
        coordinates, mapping, texture = (nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "Mapping", "TexImage"))
        mapping.inputs["Scale"].default_value = (1 / texture_length,) * 3
        texture.image, texture.projection, texture.projection_blend = image, "BOX", 0.25
        links.new(coordinates.outputs["Object"], mapping.inputs["Vector"])
        links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
        links.new(texture.outputs["Color"], surface.inputs["Base Color"])
    elif with_colors:
        colors = nodes.new("ShaderNodeVertexColor")
        colors.layer_name = "astrolith_color"
        links.new(colors.outputs["Color"], surface.inputs["Base Color"])
    return material


def add_maps(material, images):
    """Links baked maps, which lie on the atlas: colours, and normals in tangent space."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    surface = nodes["Principled BSDF"]
    for use, image in images.items():
        texture = nodes.new("ShaderNodeTexImage")
        texture.image = image
        if use == "color":
            links.new(texture.outputs["Color"], surface.inputs["Base Color"])
            continue
        image.colorspace_settings.name = "Non-Color"
        bend = nodes.new("ShaderNodeNormalMap")
        bend.uv_map = "atlas"
        links.new(texture.outputs["Color"], bend.inputs["Color"])
        links.new(bend.outputs["Normal"], surface.inputs["Normal"])


def library(operator, context, edited):
    """The bodies that come with Astrolith, for the search of a field."""
    made_by = package()
    if made_by:
        return made_by.library()
    program = shutil.which(bpy.path.abspath(preferences().synth)) or ""
    folder = os.path.join(os.path.dirname(os.path.dirname(os.path.realpath(program))), "share", "astrolith", "library")
    return sorted(name[:-6] for name in os.listdir(folder) if name.endswith(".astro")) if os.path.isdir(folder) else []


def json_of(file, astrolith):
    """The recipe of a compact file or of a body of the library. Its heights are none of the add-on's business."""
    try:
        if astrolith:
            return astrolith.Recipe.read(file)
    except ValueError as error:
        raise RecipeError(str(error)) from None
    with tempfile.TemporaryDirectory() as folder:
        output = os.path.join(folder, "recipe.json")
        run_synth([file, "--write-recipe", output])
        with open(output, encoding="utf-8") as stream:
            return json.load(stream)


def read_recipe(file, astrolith):
    try:
        if os.path.splitext(file)[1] in ("", ".astro"):
            recipe = json_of(file, astrolith)
        else:
            with open(file, encoding="utf-8") as stream:
                recipe = json.load(stream)
        unit = recipe["length_unit"]
    except (OSError, ValueError, KeyError, TypeError):
        raise RecipeError(f"{file}: is no recipe; choose a file of fit_shape or of synthesis/examples") from None
    if unit not in METRES or not recipe.get("body"):
        raise RecipeError(f"{file}: has no body; choose a recipe with one")
    return recipe


def make_asteroid(file, resolution, seed, longest_side, maps=0):
    """A new object: the body of a recipe or of the library, in metres, or scaled to `longest_side` Blender units where that is above 0.

    With `maps` above 0 it has baked maps of so many texels along a side.
    """
    astrolith = package()
    recipe = read_recipe(file, astrolith)
    labels = not recipe.get("erosion") and bool(recipe.get("layers"))
    by = (lambda *options: body_by_package(astrolith, *options)) if astrolith else body_by_program
    images = {}
    if maps > 0:
        body, images = body_with_maps(astrolith, file, resolution, seed, maps)
    else:
        body = by(file, resolution, seed, labels)
    metres = METRES[recipe["length_unit"]]
    extent = float(np.ptp(body["vertices"], axis=0).max())
    scale = longest_side / extent if longest_side > 0 else metres
    name = os.path.splitext(os.path.basename(file))[0]
    data = mesh_data(name, body, scale)
    painted = [layer for layer in recipe.get("layers") or [] if layer.get("type") == "gabor" and layer.get("color")]
    image = texture_of(astrolith, file, seed) if painted and "color" not in images else None
    length = TEXTURE_SIDE * painted[0].get("pixel_size", 1.0) * scale if painted else 1.0
    data.materials.append(material_of(name, image, length, len(data.color_attributes) > 0))
    add_maps(data.materials[0], images)
    made = bpy.data.objects.new(name, data)
    made["astrolith_recipe"] = file
    made["astrolith_seed"] = recipe.get("seed", 1) if seed is None else seed
    made["metres_per_blender_unit"] = metres / scale
    made["made_by"] = "package" if astrolith else "synth"
    return made


class AddAsteroid(bpy.types.Operator, ImportHelper):
    """Make an asteroid from an Astrolith recipe"""

    bl_idname = "mesh.asteroid_add"
    bl_label = "Asteroid"
    bl_options = {"REGISTER", "UNDO"}
    filename_ext = ".json"

    filter_glob: StringProperty(default="*.json;*.astro", options={"HIDDEN"})
    body: StringProperty(name="Body", search=library,
                         description="A measured body of the library, such as eros, in place of the file")
    resolution: IntProperty(name="Resolution", default=128, min=4, max=2048,
                            description="Cells along the longest side; twice as many make four times the triangles")
    own_seed: BoolProperty(name="The recipe's seed", default=True)
    seed: IntProperty(name="Seed", default=1, min=0, description="Other noise, craters and boulders on the same base")
    longest_side: FloatProperty(name="Longest side", default=2.0, min=0.0,
                                description="Blender units; 0 keeps the true size, a Blender unit a metre")

    maps: IntProperty(name="Maps", default=0, min=0, max=8192,
                      description="Texels along a side of maps that show what the mesh is too coarse for, 64 or more; 0: none")

    def execute(self, context):
        try:
            made = make_asteroid(self.body or bpy.path.abspath(self.filepath), self.resolution,
                                 None if self.own_seed else self.seed, self.longest_side, self.maps)
        except RecipeError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        context.collection.objects.link(made)
        made.location = context.scene.cursor.location
        for chosen in context.selected_objects:
            chosen.select_set(False)
        made.select_set(True)
        context.view_layer.objects.active = made
        self.report({"INFO"}, f"{len(made.data.polygons)} triangles, {made['metres_per_blender_unit']:.4g} metres a Blender unit")
        return {"FINISHED"}


def menu(self, context):
    self.layout.operator(AddAsteroid.bl_idname, icon="MESH_ICOSPHERE")


def register():
    bpy.utils.register_class(AsteroidPreferences)
    bpy.utils.register_class(AddAsteroid)
    bpy.types.VIEW3D_MT_mesh_add.append(menu)


def unregister():
    bpy.types.VIEW3D_MT_mesh_add.remove(menu)
    bpy.utils.unregister_class(AddAsteroid)
    bpy.utils.unregister_class(AsteroidPreferences)
