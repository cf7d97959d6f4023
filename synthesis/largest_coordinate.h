// How far from the origin a box reaches along any axis: float positions in it are rounded in proportion.
#pragma once

#include <algorithm>
#include <cmath>

#include "numerics/host_device.h"
#include "numerics/vec3.h"

namespace astrolith {

ASTROLITH_HD inline double largest_coordinate(const Box& box) {
  const double x = std::max(std::fabs(box.min.x), std::fabs(box.max.x)),
               y = std::max(std::fabs(box.min.y), std::fabs(box.max.y)),
               z = std::max(std::fabs(box.min.z), std::fabs(box.max.z));
  return std::max(std::max(x, y), z);
}

}  // namespace astrolith
