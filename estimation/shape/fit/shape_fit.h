// A closed mesh becomes a recipe of metaballs: the whole fit of thesis section 4.3 for the base shape.
//
//   ShapeFitResult fit = fit_shape(prepare_target(read_mesh("bennu.ply"), "bennu.ply"), ShapeFitOptions{});
//   recipe.body = fit.body;
#pragma once

#include <functional>
#include <string>

#include "estimation/optimize/optimizer.h"
#include "estimation/shape/fit/adaptive_fit.h"
#include "estimation/shape/fit/fit_check.h"
#include "estimation/shape/target/target_body.h"

namespace astrolith {

// What the last refinement sees by default: with fewer the fit follows the samples and not the body.
inline constexpr std::int64_t kPointsPerSphere = 120;
inline constexpr std::int64_t kFewestPoints = 4000;

struct ShapeFitOptions {
  int spheres = 200;  // at most, 1 .. 10000
  Kernel kernel = Kernel::kGaussian;
  double subtract = 0.5;    // share of the spheres that may take away, 0 .. 0.9; Gaussians alone
  std::int64_t points = 0;  // of the target's surface that the refinement sees; 0 = kPointsPerSphere a sphere
  double tolerance = 0.0;   // no more spheres are added below this mean distance, fraction of the diagonal
  OptimizerAlgorithm optimizer = OptimizerAlgorithm::pso;
  int population = 20;                  // of the optimiser
  int generations = 20;                 // of the optimiser: population * generations evaluations
  int check_resolution = 256;           // cells along the longest side of the mesh that is measured
  std::int64_t check_samples = 100000;  // fresh points of each surface in the final distances
  std::uint64_t seed = 1;
};

struct ShapeFitResult {
  MetaballBody body;        // in the file's frame and unit
  FitCheck check;           // of that body, in the target's frame: lengths are fractions of the diagonal
  double similarity = 0.0;  // ahd, of 5,000 fresh Poisson-disk samples of target and of fit
  double similarity_floor =
      0.0;  // of two Poisson-disk samplings of the target: no fit can be told from 1 above it
  double filling_rate = 0.0;                  // of the packing
  double base_similarity = 0.0;               // of the optimiser's winner, on its own points
  int base_spheres = 0;                       // that the optimiser chose
  std::int64_t evaluations = 0;               // of the optimiser's fitness
  std::vector<double> search_history;         // best 1 - similarity after each generation
  std::vector<ConvergencePoint> convergence;  // of the refinement
  bool interrupted = false;                   // progress asked to stop; this is the best so far
};

// Makes a progress callback for a stage ("pack", "search", "refine", "check").
using StageProgress = std::function<Progress(const std::string& stage)>;

// The same target, options and seed give the same body for every number of threads. Throws InputError for
// options out of range and for a body in which no sphere fits.
ShapeFitResult fit_shape(
    const TargetBody& target, const ShapeFitOptions& options,
    const StageProgress& progress = [](const std::string&) { return Progress(); });

// Sets check, similarity and similarity_floor from the result's body, as fit_shape does at its end.
void measure_fit(const TargetBody& target, const ShapeFitOptions& options, ShapeFitResult& result);

}  // namespace astrolith
