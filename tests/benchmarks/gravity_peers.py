"""Compares `gravity` with polyhedral-gravity (Schumacher et al. 2022) at random facets of bodies.

    python3 -m venv peers && peers/bin/pip install polyhedral-gravity numpy
    peers/bin/python tests/benchmarks/gravity_peers.py build/release/bin/gravity BODY.ply ...

Both take 2,000 kg/m3 and 6 hours. Prints the largest relative differences of potential and acceleration and the
largest difference of slope in degrees.
"""
import random
import subprocess
import sys
import tempfile

import numpy as np
import polyhedral_gravity as pg

DENSITY, PERIOD, FACETS = 2000.0, 6.0, 1000


def read_ply(name):
    content = open(name, "rb").read()
    start = content.index(b"end_header\n") + 11
    header = content[:start].decode().split("\n")
    counts = {line.split()[1]: int(line.split()[2]) for line in header if line.startswith("element")}
    types = {"float": "<f4", "double": "<f8", "int": "<i4"}
    words = [line.split() for line in header if line.startswith("property") and "list" not in line]
    vertex = np.dtype([(word[2], types[word[1]]) for word in words])
    v = np.frombuffer(content, vertex, counts["vertex"], start)
    face = np.dtype([("n", "u1"), ("corner", "<i4", 3)])
    f = np.frombuffer(content, face, counts["face"], start + v.nbytes)["corner"]
    return np.stack([v["x"], v["y"], v["z"]], 1).astype(float), f.astype(int)


def slopes(normals, effective):
    across = np.linalg.norm(np.cross(normals, effective), axis=1)
    return np.degrees(np.arctan2(across, -np.sum(normals * effective, axis=1)))


def compare(program, name):
    vertices, faces = read_ply(name)
    with tempfile.NamedTemporaryFile(suffix=".csv") as table:
        subprocess.run([program, name, "--density", str(DENSITY), "--period", str(PERIOD), "-o", table.name,
                        "--quiet"], check=True, stdout=subprocess.DEVNULL)
        ours = np.genfromtxt(table.name, delimiter=",", names=True)
    chosen = sorted(random.Random(1).sample(range(len(faces)), min(FACETS, len(faces))))
    ours = ours[chosen]
    corners = 1000.0 * vertices[faces]
    points = corners.mean(axis=1)[chosen]
    body = pg.Polyhedron((1000.0 * vertices, faces), DENSITY, integrity_check=pg.PolyhedronIntegrity.DISABLE)
    # polyhedral-gravity's field is that of a mass whose potential is positive.
    results = pg.GravityEvaluable(body)(points)
    potential = np.array([r[0] for r in results])
    pull = np.array([r[1] for r in results])
    acceleration = np.stack([ours["acceleration_%s_m_s2" % axis] for axis in "xyz"], 1)
    if np.sum(pull * acceleration) < 0:
        pull = -pull  # some releases have the other sign
    six_volumes = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    center = (corners.sum(axis=1) * six_volumes[:, None]).sum(axis=0) / (4 * six_volumes.sum())
    turn = 2 * np.pi / (3600 * PERIOD)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[chosen]
    effective = pull + turn**2 * ((points - center) * [1, 1, 0])
    return (np.max(np.abs(-ours["potential_J_kg"] / potential - 1)),
            np.max(np.linalg.norm(acceleration - pull, axis=1) / np.linalg.norm(pull, axis=1)),
            np.max(np.abs(slopes(normals, effective) - ours["slope_deg"])))


for body in sys.argv[2:]:
    print("%-45s potential %.1e  acceleration %.1e  slope %.1e degrees" %
          (body.split("/")[-1], *compare(sys.argv[1], body)), flush=True)
