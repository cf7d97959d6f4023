"""Recipes to fields, meshes, textures and pictures, descriptions of shapes, and gravity.

This module and its extension link no library of the fits: nothing of it is under the GPL.
"""

from __future__ import annotations

from astrolith import _synthesis
from astrolith._description import Description, compare, describe
from astrolith._field import Field
from astrolith._gravity import Gravity, gravity
from astrolith._height_map import HeightMap, height_map
from astrolith._mesh import Mesh, mesh_formats, read_mesh, write_mesh
from astrolith._meshing import mesh, predict
from astrolith._optics import expose
from astrolith._picture import render
from astrolith._recipe import Recipe, library
from astrolith._scene import Camera, Image, Ranges, Scene
from astrolith._surface import Craters, SurfaceDescription, describe_surface, find_craters, realism
from astrolith._synth import synth
from astrolith._texture import Texture, texture
from astrolith._variation import Variation, draw, vary

__all__ = [
    "Camera",
    "Craters",
    "Description",
    "Field",
    "Gravity",
    "HeightMap",
    "Image",
    "Mesh",
    "Ranges",
    "Recipe",
    "Scene",
    "SurfaceDescription",
    "Texture",
    "Variation",
    "compare",
    "describe",
    "describe_surface",
    "expose",
    "find_craters",
    "gravity",
    "height_map",
    "library",
    "mesh",
    "mesh_formats",
    "predict",
    "read_mesh",
    "realism",
    "render",
    "synth",
    "texture",
    "draw",
    "vary",
    "write_mesh",
]

__version__: str = _synthesis.version().split(" ")[0]
