"""Tells whether the mesh of a PLY file of synth is a closed 2-manifold, without any code of synth."""
import struct


def triangles_of(ply):
    """The vertex numbers of all triangles of a binary PLY file of synth, and the number of vertices."""
    data = ply.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode("ascii", "replace").splitlines()
    counts = {line.split()[1]: int(line.split()[2]) for line in header if line.startswith("element ")}
    names = [line.split()[-1] for line in header if line.startswith("property float")]
    first = end + 4 * len(names) * counts["vertex"]
    faces = struct.iter_unpack("<BIII", data[first:first + 13 * counts["face"]])
    return [face[1:] for face in faces], counts["vertex"]


def defect_of(ply):
    """Why a mesh is no closed 2-manifold; empty if it is one."""
    triangles, vertices = triangles_of(ply)
    if not triangles:
        return "no triangle"
    after = {}  # (vertex, next vertex) -> the third vertex of their triangle
    around = [0] * vertices
    for t in triangles:
        if len(set(t)) != 3:
            return "a triangle without area"
        for k in range(3):
            edge = (t[k], t[(k + 1) % 3])
            if edge in after:
                return "an edge with two triangles on one side"
            after[edge] = t[(k + 2) % 3]
            around[t[k]] += 1
    start = {}
    for a, b in after:
        if (b, a) not in after:
            return "an open edge"
        start.setdefault(a, b)
    for vertex, first in start.items():  # the triangles around a vertex must form one cycle
        steps, at = 0, first
        while True:
            at = after[(vertex, at)]
            steps += 1
            if at == first or steps > around[vertex]:
                break
        if steps != around[vertex]:
            return "a vertex with several fans"
    return "" if len(start) == vertices else "a vertex without triangle"
