// Finds the ground of a target that no camera saw. A shape model is smooth there.
#pragma once

#include "descriptor/surface/surface_statistics.h"

namespace astrolith {

// The share of the surface that is smooth in one piece: ground that the model's makers did not see, or a
// plain; 0 where it is no larger than by chance.
//
// A place is smooth if the mean logarithm of roughness within 6 edges, over the places within 10 edges, lies
// 2 below the third quartile: a residual of less than a seventh of the rougher ground's. The largest piece
// of smooth places counts if it holds at least 3 % of all.
double unseen_share(const SurfaceStatistics& target);

}  // namespace astrolith
