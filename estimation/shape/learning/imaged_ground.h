// Finds the ground of a target that no camera saw. A shape model is smooth there, and so should a fit be.
#pragma once

#include <vector>

#include "descriptor/surface/surface_statistics.h"
#include "recipe/recipe.h"

namespace astrolith {

struct ImagedGround {
  // The share of the surface that is smooth, in one piece; 0 where it is no larger than by chance.
  double smooth_share = 0.0;
  // The metaballs whose ground has details, ascending; empty where all or none have.
  std::vector<int> metaballs;
};

// A place is smooth if the mean logarithm of roughness within 6 edges, over the places within 10 edges, lies
// 2 below the third quartile: a residual of less than a seventh of the rougher ground's. The largest piece
// of smooth places counts if it holds at least 3 % of all. `spheres` are the body's, in the frame of the
// statistics.
ImagedGround find_imaged_ground(const SurfaceStatistics& target, const std::vector<Sphere>& spheres);

// ImagedGround::smooth_share alone: ground that the model's makers did not see, or a plain.
double unseen_share(const SurfaceStatistics& target);

}  // namespace astrolith
