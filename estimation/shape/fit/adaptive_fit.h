// From a coarse model to the budget of spheres: refine, remove what is idle, add where the error is largest,
// and again; then take the least useful spheres to where the error is largest as long as that pays; refine to
// the end on all samples, and mend what no sample saw.
//
// Until the end only as many samples are seen as the spheres need, for speed. The model that is kept is
// always the closest measured, not the last.
#pragma once

#include <vector>

#include "estimation/shape/refinement/refinement.h"
#include "estimation/shape/target/target_body.h"
#include "geometry/surface/mesh_sampling.h"

namespace astrolith {

struct AdaptiveFitOptions {
  int spheres = 200;          // the budget, > 0
  int rounds = 6;             // of growth, > 0
  int first_iterations = 24;  // of the refinement before the first round
  int round_iterations = 12;  // after each round of growth
  int grown_iterations = 60;  // once the budget is reached
  int relocations = 40;       // rounds of them, at most
  int relocation_iterations = 20;
  int last_iterations = 60;     // at the end, on all samples
  double subtractive = 0.5;     // share of the spheres that may take away, at most; Gaussians alone
  double relocated = 0.15;      // share of the spheres that a relocation takes elsewhere, at first
  int samples_per_sphere = 60;  // seen before the end
  double tolerance = 0.0;       // stops growing at this mean |s| over the samples, fraction of the diagonal
  double loss_scale = 1e-3;     // fraction of the diagonal
  double containment_weight = 0.2;
  int repair_resolution = 256;  // cells along the longest side of the mesh in which islands are looked for
};

struct ConvergencePoint {
  int iterations = 0;  // of Levenberg and Marquardt so far
  int spheres = 0;
  double mean_distance = 0.0;  // mean |s| over the samples
};

struct AdaptiveFitSummary {
  MetaballModel model;
  std::vector<ConvergencePoint> convergence;
  bool interrupted = false;  // progress asked to stop; the model is the best so far
};

// `samples` are points and smooth normals of the target's surface, in random order; `containment` holds
// points inside and outside of it and is extended by what the repair finds.
AdaptiveFitSummary fit_adaptively(const TargetBody& target, const MetaballModel& start,
                                  const SurfaceSamples& samples, const FitPoints& containment,
                                  const AdaptiveFitOptions& options, const Progress& progress = {});

}  // namespace astrolith
