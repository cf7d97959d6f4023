"""Slopes of a body: the angle of each facet's outward normal to gravity plus centrifugal acceleration, degrees.

    surface_slopes.py MESH.ply --unit METRES --density KG_PER_M3 --period HOURS [--points N] [--seed S]

Gravity is that of the uniform polyhedron (Tsoulis 2012; ESA's polyhedral-gravity), at the centres of N facets drawn by area; the body
turns about z. Prints {"slopes": [...], "facet_size": m, "facets": n}, facet_size the square root of the mean facet area.
"""
import argparse
import json

import numpy as np
import pymeshlab
from polyhedral_gravity import NormalOrientation, Polyhedron, PolyhedronIntegrity, evaluate

HEIGHT = 1e-3  # of a facet's size: the closed form is singular on an edge, so points stand a little above their facets


def read(path, unit):
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(path)
    mesh = meshes.current_mesh()
    return mesh.vertex_matrix() * unit, mesh.face_matrix()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("mesh")
    parser.add_argument("--unit", type=float, required=True)
    parser.add_argument("--density", type=float, required=True)
    parser.add_argument("--period", type=float, required=True)
    parser.add_argument("--points", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()

    vertices, faces = read(options.mesh, options.unit)
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1) / 2
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    centre = np.einsum("ij,ij,ik->k", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]), corners.sum(axis=1)) / (24 * volume)
    size = np.sqrt(areas.mean())

    chosen = np.random.default_rng(options.seed).choice(len(faces), options.points, p=areas / areas.sum())
    outward = normals[chosen] / (2 * areas[chosen])[:, None] * np.sign(volume)
    points = corners[chosen].mean(axis=1) + HEIGHT * size * outward
    orientation = NormalOrientation.OUTWARDS if volume > 0 else NormalOrientation.INWARDS
    body = Polyhedron((vertices, faces), options.density, orientation, PolyhedronIntegrity.DISABLE)
    pull = np.array([result[1] for result in evaluate(body, points)])
    spin = 2 * np.pi / (3600 * options.period)
    pull[:, :2] += spin**2 * (points - centre)[:, :2]
    cosines = -np.einsum("ij,ij->i", pull, outward) / np.linalg.norm(pull, axis=1)
    print(json.dumps({"slopes": np.degrees(np.arccos(np.clip(cosines, -1, 1))).tolist(), "facet_size": size, "facets": len(faces)}))


if __name__ == "__main__":
    main()
