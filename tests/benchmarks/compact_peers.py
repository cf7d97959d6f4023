#!/usr/bin/env python3
"""Error against bytes of small shape files: compact recipes beside meshes that were decimated and compressed by Draco.

    pip install DracoPy fast-simplification numpy      beside the Python package of the build on PYTHONPATH
    tests/benchmarks/compact_peers.py build/release/bin MESH.ply... --bytes 1250 6250

For each mesh and number of bytes `fit_shape --bytes` writes a compact recipe, and `synth` makes its mesh. The mesh is
decimated by quadrics and encoded by Draco at level 10; of all numbers of triangles and bits tried, the file with the
least error counts. `compare` measures both: the mean distance between the surfaces, both ways, in % of the diagonal.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

import astrolith
import DracoPy
import fast_simplification
import numpy as np


def mean_distance(programs, target, mesh, samples):
    result = subprocess.run([programs / "compare", target, mesh, "--samples", str(samples), "--quiet"],
                            capture_output=True, text=True, check=True)
    return 100 * json.loads(result.stdout)["mean_distance"]


def recipe_error(programs, target, most_bytes, folder):
    recipe, mesh = folder / "body.astro", folder / "body.ply"
    subprocess.run([programs / "fit_shape", target, "-o", recipe, "--base-only", "--bytes", str(most_bytes), "--quiet"],
                   check=True)
    subprocess.run([programs / "synth", recipe, "-o", mesh, "--resolution", "256", "--quiet"], check=True)
    return recipe.stat().st_size, mean_distance(programs, target, mesh, 100000)


def most_triangles(vertices, triangles, bits, most_bytes):
    """The Draco file of the most triangles within the bytes, with its mesh; None if there is none."""
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
    read = astrolith.read_mesh(target)
    vertices, triangles = np.asarray(read.vertices, float), np.asarray(read.faces, np.int32)
    best = (0, float("inf"))
    for bits in range(6, 13):
        data = most_triangles(vertices, triangles, bits, most_bytes)
        if data is None:
            continue
        mesh = DracoPy.decode(data)
        file = folder / "draco.obj"
        astrolith.write_mesh((np.asarray(mesh.points).reshape(-1, 3), np.asarray(mesh.faces).reshape(-1, 3)), file)
        best = min(best, (len(data), mean_distance(programs, target, file, 20000)), key=lambda pair: pair[1])
    return best


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("programs", type=pathlib.Path, help="folder of fit_shape, synth and compare")
    parser.add_argument("meshes", type=pathlib.Path, nargs="+")
    parser.add_argument("--bytes", type=int, nargs="+", default=[1250], help="sizes of the files")
    options = parser.parse_args()
    print("| body | bytes | Draco, mean % | compact recipe, mean % |\n|---|---|---|---|")
    for mesh in options.meshes:
        for most_bytes in options.bytes:
            with tempfile.TemporaryDirectory() as name:
                draco = draco_error(options.programs, mesh, most_bytes, pathlib.Path(name))
                ours = recipe_error(options.programs, mesh, most_bytes, pathlib.Path(name))
            print(f"| {mesh.stem} | {most_bytes} | {draco[1]:.4f} ({draco[0]} B) | {ours[1]:.4f} ({ours[0]} B) |",
                  flush=True)


if __name__ == "__main__":
    main()
