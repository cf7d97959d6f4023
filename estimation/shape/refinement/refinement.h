// Moves all centres and radii, and the shared sharpness, so that the surface passes through samples of the
// target: Levenberg and Marquardt on the first-order distance of every sample.
//
// Residuals, in length units:
//   on the surface   phi(s(p)),  phi^2 = 2 c^2 (sqrt(1 + s^2 / c^2) - 1)   pseudo-Huber: bad vertices pull
//   little inside, outside  weight * max(0, margin - L(p)),  weight * max(0, margin + L(p))
//   of every centre that adds      center_weight * max(0, r_i / 20 - d(c_i)),  d the target's signed distance
// The second and third kind keep cavities and islands away: a surface that no sample lies on costs nothing
// otherwise. Every centre that adds is inside the model, so one outside the target is an island or a spike.
// The solver is our own and not Ceres: at these sizes Ceres spent most of its time multiplying small blocks,
// and it cannot shorten the steps of single spheres, without which a few in a neck stop the whole fit. What
// is left to a library is the sparse factorisation (CHOLMOD).
// Sums run in a fixed order, so that the result is the same for every thread count.
#pragma once

#include <vector>

#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/target/fit_points.h"
#include "geometry/surface/surface_tree.h"
#include "numerics/progress.h"

namespace astrolith {

struct RefinementOptions {
  int max_iterations = 30;                           // of Levenberg and Marquardt, all rounds together, > 0
  int iterations_per_round = 6;                      // before the lists of neighbours are made anew, > 0
  double loss_scale = 0.0;                           // c, length units, > 0
  double containment_weight = 0.0;                   // length units, >= 0
  const SurfaceTree* keep_centers_inside = nullptr;  // the target, or null: centres may leave it
  double center_weight = 1.0;
  double containment_margin = 0.02;  // of the level L, which is 1 at a lone centre
  double relative_decrease = 1e-4;   // stops when a round lowers the cost by less than this part
};

struct RefinementSummary {
  MetaballModel model;
  int iterations = 0;
  double initial_cost = 0.0;
  double final_cost = 0.0;
  bool interrupted = false;
};

// Progress is asked before every iteration. Throws WorkError when the solver fails at the start.
RefinementSummary refine(const MetaballModel& start, const FitPoints& points,
                         const RefinementOptions& options, const Progress& progress = {});

}  // namespace astrolith
