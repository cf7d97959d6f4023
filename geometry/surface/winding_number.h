// How often a mesh winds around a point.
#pragma once

#include "geometry/triangle_mesh.h"

namespace astrolith {

// For a closed oriented mesh: 1 inside, 0 outside, 2 where two bodies overlap, -1 inside what is inside out.
// A sum over all triangles of the solid angles they are seen under (Van Oosterom and Strackee, "The solid
// angle of a plane triangle", 1983); undefined on the surface.
double winding_number(const TriangleMesh& mesh, const Vec3d& p);

}  // namespace astrolith
