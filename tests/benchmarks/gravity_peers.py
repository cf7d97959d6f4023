"""Compares `gravity` with polyhedral-gravity (Schumacher et al. 2022) at random facets of bodies.

    python3 -m venv peers && peers/bin/pip install polyhedral-gravity numpy
    PYTHONPATH=build/release/python peers/bin/python tests/benchmarks/gravity_peers.py BODY.ply ...

Both take 2,000 kg/m3 and 6 hours. Prints the largest relative differences of potential and acceleration and the
largest difference of slope in degrees.
"""
import sys

import astrolith
import numpy as np
import polyhedral_gravity as pg

DENSITY, PERIOD, FACETS = 2000.0, 6.0, 1000


def slopes(normals, effective):
    across = np.linalg.norm(np.cross(normals, effective), axis=1)
    return np.degrees(np.arctan2(across, -np.sum(normals * effective, axis=1)))


def compare(name):
    mesh = astrolith.read_mesh(name)
    ours = astrolith.gravity(mesh, DENSITY, period=PERIOD, unit="km")
    chosen = np.sort(np.random.default_rng(1).permutation(len(mesh.faces))[:FACETS])
    vertices = 1000.0 * mesh.vertices.astype(float)
    corners = vertices[mesh.faces]
    points = corners.mean(axis=1)[chosen]
    body = pg.Polyhedron((vertices, mesh.faces.astype(int)), DENSITY, integrity_check=pg.PolyhedronIntegrity.DISABLE)
    # polyhedral-gravity's field is that of a mass whose potential is positive.
    results = pg.GravityEvaluable(body)(points)
    potential = np.array([r[0] for r in results])
    pull = np.array([r[1] for r in results])
    acceleration = ours.acceleration[chosen]
    if np.sum(pull * acceleration) < 0:
        pull = -pull  # some releases have the other sign
    center = np.array(ours.figures.body.center_of_mass_m)
    turn = 2 * np.pi / (3600 * PERIOD)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[chosen]
    effective = pull + turn**2 * ((points - center) * [1, 1, 0])
    return (np.max(np.abs(-ours.potential[chosen] / potential - 1)),
            np.max(np.linalg.norm(acceleration - pull, axis=1) / np.linalg.norm(pull, axis=1)),
            np.max(np.abs(slopes(normals, effective) - ours.slope[chosen])))


for body in sys.argv[1:]:
    print("%-45s potential %.1e  acceleration %.1e  slope %.1e degrees" % (body.split("/")[-1], *compare(body)), flush=True)
