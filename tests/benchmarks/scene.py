"""Measures `astrolith.Scene`: pictures and ranges a second, ranges against SPICE, distorted cameras against OpenCV.

    python3 -m venv peers && peers/bin/pip install numpy spiceypy opencv-python-headless
    PYTHONPATH=build/release/python peers/bin/python tests/benchmarks/scene.py [RECIPE] [--triangles 1000000]

The recipe is "bennu" unless it is given. Seconds are the best of five, with the processor seconds beside them.
"""
import argparse
import tempfile
import time
from fractions import Fraction
from pathlib import Path

import astrolith
import numpy as np

RAYS, CAMERAS = 10_000, 200


def best(work, times=5):
    """The least seconds of the clock and of the processor that a call takes."""
    measured = []
    for _ in range(times):
        clock, processor = time.perf_counter(), time.process_time()
        work()
        measured.append((time.perf_counter() - clock, time.process_time() - processor))
    return min(m[0] for m in measured), min(m[1] for m in measured)


def speeds(mesh):
    start = time.perf_counter()
    scene = astrolith.Scene(mesh)
    print(f"{len(mesh.faces)} triangles; the scene is made in {time.perf_counter() - start:.2f} s")
    radius = np.linalg.norm(mesh.vertices, axis=1).max()
    for distance in (2.2, 4.2):
        camera = astrolith.Camera(1024, 1024, 2000.0).look_at((0, -distance * radius, 0.1 * distance * radius), (0, 0, 0))
        image = scene.image(camera, (1.0, -0.6, 0.3))
        shadow = ((image.radiance == 0) & (image.incidence < 90)).sum() / (image.body >= 0).sum()
        clock, processor = best(lambda: scene.image(camera, (1.0, -0.6, 0.3)))
        print(f"image 1024 x 1024 from {distance} radii: {clock:.3f} s, {processor:.3f} processor seconds; "
              f"{(image.body >= 0).mean():.0%} covered, {shadow:.0%} of it in cast shadow")  # fmt: skip
    row, column = np.nonzero(image.body >= 0)
    seen = np.stack([(column - 511.5) / 2000, (row - 511.5) / 2000, np.ones(len(row))], axis=1) @ camera.rotation
    rng = np.random.default_rng(1)
    origins = rng.standard_normal((1_000_000, 3))
    origins *= 3 * radius / np.linalg.norm(origins, axis=1)[:, None]
    for name, places, directions in (
        ("a scan in the order of its rows", camera.position, seen),
        ("rays at random", origins, 0.3 * radius * rng.uniform(-1, 1, origins.shape) - origins),
    ):
        clock, processor = best(lambda: scene.ranges(places, directions))
        n = len(directions) / 1e6
        print(f"ranges, {name}: {n / clock:.2f} million/s, {n / processor:.2f} million a processor second")
    one, two = (scene.image(camera, (1.0, -0.6, 0.3), threads=n) for n in (1, 2))
    print("arrays of 1 and 2 threads:", "equal" if all(np.array_equal(a, b, equal_nan=True) for a, b in zip(vars(one).values(), vars(two).values())) else "DIFFER")


def exact_range(origin, direction, corners):
    """The distance to the plane of a triangle, rounded once from exact fractions."""
    o, d, a, b, c = ([Fraction(float(x)) for x in v] for v in (origin, direction, *corners))
    p, q = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
    normal = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
    share = sum(n * (x - y) for n, x, y in zip(normal, a, o)) / sum(n * x for n, x in zip(normal, d))
    return float(share) * float(np.linalg.norm(direction))


def against_spice(mesh):
    """The largest difference of ranges from those to a DSK, as a share of the distance, and who is right there."""
    import spiceypy as spice

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "body.bds"
        astrolith.bridges.write_dsk(mesh, file, body=2000433, frame="J2000", unit="km")
        # A DSK keeps the vertices as they are; the scene takes them from it, so that both have the same body.
        handle = spice.dasopr(str(file))
        descriptor = spice.dlabfs(handle)
        count, plates = spice.dskz02(handle, descriptor)
        body = spice.dskv02(handle, descriptor, 1, count), spice.dskp02(handle, descriptor, 1, plates).astype(np.uint32) - 1
        scene = astrolith.Scene(body)
        radius = np.linalg.norm(body[0], axis=1).max()
        rng = np.random.default_rng(2)
        origins = rng.standard_normal((RAYS, 3))
        origins *= radius * 10 ** rng.uniform(0.1, 3, RAYS)[:, None] / np.linalg.norm(origins, axis=1)[:, None]
        directions = radius * rng.uniform(-0.6, 0.6, (RAYS, 3)) - origins
        made = scene.ranges(origins, directions)
        worst, at, apart, missing = 0.0, None, 0, 0
        for origin, direction, distance, facet in zip(origins, directions, made.range, made.facet):
            plate, point, found = spice.dskx02(handle, descriptor, origin, direction)
            if found != (facet >= 0):
                missing += 1
            elif found:
                theirs = np.linalg.norm(point - origin)
                if abs(theirs / distance - 1) >= worst:
                    exact = exact_range(origin, direction, body[0][body[1][facet]])
                    worst, at = abs(theirs / distance - 1), (distance / exact - 1, theirs / exact - 1)
                apart += plate != facet + 1
        spice.dascls(handle)
    print(f"ranges against SPICE: {RAYS} rays at {plates} plates, {(made.facet >= 0).sum()} meet the body; largest difference {worst:.1e} "
          f"of the distance, where this range is off by {at[0]:.1e} and that of SPICE by {at[1]:.1e}; {apart} have another plate, "
          f"{missing} are met by one of both alone")  # fmt: skip


def against_opencv():
    """The largest distance in pixels from the points that OpenCV projects, and from pixel to point and back."""
    import cv2

    rng = np.random.default_rng(3)
    worst = refused = 0
    for _ in range(CAMERAS):
        focal = rng.uniform(700, 3000, 2)
        center = 511.5 + rng.uniform(-40, 40, 2)
        distortion = rng.uniform(-1, 1, 5) * [0.3, 0.1, 2e-3, 2e-3, 0.03]
        vector = rng.standard_normal(3)
        rotation, place = cv2.Rodrigues(vector)[0], rng.standard_normal(3)
        camera = astrolith.Camera(1024, 1024, *focal, *center, distortion=distortion, position=place, rotation=rotation)
        tangents = (rng.uniform(0, 1023, (500, 2)) - center) / focal
        points = place + (np.column_stack([tangents, np.ones(500)]) * rng.uniform(1, 1e4, (500, 1))) @ rotation
        try:
            ours = camera.project(points)
        except ValueError:
            refused += 1
            continue
        matrix = np.array([[focal[0], 0, center[0]], [0, focal[1], center[1]], [0, 0, 1]])
        theirs = cv2.projectPoints(points, vector, -rotation @ place, matrix, distortion)[0][:, 0]
        worst = max(worst, np.abs(ours - theirs).max())
    print(f"cameras against OpenCV: {CAMERAS - refused} cameras of 500 points, largest difference {worst:.1e} pixels; {refused} fold and are refused")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipe", nargs="?", default="bennu")
    parser.add_argument("--triangles", type=float, default=1e6)
    given = parser.parse_args()
    mesh = astrolith.mesh(given.recipe, triangles=given.triangles)
    speeds(mesh)
    against_opencv()
    against_spice(astrolith.mesh(given.recipe, triangles=min(given.triangles, 2e5)))


if __name__ == "__main__":
    main()
