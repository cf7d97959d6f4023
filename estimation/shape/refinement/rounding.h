// Rounds a model's numbers to few digits so that the surface moves as little as possible.
//
// Rounding each number by itself moves every metaball at random. Here the numbers are rounded one after
// another, and each next one first makes up for the errors of those before it, as far as it can: with H = L
// L^T the normal equations of the refinement at the model p, the rounded numbers q approximately minimise (q
// - p)^T H (q - p) = |L^T (q - p)|^2. That is Babai's nearest plane (L. Babai, "On Lovasz' lattice reduction
// and the nearest lattice point problem", 1986). Metaballs overlap, so that most errors can be made up for.
#pragma once

#include <memory>
#include <vector>

#include "estimation/shape/refinement/refinement.h"

namespace astrolith {

// A place in the frame of the file that the numbers are written for: p_file = origin + scale * p_model.
struct FileFrame {
  Vec3d origin;
  double scale = 1.0;  // > 0
};

class ModelRounding {
 public:
  // Assembles and factorises the normal equations of the model on the points, which costs about as much as a
  // step of the refinement. `damping` > 0 keeps numbers near those of the model: a larger one makes up for
  // less, and needs the surface to be linear in the numbers only close to the model.
  ModelRounding(const MetaballModel& model, const FitPoints& points, const RefinementOptions& options,
                double damping);
  ~ModelRounding();

  // The model whose coordinates and radii are whole multiples of `step` > 0 in the file's unit; a radius is
  // at least one step. The result is in the model's frame, and its sharpness stays.
  MetaballModel rounded(const FileFrame& frame, double step) const;

 private:
  struct Factor;
  MetaballModel model_;
  std::unique_ptr<Factor> factor_;
};

}  // namespace astrolith
