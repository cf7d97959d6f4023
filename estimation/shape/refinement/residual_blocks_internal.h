// The residuals of refinement.h and their derivatives, in blocks. The points of a block lie close together
// and share one list of spheres.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "estimation/shape/model/block_kernels.h"
#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/model/model_evaluation_internal.h"
#include "estimation/shape/refinement/refinement.h"

namespace astrolith {

// The parameters are the centre and the log radius of each sphere, and t for the sharpness kappa:
//   log kappa = middle + half tanh(t / half).
// This keeps kappa between limits. A lone sphere has the same surface at every kappa, so its residuals alone
// would leave kappa undetermined.
struct RefinementParameters {
  explicit RefinementParameters(const MetaballModel& model)
      : middle(0.5 * std::log(kSoftest * kSharpest)), half(0.5 * std::log(kSharpest / kSoftest)) {
    const double part = (std::log(model.sharpness) - middle) / half;
    sharpness = half * std::atanh(std::clamp(part, -0.99, 0.99));
    for (const ModelSphere& s : model.spheres) {
      spheres.push_back({s.center.x, s.center.y, s.center.z, std::log(s.radius)});
      subtractive.push_back(s.subtractive);
    }
  }
  MetaballModel model() const {
    MetaballModel m{std::exp(middle + half * std::tanh(sharpness / half)), {}};
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const SphereDerivatives& s = spheres[i];
      m.spheres.emplace_back(Vec3d{s[0], s[1], s[2]}, std::exp(s[3]), subtractive[i]);
    }
    return m;
  }
  // Adds a step: four numbers for each sphere, then one for the sharpness.
  void add(const double* step) {
    for (SphereDerivatives& s : spheres) {
      for (double& value : s) value += *step++;
    }
    sharpness += *step;
  }
  // d log kappa / dt
  double sharpness_slope() const { return 1.0 - std::pow(std::tanh(sharpness / half), 2); }

  static constexpr double kSoftest = 0.3, kSharpest = 30.0;  // limits of kappa

  double middle, half;
  std::vector<SphereDerivatives> spheres;
  std::vector<bool> subtractive;  // (#spheres) does not change
  double sharpness = 0.0;         // t
};

enum class PointCondition { on_surface, inside, outside };

// A group of points with one condition, its residuals, and their derivatives by the spheres that reach it.
struct ResidualBlock {
  PointCondition condition;
  std::vector<Vec3d> points;
  std::vector<std::int32_t> neighbours;      // spheres by which derivatives are taken, ascending
  std::vector<double> residuals;             // (#points)
  std::vector<SphereDerivatives> by_sphere;  // (#points x #neighbours)
  std::vector<double> by_sharpness;          // (#points)
};

// The residual weight * max(0, r / 20 - d(c)) of one sphere, and its derivatives.
struct CenterCondition {
  double residual = 0.0;
  SphereDerivatives derivatives{};
};

// A residual as a function of the model's distance or level.
struct ScaledResidual {
  double value;
  double derivative;  // by the distance or the level
};

// All blocks of one round. Their lists of spheres are made for the parameters at the start of the round.
class ResidualBlocks {
 public:
  // `options` and `parameters` must outlive the blocks.
  ResidualBlocks(const FitPoints& points, const RefinementOptions& options,
                 const RefinementParameters& parameters);

  // Evaluates every block and its derivatives at the present parameters, in parallel. The first call also
  // chooses every block's neighbours.
  void evaluate();

  const std::vector<ResidualBlock>& blocks() const { return blocks_; }
  // One condition for each sphere, or none if the options let centres leave the target.
  const std::vector<CenterCondition>& center_conditions() const { return center_conditions_; }
  // Half the sum of squares of all residuals.
  double cost() const;

 private:
  void add_blocks(const std::vector<Vec3d>& points, PointCondition condition);
  std::vector<Vec3d> active(const std::vector<Vec3d>& points, PointCondition condition) const;
  void choose_neighbours(ResidualBlock& block, const ClusterScratch& scratch) const;
  void evaluate_centers(const MetaballModel& model);
  void evaluate(ResidualBlock& block, const MetaballModel& model, const ModelEvaluation& evaluation,
                const ClusterScratch& scratch) const;
  ScaledResidual scaled(PointCondition condition, double value) const;

  const RefinementOptions& options_;
  const RefinementParameters& parameters_;
  bool has_neighbours_ = false;
  std::vector<ResidualBlock> blocks_;
  std::vector<PointCluster> clusters_;  // one for each block
  std::vector<ClusterGroup> groups_;    // of clusters with one condition
  std::vector<CenterCondition> center_conditions_;
};

}  // namespace astrolith
