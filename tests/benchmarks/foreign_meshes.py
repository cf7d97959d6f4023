#!/usr/bin/env python3
"""Reads mesh files that other projects made with our readers and with trimesh, and explains every difference.

    foreign_meshes.py FOLDER [--all]

Needs the Python package of the build on PYTHONPATH, numpy, trimesh and pillow. Compared are the corners of all triangles, in
order: their number, their box and the signed volume. Vertices themselves are no measure, since readers join and split
them. Prints a table of the differences by cause, and with --all a line for each file. Exit status 1 if a difference has
no cause, or if a reader does not end in a mesh or in one line.
"""

import collections
import re
import warnings

import astrolith
import numpy
import trimesh

from measure import arguments_of

ENDINGS = {".obj", ".ply", ".stl", ".off"}


def by_us(file):
    """The corners of our triangles, or the words of the refusal."""
    try:
        mesh = astrolith.read_mesh(file)
    except ValueError as error:
        return None, str(error)
    return numpy.asarray(mesh.vertices)[numpy.asarray(mesh.faces)], ""


def by_trimesh(file):
    """The corners of trimesh's triangles; none where it refuses the file."""
    try:
        mesh = trimesh.load(file, process=False, maintain_order=True, force="mesh", skip_materials=True)
        return numpy.asarray(mesh.triangles, dtype=float).reshape(-1, 3, 3)
    except Exception:  # a library's reader may end in any way
        return numpy.zeros((0, 3, 3))


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
    return corners[(corners != numpy.roll(corners, 1, axis=1)).any(2).all(1)]


def cause(file, ours, refusal, theirs):
    """What the two readings of a file have in common or not, in some words."""
    if ours is None:
        words = " ".join(refusal.replace(str(file), "").split()).lstrip(": ")
        return ("no triangle for either; we say: " if not len(theirs) else "refused: ") + words
    if not len(theirs):
        return "trimesh has no triangle of it"
    size = max(1e-300, float(numpy.abs(box(ours)).max()))
    if len(ours) == len(theirs) and numpy.abs(ours - theirs).max() <= 1e-6 * size:
        return "the same"
    ours, theirs = without_slivers(ours), without_slivers(theirs)
    same_box = numpy.abs(box(ours) - box(theirs)).max() <= 1e-6 * size
    if len(ours) == len(theirs) and same_box:
        if abs(volume(ours) - volume(theirs)) <= 1e-6 * size**3:
            return "the same triangles in another order, or without triangles of two corners"
        turned = abs(area(ours).sum() - area(theirs).sum()) <= 1e-6 * size**2
        return "facets turned by one of the two" if turned else "polygons cut along other diagonals"
    if file.suffix.lower() == ".obj" and re.search(rb"^f .*-\d", file.read_bytes(), re.MULTILINE):
        return "indices below 0, which trimesh counts from the end of the file and not from the line"
    return f"different: {len(ours)} and {len(theirs)} triangles, boxes {'equal' if same_box else 'differ'}"


def main():
    given = arguments_of(__doc__, "folder", all={"action": "store_true", "help": "a line for each file"})
    warnings.simplefilter("ignore")
    count = collections.Counter()
    for file in sorted(f for f in given.folder.rglob("*") if f.is_file() and f.suffix.lower() in ENDINGS):
        found = cause(file, *by_us(file), by_trimesh(file))
        count[found] += 1
        if given.all or found.startswith("different"):
            print(f"{file.relative_to(given.folder)}: {found}")
    print(f"\n{sum(count.values())} files")
    for found, number in count.most_common():
        print(f"{number:5} {found}")
    return any(found.startswith("different") for found in count)


if __name__ == "__main__":
    raise SystemExit(main())
