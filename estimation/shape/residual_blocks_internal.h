// The residuals of refinement.h and their derivatives, in blocks of near points that share their spheres.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimation/shape/field_derivatives.h"
#include "estimation/shape/point_clusters.h"
#include "estimation/shape/refinement.h"
#include "estimation/shape/refinement_parameters_internal.h"

namespace astrolith {

enum class PointCondition { on_surface, inside, outside };

// One group of near points: its residuals and their derivatives by the spheres that reach it.
struct ResidualBlock {
  PointCondition condition;
  std::vector<Vec3d> points;
  std::vector<std::int32_t> neighbours;      // spheres with derivatives, ascending
  std::vector<double> residuals;             // (#points)
  std::vector<SphereDerivatives> by_sphere;  // (#points x #neighbours)
  std::vector<double> by_sharpness;          // (#points)
  std::vector<double> slopes;                // (#points) |grad L| at the round's start, on the surface
};

// A residual and what its derivative by the model's value is multiplied with.
struct ScaledResidual {
  double value;
  double derivative;
};

// All blocks of one round: their lists of spheres, and frozen slopes, are made for the parameters at its
// start.
class ResidualBlocks {
 public:
  // `options` and `parameters` must outlive the blocks.
  ResidualBlocks(const FitPoints& points, const RefinementOptions& options,
                 const RefinementParameters& parameters);

  // Every block at the present parameters, in parallel.
  void evaluate(bool with_derivatives);

  const std::vector<ResidualBlock>& blocks() const { return blocks_; }

 private:
  void add_blocks(const std::vector<Vec3d>& points, PointCondition condition);
  std::vector<Vec3d> active(const std::vector<Vec3d>& points, PointCondition condition) const;
  void find_neighbours();
  void find_slopes();
  std::vector<std::int32_t> contributors(std::size_t b, const MetaballModel& model, double cutoff) const;
  void evaluate_block(std::size_t b, const MetaballModel& model, const MetaballParameters<double>& evaluation,
                      bool with_derivatives);
  ScaledResidual surface_condition(ResidualBlock& block, std::size_t j, const MetaballModel& model,
                                   const MetaballParameters<double>& evaluation,
                                   std::span<const std::int32_t> spheres,
                                   std::span<SphereDerivatives> row) const;
  ScaledResidual containment_condition(ResidualBlock& block, std::size_t j, const MetaballModel& model,
                                       const MetaballParameters<double>& evaluation,
                                       std::span<const std::int32_t> spheres,
                                       std::span<SphereDerivatives> row) const;

  const RefinementOptions& options_;
  const RefinementParameters& parameters_;
  std::vector<ResidualBlock> blocks_;
  std::vector<PointCluster> reach_;
};

}  // namespace astrolith
