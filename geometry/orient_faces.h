// Makes the faces of a mesh look the same way.
#pragma once

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Winds neighbouring faces alike, then each connected part so that its own volume is positive (a cavity's
// wall is a part of its own and comes out wound like a body). Faces are neighbours across edges that exactly
// two faces share; a one-sided surface keeps a seam. Only the order of a face's vertices changes. Indices
// must be in range.
TriangleMesh orient_faces(TriangleMesh mesh);

}  // namespace astrolith
