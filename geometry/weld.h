// Welding: vertices at one place become one vertex, and faces on the same vertices become one face. Files
// without shared vertices need it before their faces can share edges.
#pragma once

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Merges each vertex into the first kept vertex within tolerance * bounding-box diagonal. Tolerance 0 merges
// only vertices with equal coordinates. The kept vertices stay in their order and keep their normals. Faces
// are renumbered and never dropped, so that a face may name a vertex twice afterwards. Throws
// std::invalid_argument unless 0 <= tolerance < 0.1. Indices must be in range.
TriangleMesh weld_vertices(TriangleMesh mesh, double tolerance);

// Drops faces that name a vertex twice, and faces on the same three vertices as an earlier face, in the same
// winding or the other. All vertices stay.
TriangleMesh drop_degenerate_and_repeated_faces(TriangleMesh mesh);

// The vertices that faces use, in their order, without normals and colours.
TriangleMesh without_unused_vertices(const TriangleMesh& mesh);

}  // namespace astrolith
