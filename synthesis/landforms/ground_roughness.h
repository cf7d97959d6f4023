// How rough ground is at one distance, of heights over a surface.
#pragma once

#include <cmath>

#include "numerics/tangent_frame.h"
#include "numerics/vec3.h"

namespace astrolith {

// The root mean square, over four pairs of opposite points at `distance` from p in the tangent plane, of what
// the height at p differs from the mean of the two. Ground that is plane, flat or steep, has 0. `height` is a
// function of a point near the surface, and `normal` the surface's unit normal at p. Lengths in one unit.
template <class Height>
double roughness_around(const Vec3d& p, const Vec3d& normal, double distance, const Height& height) {
  constexpr double kHalfRoot = 0.7071067811865476;  // of 2
  constexpr double kDirections[4][2] = {{1, 0}, {kHalfRoot, kHalfRoot}, {0, 1}, {-kHalfRoot, kHalfRoot}};
  const auto [u, v] = crossed_tangents(normal);
  const double middle = height(p);
  double sum = 0.0;
  for (const auto& [east, north] : kDirections) {
    const Vec3d step = distance * (east * u + north * v);
    const double bend = 0.5 * (height(p + step) + height(p - step)) - middle;
    sum += bend * bend;
  }
  return std::sqrt(sum / 4.0);
}

}  // namespace astrolith
