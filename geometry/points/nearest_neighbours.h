// The nearest other points of every point of a cloud.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

// (n x k) row i holds the indices of the k points nearest to point i, the nearest first, without i itself.
// Among equally near points the k-d tree (nanoflann) decides which comes first, the same in every run. Throws
// InputError unless 1 <= k < n, and for coordinates that are not finite.
std::vector<std::uint32_t> nearest_neighbours(std::span<const Vec3d> points, int k);

}  // namespace astrolith
