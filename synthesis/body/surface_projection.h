// The first-order projection of a point on the base surface, p0 = p - s g/|g|. Heights evaluated at p0 are
// constant along the normal.
#pragma once

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"

namespace astrolith {

// The length sqrt(|g|^2 + floor) of a gradient, which is never 0.
ASTROLITH_KERNEL float gradient_length(float gx, float gy, float gz, float floor) {
  return math::sqrt(math::fma(gx, gx, math::fma(gy, gy, gz * gz)) + floor);
}

// One coordinate of the projection. Steps are clamped to `longest_step`, since no point of the final surface
// is farther from the base surface.
ASTROLITH_KERNEL float projected_coordinate(float p, float gradient, float length, float distance,
                                            float longest_step) {
  const float step = math::clamp(distance, -longest_step, longest_step);
  return math::fma(-step, gradient / length, p);
}

// One coordinate of a projection, lifted along the outward normal by an elevation.
ASTROLITH_KERNEL float lifted_coordinate(float projected, float gradient, float length, float elevation) {
  return math::fma(-elevation, gradient / length, projected);
}

}  // namespace astrolith
