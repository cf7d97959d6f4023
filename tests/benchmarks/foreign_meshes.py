#!/usr/bin/env python3
"""Reads mesh files that other projects made with our readers and with trimesh, and explains every difference.

    foreign_meshes.py FOLDER [--all]

Needs the Python package of the build on PYTHONPATH, numpy, trimesh and pillow. Compared are the corners of all triangles, in
order: their number, their box and the signed volume. Vertices themselves are no measure, since readers join and split
them. Prints a table of the differences by cause, and with --all a line for each file. Exit status 1 if a difference has
no cause, or if a reader does not end in a mesh or in one line.
"""

import argparse
import collections
import pathlib
import re
import warnings

import astrolith
import numpy
import trimesh

ENDINGS = {".obj", ".ply", ".stl", ".off"}


def corners_by_us(file):
    """The corners of our triangles, or the words of the refusal."""
    try:
        mesh = astrolith.read_mesh(file)
    except ValueError as error:
        return None, str(error)
    return numpy.asarray(mesh.vertices)[numpy.asarray(mesh.faces)], ""


def corners_by_trimesh(file):
    """The corners of trimesh's triangles, or the words of the refusal."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            mesh = trimesh.load(file, process=False, maintain_order=True, force="mesh", skip_materials=True)
        return numpy.asarray(mesh.triangles, dtype=float).reshape(-1, 3, 3), ""
    except Exception as error:  # a library's reader may end in any way
        return None, f"{type(error).__name__}: {error}"


def volume(corners):
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    return float(numpy.einsum("ij,ij->", a, numpy.cross(b, c)) / 6)


def area(corners):
    return numpy.linalg.norm(numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2


def box(corners):
    points = corners.reshape(-1, 3)
    return numpy.concatenate([points.min(0), points.max(0)]) if len(points) else numpy.zeros(6)


def without_slivers(corners):
    """Triangles whose corners differ: readers leave out others or keep them."""
    if not len(corners):
        return corners
    distinct = ((corners[:, 0] != corners[:, 1]) | (corners[:, 1] != corners[:, 2])).any(1)
    ends = (corners[:, 0] != corners[:, 2]).any(1)
    joined = (corners[:, 0] != corners[:, 1]).any(1) & (corners[:, 1] != corners[:, 2]).any(1)
    return corners[distinct & ends & joined]


def cause(file, ours, refusal, theirs, their_refusal):
    """What the two readings of a file have in common or not, in some words."""
    if ours is None:
        words = " ".join(refusal.replace(str(file), "").split()).lstrip(": ")
        return ("no triangle for either; we say: " if theirs is None or not len(theirs) else "refused: ") + words
    if theirs is None or not len(theirs):
        return "trimesh has no triangle of it"
    size = max(1e-300, float(numpy.abs(box(ours)).max()))
    if len(ours) == len(theirs) and numpy.abs(ours - theirs).max() <= 1e-6 * size:
        return "the same"
    ours, theirs = without_slivers(ours), without_slivers(theirs)
    close = lambda a, b, tolerance: abs(a - b) <= tolerance
    same_box = numpy.abs(box(ours) - box(theirs)).max() <= 1e-6 * size
    same_volume = close(volume(ours), volume(theirs), 1e-6 * size**3)
    if len(ours) == len(theirs) and same_box and same_volume:
        return "the same triangles in another order, or without triangles of two corners"
    if same_box and same_volume and close(len(ours), len(theirs), 0):
        return "the same surface"
    if len(ours) == len(theirs) and same_box and close(area(ours).sum(), area(theirs).sum(), 1e-6 * size**2):
        return "facets turned by one of the two"
    if len(ours) == len(theirs) and same_box:
        return "polygons cut along other diagonals"
    if file.suffix.lower() == ".obj" and re.search(rb"^f .*-\d", file.read_bytes(), re.MULTILINE):
        return "indices below 0, which trimesh counts from the end of the file and not from the line"
    return f"different: {len(ours)} and {len(theirs)} triangles, boxes {'equal' if same_box else 'differ'}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--all", action="store_true", help="a line for each file")
    given = parser.parse_args()
    count = collections.Counter()
    for file in sorted(f for f in given.folder.rglob("*") if f.is_file() and f.suffix.lower() in ENDINGS):
        ours, refusal = corners_by_us(file)
        theirs, their_refusal = corners_by_trimesh(file)
        found = cause(file, ours, refusal, theirs, their_refusal)
        count[found] += 1
        if given.all or found.startswith("different"):
            print(f"{file.relative_to(given.folder)}: {found}")
    print(f"\n{sum(count.values())} files")
    for found, number in count.most_common():
        print(f"{number:5} {found}")
    return any(found.startswith("different") for found in count)


if __name__ == "__main__":
    raise SystemExit(main())
