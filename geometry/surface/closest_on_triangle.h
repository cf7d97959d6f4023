// The point of a triangle nearest to another point, and the feature of the triangle (corner, side or face)
// that it lies on.
#pragma once

#include <cstdint>

#include "numerics/vec3.h"

namespace astrolith {

enum class TriangleFeature : std::uint8_t { corner_a, corner_b, corner_c, side_ab, side_bc, side_ca, face };

struct ClosestOnTriangle {
  Vec3d point;
  double squared_distance = 0;
  TriangleFeature feature = TriangleFeature::face;
};

// The point of triangle a b c nearest to p. The triangle may have shrunk to a segment or a point. The test
// follows the Voronoi regions of the triangle (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
ClosestOnTriangle closest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c);

}  // namespace astrolith
