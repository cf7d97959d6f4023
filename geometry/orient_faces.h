// Winds the faces of a mesh consistently and outwards.
#pragma once

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Winds neighbouring faces alike, and then each connected component such that its own volume is positive. The
// wall of a cavity is a component of its own and comes out wound like a body. Faces are neighbours across
// edges that exactly two faces share; a one-sided surface keeps a seam. Only the order of a face's vertices
// changes. Indices must be in range.
TriangleMesh orient_faces(TriangleMesh mesh);

}  // namespace astrolith
