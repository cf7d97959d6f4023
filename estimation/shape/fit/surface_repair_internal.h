// The end of an adaptive fit: repairs the surface where no sample constrains it.
#pragma once

#include "estimation/shape/fit/adaptive_fit.h"
#include "estimation/shape/fit/component_repair.h"
#include "estimation/shape/fit/tracked_model_internal.h"

namespace astrolith {

// Looks for islands, cavities and bridges in the mesh of the model, and repairs them for up to four rounds.
// Islands lose their metaballs, cavities are filled, stray vertices become containment points, and the model
// is refined once more. The present model of `fit` is then the best of the models measured: first the one
// with the fewest wrong components, and among equals the one with the least mean distance.
void repair_surface(const TargetBody& target, const AdaptiveFitOptions& options, InsideWatch& watch,
                    TrackedModel& fit);

}  // namespace astrolith
