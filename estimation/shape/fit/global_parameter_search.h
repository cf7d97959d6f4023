// Finds the global parameters of thesis section 4.3.4 with a derivative-free optimiser: the number of
// spheres, the tensions a and b, and the blend exponent m.
//
// A candidate is not meshed. Fixed points of the target's surface are projected onto the candidate's surface,
// and the surflet histogram of the projected points is compared with the histogram of the target's points:
//   fitness = 1 - similarity(target, candidate).
#pragma once

#include <vector>

#include "estimation/optimize/optimizer.h"
#include "estimation/shape/model/metaball_model.h"
#include "geometry/surface/mesh_sampling.h"
#include "numerics/progress.h"

namespace astrolith {

struct GlobalParameterSearchOptions {
  int max_spheres = 100;     // upper bound of the number of spheres, > 0
  OptimizeOptions optimize;  // algorithm, population, evaluations, seed
};

struct GlobalParameterSearchSummary {
  MetaballModel model;                            // the best candidate; its radii include sqrt(a/b)
  double a = 1.0, b = 1.0, blend_exponent = 1.0;  // its parameters
  double similarity = 0.0;                        // its similarity to the target, at most 1
  OptimizeResult optimization;
};

// `packing` is ordered by radius, the largest first, and not empty. `samples` are points and normals of the
// target's surface.
GlobalParameterSearchSummary search_global_parameters(const std::vector<Sphere>& packing,
                                                      const SurfaceSamples& samples,
                                                      const GlobalParameterSearchOptions& options,
                                                      const Progress& progress = {});

}  // namespace astrolith
