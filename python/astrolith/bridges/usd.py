"""Universal Scene Description: the meshes, levels and maps of a .glb of ``synth``."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from astrolith import _arrays
from astrolith._arrays import PathLike
from astrolith.bridges._glb import Level, read_levels
from astrolith.bridges._optional import required

_UNCOLORED = 0.5  # the base colour of a body that no layer paints


def _texture(pxr: Any, stage: Any, path: str, file: str, reader: Any, raw: bool) -> Any:
    """A shader that looks a map up. `raw` values are numbers, others are colours in sRGB."""
    sdf = pxr.Sdf
    shader = pxr.UsdShade.Shader.Define(stage, path)
    shader.CreateIdAttr("UsdUVTexture")
    shader.CreateInput("file", sdf.ValueTypeNames.Asset).Set(file)
    shader.CreateInput("st", sdf.ValueTypeNames.Float2).ConnectToSource(reader.ConnectableAPI(), "result")
    shader.CreateInput("sourceColorSpace", sdf.ValueTypeNames.Token).Set("raw" if raw else "sRGB")
    for wrap in ("wrapS", "wrapT"):
        shader.CreateInput(wrap, sdf.ValueTypeNames.Token).Set("clamp")
    return shader


def _material(pxr: Any, stage: Any, path: str, files: dict[str, str]) -> Any:
    """A rough material without shine, with the maps of a level: UsdPreviewSurface."""
    sdf, shade = pxr.Sdf, pxr.UsdShade
    material = shade.Material.Define(stage, path)
    surface = shade.Shader.Define(stage, path + "/surface")
    surface.CreateIdAttr("UsdPreviewSurface")
    surface.CreateInput("roughness", sdf.ValueTypeNames.Float).Set(1.0)
    surface.CreateInput("metallic", sdf.ValueTypeNames.Float).Set(0.0)
    material.CreateSurfaceOutput().ConnectToSource(surface.ConnectableAPI(), "surface")
    color = surface.CreateInput("diffuseColor", sdf.ValueTypeNames.Color3f)
    color.Set((_UNCOLORED, _UNCOLORED, _UNCOLORED))
    if not files:
        return material
    reader = shade.Shader.Define(stage, path + "/st")
    reader.CreateIdAttr("UsdPrimvarReader_float2")
    reader.CreateInput("varname", sdf.ValueTypeNames.String).Set("st")
    reader.CreateOutput("result", sdf.ValueTypeNames.Float2)
    for use, file in files.items():
        shader = _texture(pxr, stage, f"{path}/{use}", file, reader, use != "color")
        if use == "normal":
            # Bytes are 127.5 + 127.5 x.
            shader.CreateInput("scale", sdf.ValueTypeNames.Float4).Set((2.0, 2.0, 2.0, 1.0))
            shader.CreateInput("bias", sdf.ValueTypeNames.Float4).Set((-1.0, -1.0, -1.0, 0.0))
            shader.CreateOutput("rgb", sdf.ValueTypeNames.Float3)
            surface.CreateInput("normal", sdf.ValueTypeNames.Normal3f).ConnectToSource(shader.ConnectableAPI(), "rgb")
        elif use == "occlusion":
            shader.CreateOutput("r", sdf.ValueTypeNames.Float)
            surface.CreateInput("occlusion", sdf.ValueTypeNames.Float).ConnectToSource(shader.ConnectableAPI(), "r")
        else:
            shader.CreateOutput("rgb", sdf.ValueTypeNames.Float3)
            color.ConnectToSource(shader.ConnectableAPI(), "rgb")
    return material


def _mesh(pxr: Any, stage: Any, path: str, level: Level) -> Any:
    """The mesh with one value of each kind for each vertex. The image's v runs from the bottom up."""
    vt, geom = pxr.Vt, pxr.UsdGeom
    mesh = geom.Mesh.Define(stage, path)
    points = np.ascontiguousarray(level.vertices, np.float32)
    mesh.CreatePointsAttr(vt.Vec3fArray.FromNumpy(points))
    mesh.CreateFaceVertexCountsAttr(vt.IntArray.FromNumpy(np.full(len(level.faces), 3, np.int32)))
    mesh.CreateFaceVertexIndicesAttr(vt.IntArray.FromNumpy(np.ascontiguousarray(level.faces.ravel(), np.int32)))
    mesh.CreateSubdivisionSchemeAttr("none")
    mesh.CreateExtentAttr(vt.Vec3fArray.FromNumpy(np.stack([points.min(axis=0), points.max(axis=0)])))
    if level.normals is not None:
        mesh.CreateNormalsAttr(vt.Vec3fArray.FromNumpy(np.ascontiguousarray(level.normals)))
        mesh.SetNormalsInterpolation(geom.Tokens.vertex)
    if level.uv is not None:
        st = level.uv.copy()
        st[:, 1] = 1.0 - st[:, 1]
        primvar = geom.PrimvarsAPI(mesh).CreatePrimvar(
            "st", pxr.Sdf.ValueTypeNames.TexCoord2fArray, geom.Tokens.vertex
        )
        primvar.Set(vt.Vec2fArray.FromNumpy(np.ascontiguousarray(st)))
    return mesh


def write_usd(glb: PathLike, file: PathLike) -> list[str]:
    """Write what a .glb of ``synth`` holds as Universal Scene Description.

    Lengths are metres and +z is up, as in the body's frame. Each level of detail is a variant of the set ``lod``, of which
    the finest is chosen. The material is a ``UsdPreviewSurface`` without shine; maps are .png files beside the scene.
    Colours of vertices stay behind: bake them. A body with an origin is relative to it, as in the .glb.

    Parameters
    ----------
    glb
        A file of ``synth -o rock.glb``, with the maps of ``--uv charts --bake N`` or without.
    file
        The scene, .usda or .usdc.

    Returns
    -------
    list of str
        The files that were written, the scene first.

    Raises
    ------
    ImportError
        usd-core is missing; ``pip install astrolith[usd]``.
    ValueError
        The .glb is none of ``synth``, or the scene has another extension.
    """
    name = _arrays.file_name(file, "file")
    stem, extension = os.path.splitext(name)
    if extension not in (".usda", ".usdc"):
        raise ValueError(f"{name}: is no .usda or .usdc file; name it with that extension")
    levels = read_levels(glb)
    pxr = required("pxr", "usd")
    for module in ("Usd", "UsdGeom", "UsdShade", "Sdf", "Vt"):
        required(f"pxr.{module}", "usd")
    stage = pxr.Usd.Stage.CreateInMemory()
    pxr.UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    pxr.UsdGeom.SetStageUpAxis(stage, pxr.UsdGeom.Tokens.z)
    root = pxr.UsdGeom.Xform.Define(stage, "/body").GetPrim()
    stage.SetDefaultPrim(root)
    pxr.Usd.ModelAPI(root).SetKind("component")
    variants = root.GetVariantSets().AddVariantSet("lod")
    written = [name]
    for number, level in enumerate(levels):
        variants.AddVariant(f"lod{number}")
        variants.SetVariantSelection(f"lod{number}")
        files = {}
        for use, png in level.images.items():
            image = f"{stem}_{level.name}_{use}.png"
            with open(image, "wb") as stream:
                stream.write(png)
            written.append(image)
            files[use] = "./" + os.path.basename(image)
        with variants.GetVariantEditContext():
            mesh = _mesh(pxr, stage, "/body/mesh", level)
            material = _material(pxr, stage, "/body/regolith", files)
            pxr.UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)
    variants.SetVariantSelection("lod0")
    stage.GetRootLayer().Export(name)
    return written
