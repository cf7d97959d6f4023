"""FastNoise2, and TerrainGen's own asteroid (`pip install terraingenpy`) at any number of triangles with our body most like it.

FastNoise2 comes in no package, so it is built the first time (some minutes). TerrainGen displaces an ellipsoid along its normals: five octaves of simplex noise and craters by a power law, as a
height field on the faces of a cube, written as GLB. It makes no body of another form.
"""
import importlib.util
import json
import math
import pathlib
import sys

from measure import ROOT, Run

EXAMPLE = "examples/config/planets/example_planets_asteroid_body_mesh.json"


def installed():
    return importlib.util.find_spec("terraingen") is not None


def peer_command(triangles, folder):
    """The command that makes the peer's mesh in `folder` with one thread, and the number of its triangles."""
    package = pathlib.Path(importlib.util.find_spec("terraingen").submodule_search_locations[0])
    config = json.loads((package / EXAMPLE).read_text())
    cells = round(math.sqrt(triangles / 12))  # six faces of cells x cells squares of two triangles
    config["outputs"] = [{"type": "mesh", "path": "peer.glb", "cells_per_face": cells}]
    file = folder / "peer.json"
    file.write_text(json.dumps(config))
    program = pathlib.Path(sys.executable).parent / "terraingen"
    return [program, file, "--output-dir", folder, "--threads", 1, "--backend", "cpu"], 12 * cells * cells


def recipe_like_it():
    """Three metaballs along the ellipsoid, with the same noise and as many craters of the same sizes."""
    return {"format_version": 1, "length_unit": "m",
            "body": {"type": "metaballs", "spheres": [[-120, 0, 0, 125], [0, 0, 0, 135], [120, 0, 0, 125]]},
            "layers": [{"type": "simplex", "amplitude": 8, "frequency": 1 / 150, "octaves": 5},
                       {"type": "craters", "population": {"count": 450, "least_diameter": 4, "greatest_diameter": 60,
                                                          "exponent": 2}}]}


def fastnoise2_rates(sources):
    """The program of fastnoise2_rates.cpp; `sources` holds FastNoise2 and FastSIMD side by side."""
    sources = sources.resolve()
    build = sources / "build"
    if not (build / "build.ninja").exists():
        Run("cmake", "-S", sources / "FastNoise2", "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
            "-DFASTNOISE2_TOOLS=OFF", f"-DCPM_FastSIMD_SOURCE={sources / 'FastSIMD'}")  # fmt: skip
    Run("cmake", "--build", build)
    library, = build.rglob("libFastNoise.a")
    program, source = build / "fastnoise2_rates", ROOT / "tests/benchmarks/fastnoise2_rates.cpp"
    if not program.exists() or program.stat().st_mtime < source.stat().st_mtime:
        Run("c++", "-std=c++20", "-O3", "-DFASTNOISE_STATIC_LIB", f"-I{ROOT}", f"-I{sources / 'FastNoise2/include'}",
            f"-I{sources / 'FastSIMD/include'}", f"-I{build / 'include'}", source, library, "-o", program)  # fmt: skip
    return program
