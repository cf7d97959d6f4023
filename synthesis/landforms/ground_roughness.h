// How rough ground is at one distance, of heights over a surface.
#pragma once

#include <cmath>

#include "numerics/tangent_frame.h"
#include "numerics/vec3.h"

namespace astrolith {

// The root mean square, over six places within four distances of p in the tangent plane, of what the height
// at a place differs from the mean of those of two opposite points at `distance` from it. Ground that is
// plane, flat or steep, has 0. The places are spread evenly, and the pairs lie in directions that are, too:
// at p alone rough ground would have stripes of 0, where it bends neither up nor down. `height` is a function
// of a point near the surface, and `normal` the surface's unit normal at p. Lengths in one unit.
template <class Height>
double roughness_around(const Vec3d& p, const Vec3d& normal, double distance, const Height& height) {
  constexpr int kPlaces = 6;
  constexpr double kWithin = 4.0;
  constexpr double kCosine = -0.7373688780783197, kSine = 0.6754902942615238;  // of the golden angle
  const auto [u, v] = crossed_tangents(normal);
  double east = 1.0, north = 0.0, sum = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const double radius = kWithin * distance * std::sqrt((i + 0.5) / kPlaces);
    const Vec3d place = p + radius * (east * u + north * v);
    // Twice the angle of the place.
    const Vec3d step = distance * ((east * east - north * north) * u + 2.0 * east * north * v);
    const double bend = 0.5 * (height(place + step) + height(place - step)) - height(place);
    sum += bend * bend;
    const double turned = kCosine * east - kSine * north;
    north = kSine * east + kCosine * north;
    east = turned;
  }
  return std::sqrt(sum / kPlaces);
}

}  // namespace astrolith
