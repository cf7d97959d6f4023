"""Tells whether the mesh of a PLY file of synth is a closed 2-manifold, without any code of synth."""
import collections
import struct


def triangles_of(ply):
    """The vertex numbers of all triangles of a binary PLY file of synth, and the number of vertices."""
    data = ply.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode("ascii", "replace").splitlines()
    counts = {line.split()[1]: int(line.split()[2]) for line in header if line.startswith("element ")}
    first = end + 4 * sum(line.startswith("property float") for line in header) * counts["vertex"]
    faces = struct.iter_unpack("<BIII", data[first:first + 13 * counts["face"]])
    return [face[1:] for face in faces], counts["vertex"]


def defect_of(ply):
    """Why a mesh is no closed 2-manifold; empty if it is one."""
    triangles, vertices = triangles_of(ply)
    after = {}  # (vertex, next vertex) -> the third vertex of their triangle
    for a, b, c in triangles:
        after.update({(a, b): c, (b, c): a, (c, a): b})
    if not triangles or len(after) != 3 * len(triangles):
        return "no triangle, or an edge with two triangles on one side"
    if any(a == b or (b, a) not in after for a, b in after):
        return "a triangle without area, or an open edge"
    around = collections.Counter(a for a, _ in after)
    for vertex, first in dict(after.keys()).items():  # the triangles around a vertex form one cycle
        at, steps = first, 0
        while steps == 0 or (at != first and steps < around[vertex]):
            at, steps = after[vertex, at], steps + 1
        if steps != around[vertex]:
            return "a vertex with several fans"
    return "" if len(around) == vertices else "a vertex without triangle"
