// How far from the origin a box reaches along any axis: float positions in it are rounded in proportion.
#pragma once

#include <algorithm>
#include <cmath>

#include "numerics/vec3.h"

namespace astrolith {

inline double largest_coordinate(const Box& box) {
  return std::max({std::abs(box.min.x), std::abs(box.min.y), std::abs(box.min.z), std::abs(box.max.x),
                   std::abs(box.max.y), std::abs(box.max.z)});
}

}  // namespace astrolith
