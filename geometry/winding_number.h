// The winding number of a closed mesh about a point.
#pragma once

#include "geometry/triangle_mesh.h"

namespace astrolith {

// For a closed oriented mesh: 1 inside, 0 outside, 2 where two bodies overlap, -1 inside a body that is
// inside out. It is the sum of the solid angles of all triangles as seen from p, over 4 pi (Van Oosterom and
// Strackee, "The solid angle of a plane triangle", 1983). It is undefined on the surface.
double winding_number(const TriangleMesh& mesh, const Vec3d& p);

}  // namespace astrolith
