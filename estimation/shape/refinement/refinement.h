// Refines a model: moves all centres and radii and the shared sharpness so that the surface passes through
// samples of the target. The method is Levenberg-Marquardt on the first-order distance s of every sample
// (estimation/shape/model/block_kernels.h).
//
// The cost is half the sum of the squares of these residuals, in length units:
//   a sample on the surface     phi(s(p)),  phi^2 = 2 c^2 (sqrt(1 + s^2 / c^2) - 1)
//   a point inside              weight * max(0, margin - L(p))
//   a point outside             weight * max(0, margin + L(p))
//   an additive centre          center_weight * max(0, r_i / 20 - d(c_i)),  d the target's signed distance
// phi is the pseudo-Huber loss, which limits the influence of bad vertices. The other residuals keep cavities
// and islands away: without them a surface far from all samples would cost nothing. The centre of an additive
// metaball lies inside the model, so a centre outside the target makes an island or a spike.
//
// The solver is our own and not Ceres; only the sparse factorisation comes from a library (CHOLMOD). It is
// not faster: both take the same processor time for 60 iterations on 200 metaballs, within a tenth. Its final
// cost was lower on Itokawa and Eros, by 1.7 % and 6.9 %, and higher on Bennu, by 0.2 %. It shortens the
// steps of single spheres, which Ceres cannot. Its result is the same for every number of threads, because
// sums run in a fixed order; with two threads in Ceres the bytes change. docs/method.md has the figures and
// the command.
#pragma once

#include <vector>

#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/target/target_body.h"
#include "geometry/surface/surface_tree.h"
#include "numerics/progress.h"

namespace astrolith {

struct RefinementOptions {
  int max_iterations = 30;                           // of all rounds together, > 0
  int iterations_per_round = 6;                      // after which lists of neighbours are made anew, > 0
  double loss_scale = 0.0;                           // c, length units, > 0
  double containment_weight = 0.0;                   // length units, >= 0
  const SurfaceTree* keep_centers_inside = nullptr;  // the target, or null if centres may leave it
  double center_weight = 1.0;                        // >= 0
  double containment_margin = 0.02;                  // a level; the level at a lone centre is 1
  double relative_decrease = 1e-4;                   // a round with a smaller decrease is the last
};

struct RefinementSummary {
  MetaballModel model;
  int iterations = 0;  // steps that were tried
  double initial_cost = 0.0;
  double final_cost = 0.0;
  bool interrupted = false;  // progress asked to stop; the model is the best so far
};

// Calls progress before every iteration and stops if it asks to. Throws WorkError if the cost of the start is
// not finite.
RefinementSummary refine(const MetaballModel& start, const FitPoints& points,
                         const RefinementOptions& options, const Progress& progress = {});

}  // namespace astrolith
