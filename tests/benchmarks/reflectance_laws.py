#!/usr/bin/env python3
"""Laws of reflection beside formulas that are written anew from the vectors of each pixel.

    PYTHONPATH=build/release/python python3 tests/benchmarks/reflectance_laws.py

A sphere of facets is pictured under suns from 0 to 160 degrees away; each pixel is a geometry, grazing ones too. The
second implementation (NumPy, double precision) finds photometric longitude and latitude by projecting the normal onto
the plane of the sun and the viewer, not from cosines as the program does. Prints the largest difference of I/F, over
the law's value from above, by law.
"""

import astrolith
import numpy as np


def sphere(n):
    """A sphere of radius 1 as (vertices, faces) of n x 2 n cells."""
    latitude = np.linspace(-np.pi / 2, np.pi / 2, n + 1)[1:-1]
    longitude = np.linspace(0, 2 * np.pi, 2 * n, endpoint=False)
    lat, lon = np.meshgrid(latitude, longitude, indexing="ij")
    points = np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)], axis=-1).reshape(-1, 3)
    vertices = np.vstack([points, [[0, 0, -1], [0, 0, 1]]])
    rows, columns = len(latitude), 2 * n
    faces = []
    for j in range(columns):
        k = (j + 1) % columns
        for i in range(rows - 1):
            a, b, c, d = i * columns + j, i * columns + k, (i + 1) * columns + k, (i + 1) * columns + j
            faces += [(a, b, c), (a, c, d)]
        faces += [(len(points), k, j), (len(points) + 1, (rows - 1) * columns + j, (rows - 1) * columns + k)]
    return vertices, np.array(faces)


def photometric(normal, sun, eye):
    """Longitude from the viewer's meridian towards the sun, and latitude over the plane of both; radians."""
    pole = np.cross(eye, sun)
    pole /= np.linalg.norm(pole, axis=1)[:, None]
    east = np.cross(pole, eye)
    along = lambda axis: (normal * axis).sum(axis=1)  # noqa: E731
    return np.arctan2(along(east), along(eye)), np.arcsin(np.clip(along(pole), -1, 1))


def akimov(normal, sun, eye, phase, m0, m):
    longitude, latitude = photometric(normal, sun, eye)
    share = phase / (np.pi - phase)
    turned = np.cos(np.pi / (np.pi - phase) * (longitude - phase / 2))
    return np.cos(phase / 2) * turned * np.cos(latitude) ** share / np.cos(longitude)


def minnaert(normal, sun, eye, phase, m0, m):
    return np.exp(0.6 * np.log(m0 * m)) / m


def rolo(normal, sun, eye, phase, m0, m):
    a = np.degrees(phase)
    return (0.02 * np.exp(-0.1 * a) + np.polyval([-1e-9, 2e-7, 1e-5, -0.001, 0.08], a)) / (1 + m / m0)


LAWS = {
    "akimov": (akimov, "akimov", 1.0),
    "minnaert": (minnaert, "minnaert k .6", 1.0),
    "rolo": (rolo, "rolo C0 .02 C1 .1 A0 .08 A1 -.001 A2 1e-5 A3 2e-7 A4 -1e-9", 0.05),
}


def main():
    vertices, faces = sphere(60)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    scene = astrolith.Scene((vertices, faces))
    camera = astrolith.Camera(64, 64, 300.0).look_at((5.0, 0.0, 0.0), (0, 0, 0))
    row, column = np.indices((64, 64))
    rays = np.stack([(column - 31.5) / 300, (row - 31.5) / 300, np.ones((64, 64))], axis=-1) @ np.asarray(camera.rotation)
    rays /= np.linalg.norm(rays, axis=-1)[..., None]
    for name, (law, words, from_above) in LAWS.items():
        worst, count = 0.0, 0
        for degrees in (1, 5, 20, 45, 70, 90, 110, 130, 150, 160):
            angle = np.radians(degrees)
            sun = np.array([np.cos(angle), 0.8 * np.sin(angle), 0.6 * np.sin(angle)])
            image = scene.image(camera, sun, reflectance=words, smooth=False)
            lit = (image.radiance > 0) & (image.body == 0)
            normal, eye = normals[image.facet[lit]], -rays[lit]
            m0, m, phase = normal @ sun, (normal * eye).sum(axis=1), np.arccos(eye @ sun)
            keep = m > 1e-3  # below, the program takes 1e-3
            if not keep.any():
                continue
            suns = np.broadcast_to(sun, normal.shape)
            expected = law(*(v[keep] for v in (normal, suns, eye, phase, m0, m)))
            worst = max(worst, np.abs(image.radiance[lit][keep] - expected).max() / from_above)
            count += keep.sum()
        print(f"{name}: {count} geometries, largest difference {worst:.1e} of the value from above")


if __name__ == "__main__":
    main()
