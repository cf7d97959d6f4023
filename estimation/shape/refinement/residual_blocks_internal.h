// The residuals of refinement.h and their derivatives, in blocks. The points of a block lie close together
// and share one list of spheres.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimation/shape/model/field_derivatives.h"
#include "estimation/shape/model/point_clusters.h"
#include "estimation/shape/refinement/refinement.h"
#include "estimation/shape/refinement/refinement_parameters_internal.h"

namespace astrolith {

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

  // Evaluates every block at the present parameters, in parallel.
  void evaluate(bool with_derivatives);

  const std::vector<ResidualBlock>& blocks() const { return blocks_; }
  // One condition for each sphere, or none if the options let centres leave the target.
  const std::vector<CenterCondition>& center_conditions() const { return center_conditions_; }
  // Half the sum of squares of all residuals.
  double cost() const;

 private:
  void add_blocks(const std::vector<Vec3d>& points, PointCondition condition);
  std::vector<Vec3d> active(const std::vector<Vec3d>& points, PointCondition condition) const;
  void find_neighbours();
  std::vector<std::int32_t> contributors(std::size_t b, const MetaballModel& model, double cutoff) const;
  void evaluate_centers(const MetaballModel& model);
  void evaluate_block(std::size_t b, const MetaballModel& model, const ModelEvaluation& evaluation,
                      bool with_derivatives);
  ScaledResidual surface_condition(ResidualBlock& block, std::size_t j, const MetaballModel& model,
                                   const ModelEvaluation& evaluation, std::span<const std::int32_t> spheres,
                                   std::span<SphereDerivatives> row) const;
  ScaledResidual containment_condition(ResidualBlock& block, std::size_t j, const MetaballModel& model,
                                       const ModelEvaluation& evaluation,
                                       std::span<const std::int32_t> spheres,
                                       std::span<SphereDerivatives> row) const;

  const RefinementOptions& options_;
  const RefinementParameters& parameters_;
  std::vector<ResidualBlock> blocks_;
  std::vector<PointCluster> clusters_;  // one for each block
  std::vector<CenterCondition> center_conditions_;
};

}  // namespace astrolith
