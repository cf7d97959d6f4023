// First-order projection of a point on the base surface, p0 = p - s g/|g|, so that heights are constant along
// the normal.
#pragma once

#include "numerics/host_device.h"
#include "numerics/scalar_math.h"

namespace astrolith {

// `floor` keeps it above 0.
ASTROLITH_KERNEL float gradient_length(float gx, float gy, float gz, float floor) {
  return math::sqrt(math::fma(gx, gx, math::fma(gy, gy, gz * gz)) + floor);
}

// Along one axis. Steps end at `longest_step`: no point of the surface is farther from the base than that.
ASTROLITH_KERNEL float projected_coordinate(float p, float gradient, float length, float distance,
                                            float longest_step) {
  const float step = math::clamp(distance, -longest_step, longest_step);
  return math::fma(-step, gradient / length, p);
}

}  // namespace astrolith
