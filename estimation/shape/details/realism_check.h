// Whether the surface of a fitted recipe passes for the target's, over several seeds of its noise.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "descriptor/surface/realism.h"
#include "estimation/shape/target/target_body.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

struct FitRealism {
  RealismVerdict verdict;                     // medians over the seeds, lengths as fractions of the diagonal
  std::vector<RealismVerdict> seed_verdicts;  // the recipe's own seed first
  TriangleMesh mesh;                          // of the recipe's own seed, in the target's frame
  SurfaceStatistics target, fit;              // of the target, and of that mesh
};

// Meshes the recipe (in the file's frame) with twice the target's triangles, at most 240,000, once for each
// seed; a body without layers has one mesh. Marching cubes need so many, since part of their triangles are
// slivers: the target itself, meshed anew with as many triangles as it has, is a little too smooth. Both
// surfaces are sampled alike (descriptor/surface). A fit with other parts or handles than the target's does
// not pass. Throws InputError for a target that surface_statistics() refuses, and WorkError when progress
// asks to stop.
FitRealism check_realism(const TargetBody& target, const Recipe& recipe, int seeds, std::uint64_t seed,
                         const Progress& progress);

}  // namespace astrolith
