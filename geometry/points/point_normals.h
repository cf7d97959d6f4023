// Normals of a point cloud, estimated from its points alone as the software of a scanner does.
#pragma once

#include <span>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

// (n) unit normals. Each is the normal of the plane that fits the point and its k nearest neighbours best in
// least squares (Hoppe et al., "Surface reconstruction from unorganized points", SIGGRAPH 1992). It points to
// the side of the hint, which may be the direction to the sensor. Where the points do not span a plane, it is
// one of the directions across them. Throws InputError unless there is a hint for each point and 2 <= k < n,
// and for coordinates that are not finite.
std::vector<Vec3d> point_normals(std::span<const Vec3d> points, std::span<const Vec3d> hints, int k);

}  // namespace astrolith
