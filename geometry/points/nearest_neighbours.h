// The nearest other points of every point of a cloud.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

// (n x k) row i holds the indices of the k points nearest to point i, without i itself, the nearest first.
// A k-d tree finds them (nanoflann), so of points that are equally near any may come first, always the same
// one. Throws InputError unless 1 <= k < n, and for numbers that are not finite.
std::vector<std::uint32_t> nearest_neighbours(std::span<const Vec3d> points, int k);

}  // namespace astrolith
