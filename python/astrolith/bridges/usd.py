"""Universal Scene Description: the meshes, levels and maps of a .glb of ``synth``."""

from __future__ import annotations

import os
import tempfile
from typing import Any, Optional, Sequence

import numpy as np

from astrolith import _arrays
from astrolith._arrays import PathLike
from astrolith._gravity import gravity
from astrolith._mesh import Mesh, MeshLike, unit_of
from astrolith._units import METRES
from astrolith.bridges._glb import Level, read_levels
from astrolith.bridges._optional import required
from astrolith.bridges.collision import hull, in_metres

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


def _material(pxr: Any, stage: Any, path: str, files: dict[str, str], has_colors: bool) -> Any:
    """A rough material without shine, with the maps of a level or the colours of its vertices: UsdPreviewSurface."""
    sdf, shade = pxr.Sdf, pxr.UsdShade
    material = shade.Material.Define(stage, path)
    surface = shade.Shader.Define(stage, path + "/surface")
    surface.CreateIdAttr("UsdPreviewSurface")
    surface.CreateInput("roughness", sdf.ValueTypeNames.Float).Set(1.0)
    surface.CreateInput("metallic", sdf.ValueTypeNames.Float).Set(0.0)
    material.CreateSurfaceOutput().ConnectToSource(surface.ConnectableAPI(), "surface")
    color = surface.CreateInput("diffuseColor", sdf.ValueTypeNames.Color3f)
    color.Set((_UNCOLORED, _UNCOLORED, _UNCOLORED))
    if has_colors and "color" not in files:
        reader = shade.Shader.Define(stage, path + "/vertices")
        reader.CreateIdAttr("UsdPrimvarReader_float3")
        reader.CreateInput("varname", sdf.ValueTypeNames.String).Set("displayColor")
        reader.CreateOutput("result", sdf.ValueTypeNames.Float3)
        color.ConnectToSource(reader.ConnectableAPI(), "result")
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
    if level.colors is not None:
        shown = mesh.CreateDisplayColorPrimvar(geom.Tokens.vertex)
        shown.Set(vt.Vec3fArray.FromNumpy(np.ascontiguousarray(level.colors)))
    return mesh


def _collides(pxr: Any, stage: Any, level: Level, density: float, parts: Sequence[MeshLike]) -> None:
    """Makes the root a rigid body with mass, centre and inertia of uniform density, which bumps by its parts."""
    physics, gf = pxr.UsdPhysics, pxr.Gf
    root = stage.GetDefaultPrim()
    vertices, numbers = np.unique(level.vertices, axis=0, return_inverse=True)  # charts split the vertices
    whole = Mesh(vertices, numbers.reshape(-1)[level.faces].astype(np.uint32), length_unit="m")
    body = gravity(whole, density, degree=0, sample=0).figures.body
    moments, axes = np.linalg.eigh(np.array(body.inertia_kg_m2, float))
    if np.linalg.det(axes) < 0.0:
        axes[:, 2] *= -1.0
    matrix = gf.Matrix3d(*axes.T.ravel().tolist())  # rows, as USD multiplies from the left
    turn = matrix.ExtractRotation().GetQuat()
    physics.RigidBodyAPI.Apply(root)
    mass = physics.MassAPI.Apply(root)
    mass.CreateMassAttr(float(body.mass_kg))
    mass.CreateCenterOfMassAttr(gf.Vec3f(*[float(c) for c in body.center_of_mass_m]))
    mass.CreateDiagonalInertiaAttr(gf.Vec3f(*[float(m) for m in moments]))
    mass.CreatePrincipalAxesAttr(gf.Quatf(turn))
    pxr.UsdGeom.Scope.Define(stage, "/body/collision")
    given = [hull(whole)] if not parts else parts
    for k, part in enumerate(given):
        made = in_metres(part, unit_of(part, None, tuple(METRES), "parts", "m"))
        shape = _mesh(pxr, stage, f"/body/collision/part{k}", Level("", made.vertices, made.faces, None, None, {}))
        shape.CreatePurposeAttr(pxr.UsdGeom.Tokens.guide)  # not drawn
        physics.CollisionAPI.Apply(shape.GetPrim())
        physics.MeshCollisionAPI.Apply(shape.GetPrim()).CreateApproximationAttr("convexHull")


def write_usd(
    glb: PathLike, file: PathLike, *, density: Optional[float] = None, parts: Sequence[MeshLike] = ()
) -> list[str]:
    """Write what a .glb of ``synth`` holds as Universal Scene Description.

    Lengths are metres and +z is up, as in the body's frame. Each level of detail is a variant of the set ``lod``, of which
    the finest is chosen. The material is a ``UsdPreviewSurface`` without shine; maps are .png files beside the scene.
    Without a map of colours those of the vertices are ``displayColor``, in linear light. A body with an origin is relative to it, as in the .glb.

    Parameters
    ----------
    glb
        A file of ``synth -o rock.glb``, with the maps of ``--uv charts --bake N`` or without.
    file
        The scene, .usda, .usdc or .usdz, which holds its maps.
    density
        kg/m3. The body then is a rigid body of UsdPhysics with mass, centre and inertia, for Isaac Sim and others; it
        must be closed. None: a body to be seen alone.
    parts
        With `density`: convex meshes that collide, such as those of :func:`convex_parts`, in the unit that they state,
        else metres; without them the body's :func:`hull`.

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
    if extension not in (".usda", ".usdc", ".usdz"):
        raise ValueError(f"{name}: is no .usda, .usdc or .usdz file; name it with that extension")
    if extension == ".usdz":
        return _packed(glb, name, density, parts)
    if parts and density is None:
        raise ValueError("parts: collide only with a density; give one")
    levels = read_levels(glb)
    pxr = required("pxr", "usd")
    for module in ("Usd", "UsdGeom", "UsdPhysics", "UsdShade", "UsdUtils", "Sdf", "Vt", "Gf"):
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
            material = _material(pxr, stage, "/body/regolith", files, level.colors is not None)
            pxr.UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)
    variants.SetVariantSelection("lod0")
    if density is not None:
        _collides(pxr, stage, levels[0], density, parts)
    stage.GetRootLayer().Export(name)
    return written


def _packed(glb: PathLike, name: str, density: Optional[float], parts: Sequence[MeshLike]) -> list[str]:
    """Writes a .usdz, whole or not at all."""
    with tempfile.TemporaryDirectory(dir=os.path.dirname(os.path.abspath(name))) as folder:
        stem = os.path.splitext(os.path.basename(name))[0]
        scene, *_ = write_usd(glb, os.path.join(folder, stem + ".usdc"), density=density, parts=parts)
        packed = os.path.join(folder, stem + ".usdz")
        if not required("pxr.UsdUtils", "usd").CreateNewUsdzPackage(scene, packed):
            raise OSError(f"{name}: cannot be written")
        os.replace(packed, name)
    return [name]
