// The body of a fit in as many bytes as it may take.
#pragma once

#include <cstddef>
#include <string>

#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/refinement/refinement.h"
#include "estimation/shape/target/target_body.h"

namespace astrolith {

struct RoundingOptions {
  std::size_t bytes = 0;           // the most of a compact recipe of the body alone, without provenance
  std::string length_unit = "km";  // of that recipe
  RefinementOptions refinement;    // the conditions of the fit; lengths are fractions of the diagonal
};

struct RoundedBody {
  MetaballBody body;           // in the file's frame and unit, its metaballs in the compact recipe's order
  double mean_distance = 0.0;  // mean |s| at the samples, fraction of the diagonal
};

// Rounds the model, which is in the target's frame, by ModelRounding. `points.on_surface` are the samples on
// which both are measured. All coordinates and radii are whole multiples of one decimal step. Throws
// InputError "bytes: ..." if the model does not fit into the bytes at all.
RoundedBody round_body(const TargetBody& target, const MetaballModel& model, const FitPoints& points,
                       const RoundingOptions& options);

}  // namespace astrolith
