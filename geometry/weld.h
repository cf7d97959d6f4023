// Makes one vertex of vertices at the same place, and one face of faces on the same vertices: what files
// without shared vertices need before their edges can be said to meet.
#pragma once

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Merges each vertex into the first earlier one that was kept and lies within tolerance * bounding-box
// diagonal; tolerance 0 merges equal coordinates only. Order is kept, the first of each place with its normal
// stays. Faces are renumbered, never dropped: they may then name a vertex twice. Throws std::invalid_argument
// unless 0 <= tolerance < 0.1. Indices must be in range.
TriangleMesh weld_vertices(TriangleMesh mesh, double tolerance);

// Drops faces that name a vertex twice and faces on three vertices that an earlier face has already joined,
// in the same winding or in the other. Vertices stay.
TriangleMesh drop_degenerate_and_repeated_faces(TriangleMesh mesh);

}  // namespace astrolith
