// The diameter of a set of points.
#pragma once

#include <span>

#include "numerics/progress.h"
#include "numerics/vec3.h"

namespace astrolith {

// The largest distance between two of the points, in their unit, exact up to rounding; 0 for fewer than two
// points. Points must be finite. Pairs that cannot reach it, judged by their distances from the centre of the
// bounding box, are not examined. Throws WorkError when progress asks to stop.
double largest_distance(std::span<const Vec3d> points, const Progress& progress = {});

}  // namespace astrolith
