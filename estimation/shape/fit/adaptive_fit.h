// Fits a model with a given number of metaballs, from a coarse start.
//
// The fit refines the model, removes idle metaballs and adds new ones where the error is largest, until it
// has as many as it may. Then it moves the least useful metaballs to where the error is largest, as long as
// the error decreases. Finally it refines the model on all samples, and repairs the surface away from the
// samples.
//
// Until the final refinement only as many samples are used as the metaballs need, to save time. The result is
// always the closest model measured, not the last.
#pragma once

#include <vector>

#include "estimation/shape/refinement/refinement.h"
#include "estimation/shape/target/target_body.h"
#include "geometry/surface/mesh_sampling.h"

namespace astrolith {

struct AdaptiveFitOptions {
  int spheres = 200;               // number of metaballs, at most, > 0
  int rounds = 6;                  // rounds of growth, > 0
  int first_iterations = 24;       // of the refinement before the first round of growth
  int round_iterations = 12;       // of the refinement after each round of growth
  int grown_iterations = 60;       // of the refinement once the number of metaballs is reached
  int relocations = 40;            // rounds of relocation, at most
  int relocation_iterations = 20;  // of the refinement after each round of relocation
  int last_iterations = 60;        // of the refinement on all samples
  double subtractive = 0.5;        // share of the metaballs that may be subtractive
  double relocated = 0.15;         // share of the metaballs that the first relocation moves
  double least_relocated = 0.01;   // share that a relocation moves at least; with fewer the fit goes on
  double relocation_gain = 3e-3;   // share of the mean distance; a smaller gain lets fewer move:
  int fewer_relocated = 3;         // two parts of so many, > 2
  int samples_per_sphere = 60;     // used until the final refinement
  double least_decrease = 1e-4;    // share of the cost; a refinement ends with a round that lowers it by less
  double tolerance = 0.0;          // growth stops at this mean |s| over the samples, fraction of the diagonal
  double loss_scale = 1e-3;        // fraction of the diagonal
  double containment_weight = 0.2;  // fraction of the diagonal, >= 0
  int repair_resolution = 256;  // cells along the longest side of the mesh in which islands are looked for
};

// The default options for this number of metaballs, 1 to 10000. Fits with many metaballs converge slowly, and
// each of their iterations costs more. From 250 to 1000 metaballs the refinements grow steadily to twice as
// many iterations, the rounds of relocation fall from 40 to 13, and those that gain little end sooner.
// Beyond, these rounds and the iterations once the number is reached fall as one over it. From 2000 metaballs
// on a refinement ends with a round that lowers the cost by less than 1e-3, ten times what it is below 1000.
AdaptiveFitOptions options_for(int spheres);

struct ConvergencePoint {
  int iterations = 0;          // of Levenberg-Marquardt so far
  int spheres = 0;             // number of metaballs
  double mean_distance = 0.0;  // mean |s| over all samples, fraction of the diagonal
};

struct AdaptiveFitSummary {
  MetaballModel model;  // in the target's frame
  std::vector<ConvergencePoint> convergence;
  bool interrupted = false;  // progress asked to stop; the model is the best so far
};

// `samples` are points and smooth normals of the target's surface in random order. `containment` holds points
// inside and outside of the target; the fit adds to its copy the points that the repair finds. Throws
// WorkError if a refinement fails at its start.
AdaptiveFitSummary fit_adaptively(const TargetBody& target, const MetaballModel& start,
                                  const SurfaceSamples& samples, const FitPoints& containment,
                                  const AdaptiveFitOptions& options, const Progress& progress = {});

}  // namespace astrolith
