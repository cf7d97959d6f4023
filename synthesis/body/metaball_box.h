// The distances from the centre of a metaball to the points of a box.
#pragma once

#include <algorithm>
#include <cmath>

#include "numerics/vec3.h"
#include "synthesis/body/metaballs.h"

namespace astrolith {

ASTROLITH_HD inline double nearest_offset(double c, double lo, double hi) {
  return c < lo ? lo - c : c > hi ? c - hi : 0.0;
}
ASTROLITH_HD inline double farthest_offset(double c, double lo, double hi) {
  return std::max(std::fabs(c - lo), std::fabs(c - hi));
}

struct SquaredDistances {
  double nearest;
  double farthest;
};

// The squared distances from the centre of a sphere to the nearest and the farthest point of the box.
ASTROLITH_HD inline SquaredDistances squared_distances(const MetaballSphere<float>& sphere, const Box& box) {
  const Vec3d c{sphere.center.x, sphere.center.y, sphere.center.z};
  const Vec3d nearest{nearest_offset(c.x, box.min.x, box.max.x), nearest_offset(c.y, box.min.y, box.max.y),
                      nearest_offset(c.z, box.min.z, box.max.z)};
  const Vec3d farthest{farthest_offset(c.x, box.min.x, box.max.x), farthest_offset(c.y, box.min.y, box.max.y),
                       farthest_offset(c.z, box.min.z, box.max.z)};
  return {squared_norm(nearest), squared_norm(farthest)};
}

// 1 / r^2 of a sphere that adds or of a subtractive one.
ASTROLITH_HD inline double inverse_square(const MetaballSphere<float>& sphere) {
  return std::fabs(static_cast<double>(sphere.inverse_radius_squared));
}

// Relative slack of squared distances. It exceeds the error of float points and of float arithmetic.
inline constexpr double kDistanceSlack = 1e-5;

// Whether the support of the sphere reaches the box. The support ends at sqrt(cutoff_squared) radii.
ASTROLITH_HD inline bool reaches_box(const MetaballSphere<float>& sphere, double cutoff_squared,
                                     const Box& box) {
  return !(squared_distances(sphere, box).nearest * inverse_square(sphere) >
           cutoff_squared * (1.0 + kDistanceSlack));
}

}  // namespace astrolith
