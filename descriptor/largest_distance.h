// The diameter of a set of points.
#pragma once

#include <span>

#include "numerics/vec3.h"

namespace astrolith {

// Exact up to rounding: the largest distance between two of the points, in their unit; 0 for fewer than two.
// Points must be finite. Pairs that cannot reach it, by their distances from the box's centre, are not looked
// at.
double largest_distance(std::span<const Vec3d> points);

}  // namespace astrolith
