// The body of a fit in as many bytes as it may take, or with the digits that matter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/refinement/refinement.h"
#include "estimation/shape/target/target_body.h"

namespace astrolith {

struct RoundingOptions {
  std::size_t bytes = 0;           // the most of a compact recipe of the body alone, without provenance
  std::string length_unit = "km";  // of that recipe
  int check_resolution = 256;      // cells along the longest side of the mesh in which parts are counted
  RefinementOptions refinement;    // the conditions of the fit; lengths are fractions of the diagonal
};

struct RoundedBody {
  MetaballBody body;           // in the file's frame and unit, its metaballs in the compact recipe's order
  double mean_distance = 0.0;  // mean |s| at the samples, fraction of the diagonal
  std::int64_t wrong_components = 0;  // parts that the target has not, and those that the body lacks
};

// Rounds the model, which is in the target's frame, by ModelRounding. `points.on_surface` are the samples on
// which both are measured. All coordinates and radii are whole multiples of one decimal step. Of several
// roundings the one with the fewest wrong components is taken, and of equals the one with the least mean
// distance. Throws InputError "bytes: ..." if the model does not fit into the bytes at all.
RoundedBody round_body(const TargetBody& target, const MetaballModel& model, const FitPoints& points,
                       const RoundingOptions& options);

// Rounds the model to the fewest decimals with which the mean distance grows by at most the share `most_loss`
// and no part is lost or added: what a recipe in JSON needs. `options.bytes` and the unit are not used.
// Returns nothing if no decimals are enough.
std::optional<RoundedBody> round_body_to_digits(const TargetBody& target, const MetaballModel& model,
                                                const FitPoints& points, const RoundingOptions& options,
                                                double most_loss);

}  // namespace astrolith
