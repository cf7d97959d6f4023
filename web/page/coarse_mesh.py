"""A mesh in few bytes, for the page: coarse_mesh.js reads it.

A line of JSON, {figures, color, low, step, vertices}, and then bytes: the low bytes of all numbers, and their high bytes.
Numbers are 16 bits wide: positions in steps from the corner `low`, x of all vertices, y, z, each less the one before, with the
sign in the lowest bit; and the vertices of triangles as how far they lie below the next that has not been named.
"""

import itertools
import json
import struct

STEPS = 1023  # along the longest side
TYPES = {"float": "f", "uchar": "B", "double": "d"}


def read_ply(file):
    """Vertices as tuples in the order of the header's properties, and triangles, of a binary mesh that synth wrote."""
    content = file.read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    words = [line.split() for line in content[:end].decode().splitlines()]
    counts = {w[1]: int(w[2]) for w in words if w[0] == "element"}
    properties = [w[1:] for w in words if w[0] == "property" and w[1] != "list"]
    row = struct.Struct("<" + "".join(TYPES[kind] for kind, _ in properties))
    body = end + row.size * counts["vertex"]
    vertices = [dict(zip((name for _, name in properties), values)) for values in row.iter_unpack(content[end:body])]
    triangles = [three for _, *three in struct.Struct("<B3I").iter_unpack(content[body : body + 13 * counts["face"]])]
    return vertices, triangles


def in_order_of_use(vertices, triangles):
    places = {}
    renamed = [[places.setdefault(i, len(places)) for i in triangle] for triangle in triangles]
    return [vertices[i] for i in places], renamed


def differences(numbers):
    changes = (b - a for a, b in itertools.pairwise([0, *numbers]))
    return [2 * abs(change) - (change < 0) for change in changes]


def packed(file, figures):
    """The bytes of a mesh; figures are those of its summary."""
    vertices, triangles = in_order_of_use(*read_ply(file))
    at = [[v[axis] for v in vertices] for axis in "xyz"]
    low, extent = [min(column) for column in at], [max(column) - min(column) for column in at]
    step = max(extent) / STEPS
    numbers = [n for column, least in zip(at, low) for n in differences([round((x - least) / step) for x in column])]
    named = 0
    for vertex in itertools.chain.from_iterable(triangles):
        numbers.append(named - vertex)
        named = max(named, vertex + 1)
    color = [round(sum(v[c] for v in vertices) / len(vertices)) for c in ("red", "green", "blue")] if "red" in vertices[0] else None
    told = {name: figures[name] for name in ("triangles", "closed", "components", "length_unit")}
    head = {"figures": {**told, "extent": extent}, "color": color, "low": low, "step": step, "vertices": len(vertices)}
    return json.dumps(head).encode() + b"\n" + bytes(n & 255 for n in numbers) + bytes(n >> 8 for n in numbers)
