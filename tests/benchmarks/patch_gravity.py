"""Compares the accelerations that `synth --patch --gravity` writes with those of `gravity` on a finer mesh.

    PYTHONPATH=build/release/python python3 tests/benchmarks/patch_gravity.py build/release/bin/synth RECIPE X Y Z SIDE \
        [--cells 448] [--finish BODY --to SIZE]

The patch has 96 cells along a side. 500 of its vertices are compared: an angle between accelerations is the error that a
slope has. Needs the Python package of the build on PYTHONPATH.
"""
import argparse
import subprocess
import tempfile
from pathlib import Path

import astrolith
import numpy as np

TYPES = {"float": "<f4", "double": "<f8", "int": "<i4", "uchar": "u1"}
DENSITY, PERIOD = 1900.0, 12.13


def read_vertices(file):
    """The vertices of a binary PLY as a structured array, and the origin that they are relative to."""
    data = file.read_bytes()
    begin = data.index(b"end_header\n") + len(b"end_header\n")
    properties, count, origin = [], 0, np.zeros(3)
    for line in data[:begin].decode().splitlines():
        words = line.split()
        if line.startswith("comment origin"):
            origin = np.array([float(word) for word in line.split(":")[1].split()])
        if words[:2] == ["element", "vertex"]:
            count = int(words[2])
        elif words[0] == "element":
            break
        elif words[0] == "property":
            properties.append((words[2], TYPES[words[1]]))
    return np.frombuffer(data[begin:], dtype=properties, count=count), origin


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("synth")
    parser.add_argument("recipe")
    parser.add_argument("patch", nargs=4)
    parser.add_argument("--cells", type=int, default=448)
    given, more = parser.parse_known_args()
    with tempfile.TemporaryDirectory() as name:
        mesh, made = Path(name) / "patch.ply", Path(name) / "made.json"
        command = [given.synth, given.recipe, "-o", mesh, "--write-recipe", made, "--aligned", "--resolution", "96", "--quiet"]
        subprocess.run([*command, "--patch", *given.patch, "--gravity", str(DENSITY), str(PERIOD), *more], check=True)
        vertices, origin = read_vertices(mesh)
        vertices = vertices[np.random.default_rng(1).choice(len(vertices), 500, replace=False)]
        places = np.stack([vertices[axis].astype(float) for axis in "xyz"], axis=1) + origin
        exact = astrolith.gravity(made, DENSITY, period=PERIOD, resolution=given.cells, points=places, sample=0, degree=0)
    ours = np.stack([vertices[f"acceleration_{axis}_m_s2"].astype(float) for axis in "xyz"], axis=1)
    cosine = (ours * exact.acceleration).sum(1) / np.linalg.norm(ours, axis=1) / np.linalg.norm(exact.acceleration, axis=1)
    angle = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
    potential = np.abs(vertices["potential_J_kg"] / exact.potential - 1)
    print(f"angle: mean {angle.mean():.3f}, 95 % {np.percentile(angle, 95):.3f}, largest {angle.max():.3f} degrees; "
          f"potential: largest {potential.max():.1e}")  # fmt: skip


if __name__ == "__main__":
    main()
