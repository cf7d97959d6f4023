#!/usr/bin/env python3
"""Error against bytes of small shape files: compact recipes beside meshes that were decimated and compressed by Draco.

    pip install DracoPy fast-simplification numpy      beside the Python package of the build on PYTHONPATH
    tests/benchmarks/compact_peers.py build/release/bin MESH.ply... --bytes 1250 6250

For each mesh and number of bytes `fit_shape --bytes` writes a compact recipe, and `synth` makes its mesh. The mesh is
decimated by quadrics and encoded by Draco at level 10; of all numbers of triangles and bits tried, the file with the
least error counts. `compare` measures both: the mean distance between the surfaces, both ways, in % of the diagonal.
"""
import pathlib
import tempfile

import astrolith
import DracoPy
import fast_simplification
import numpy as np

from measure import Run, arguments_of, head, row


def mean_distance(programs, target, mesh, samples):
    return 100 * Run(programs / "compare", target, mesh, "--samples", samples, "--quiet").json()["mean_distance"]


def recipe_error(programs, target, most_bytes, folder):
    recipe, mesh = folder / "body.astro", folder / "body.ply"
    Run(programs / "fit_shape", target, "-o", recipe, "--base-only", "--bytes", most_bytes, "--quiet")
    Run(programs / "synth", recipe, "-o", mesh, "--resolution", 256, "--quiet")
    return recipe.stat().st_size, mean_distance(programs, target, mesh, 100000)


def most_triangles(vertices, triangles, bits, most_bytes):
    """The Draco file of the most triangles within the bytes; None if there is none."""
    best, low, high = None, 20, len(triangles)
    while high - low > max(2, low // 100):
        middle = (low + high) // 2
        v, t = fast_simplification.simplify(vertices, triangles, 1.0 - middle / len(triangles))
        data = DracoPy.encode(v, t, quantization_bits=bits, compression_level=10)
        if len(data) <= most_bytes:
            best, low = data, middle
        else:
            high = middle
    return best


def draco_error(programs, target, most_bytes, folder):
    read, file, found = astrolith.read_mesh(target), folder / "draco.obj", [(0, float("inf"))]
    vertices, triangles = np.asarray(read.vertices, float), np.asarray(read.faces, np.int32)
    for bits in range(6, 13):
        if data := most_triangles(vertices, triangles, bits, most_bytes):
            mesh = DracoPy.decode(data)
            astrolith.write_mesh((np.asarray(mesh.points).reshape(-1, 3), np.asarray(mesh.faces).reshape(-1, 3)), file)
            found.append((len(data), mean_distance(programs, target, file, 20000)))
    return min(found, key=lambda pair: pair[1])


if __name__ == "__main__":
    given = arguments_of(__doc__, "programs", "meshes", bytes={"type": int, "nargs": "+", "default": [1250]})
    head("body", "bytes", "Draco, mean %", "compact recipe, mean %")
    for mesh in given.meshes:
        for most_bytes in given.bytes:
            with tempfile.TemporaryDirectory() as name:
                errors = [error(given.programs, mesh, most_bytes, pathlib.Path(name)) for error in (draco_error, recipe_error)]
            row(mesh.stem, most_bytes, *(f"{mean:.4f} ({size} B)" for size, mean in errors))
