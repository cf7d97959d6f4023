#include <algorithm>
#include <cmath>
#include <iterator>

#include "estimation/shape/model/model_evaluation_internal.h"
#include "estimation/shape/model/model_levels.h"
#include "estimation/shape/refinement/residual_blocks_internal.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// The number of points in a residual block, at most. Larger blocks make the solver's sums longer and fewer,
// but they gather more spheres that reach only some of the points.
constexpr std::size_t kPointsPerBlock = 24;

// Derivatives are taken by the spheres that hold at least this share of their kind's sum at a point of the
// block when a round starts. The residuals themselves include every sphere whose support reaches the block.
// Smooth bodies consist of many wide spheres with a small share each: with 1e-3 the steps miss a good part of
// the slope.
constexpr double kSmallestShare = 1e-4;

// A containment point is left out of a round if its condition holds by more than this, as a level.
constexpr double kIdleLevel = 0.05;

// A centre must lie this far inside the target, as a fraction of its sphere's radius.
constexpr double kCenterDepth = 0.05;

// phi and dphi/ds of the pseudo-Huber loss. The form phi^2 = 2 s^2 / (1 + t) with t = sqrt(1 + s^2 / c^2) has
// no cancellation near zero.
ScaledResidual pseudo_huber(double s, double c) {
  const double t = std::sqrt(1.0 + s * s / (c * c));
  const double shrink = std::sqrt(2.0 / (1.0 + t));
  return {s * shrink, 1.0 / (shrink * t)};
}

// The spheres of the list that hold at least kSmallestShare of their kind's sum at one of the points.
std::vector<std::int32_t> spheres_with_share(const MetaballModel& model, const ModelEvaluation& evaluation,
                                             const std::vector<Vec3d>& points,
                                             const std::vector<std::int32_t>& spheres) {
  std::vector<double> shares, largest(spheres.size());
  for (const Vec3d& p : points) {
    totals_with_shares(model, evaluation, spheres, p, shares);
    for (std::size_t j = 0; j < spheres.size(); ++j) largest[j] = std::max(largest[j], shares[j]);
  }
  std::vector<std::int32_t> kept;
  for (std::size_t j = 0; j < spheres.size(); ++j) {
    if (largest[j] >= kSmallestShare) kept.push_back(spheres[j]);
  }
  return kept;
}

CenterCondition center_condition(const SurfaceTree& target, double weight, const ModelSphere& sphere) {
  if (sphere.subtractive) return {};
  const ClosestPoint closest = target.closest(sphere.center);
  const double sign = dot(sphere.center - closest.point, closest.normal) > 0.0 ? -1.0 : 1.0;
  const double depth = kCenterDepth * sphere.radius;
  const double lack = depth - sign * closest.distance;
  if (!(lack > 0.0)) return {};
  // The gradient of the signed distance points inwards: away from the nearest surface point if the centre is
  // inside, and towards it if the centre is outside.
  const Vec3d inward =
      closest.distance > 0.0 ? (sphere.center - closest.point) * (sign / closest.distance) : -closest.normal;
  return {weight * lack, {-weight * inward.x, -weight * inward.y, -weight * inward.z, weight * depth}};
}

}  // namespace

ResidualBlocks::ResidualBlocks(const FitPoints& points, const RefinementOptions& options,
                               const RefinementParameters& parameters)
    : options_(options), parameters_(parameters) {
  add_blocks(points.on_surface, PointCondition::on_surface);
  if (options.containment_weight > 0.0) {
    add_blocks(active(points.inside, PointCondition::inside), PointCondition::inside);
    add_blocks(active(points.outside, PointCondition::outside), PointCondition::outside);
  }
  find_neighbours();
}

void ResidualBlocks::evaluate(bool with_derivatives) {
  const MetaballModel model = parameters_.model();
  const ModelEvaluation evaluation = evaluation_parameters(model);
  parallel_for(0, static_cast<std::int64_t>(blocks_.size()), [&](std::int64_t b) {
    evaluate_block(static_cast<std::size_t>(b), model, evaluation, with_derivatives);
  });
  if (options_.keep_centers_inside != nullptr) evaluate_centers(model);
}

double ResidualBlocks::cost() const {
  double sum = 0.0;
  for (const ResidualBlock& block : blocks_) {
    for (const double r : block.residuals) sum += r * r;
  }
  for (const CenterCondition& condition : center_conditions_) sum += condition.residual * condition.residual;
  return 0.5 * sum;
}

void ResidualBlocks::evaluate_centers(const MetaballModel& model) {
  center_conditions_.resize(model.spheres.size());
  parallel_for(0, static_cast<std::int64_t>(model.spheres.size()), [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    center_conditions_[k] =
        center_condition(*options_.keep_centers_inside, options_.center_weight, model.spheres[k]);
  });
}

void ResidualBlocks::add_blocks(const std::vector<Vec3d>& points, PointCondition condition) {
  for (const PointCluster& cluster : cluster_points(points, kPointsPerBlock)) {
    ResidualBlock block{condition, {}, {}, {}, {}, {}};
    for (const std::int32_t i : cluster.points) block.points.push_back(points[static_cast<std::size_t>(i)]);
    blocks_.push_back(std::move(block));
    clusters_.push_back(cluster);
  }
}

// The points whose condition fails or nearly fails. All others would only add zeros to the normal equations.
std::vector<Vec3d> ResidualBlocks::active(const std::vector<Vec3d>& points, PointCondition condition) const {
  const std::vector<double> levels = model_levels(parameters_.model(), points);
  const double sign = condition == PointCondition::inside ? -1.0 : 1.0;
  std::vector<Vec3d> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (options_.containment_margin + sign * levels[i] > -kIdleLevel) kept.push_back(points[i]);
  }
  return kept;
}

void ResidualBlocks::find_neighbours() {
  const MetaballModel model = parameters_.model();
  const ModelEvaluation evaluation = evaluation_parameters(model);
  const double reach = support_radii(model);
  parallel_for(0, static_cast<std::int64_t>(blocks_.size()), [&](std::int64_t b) {
    ResidualBlock& block = blocks_[static_cast<std::size_t>(b)];
    block.neighbours =
        spheres_with_share(model, evaluation, block.points,
                           spheres_within(model, clusters_[static_cast<std::size_t>(b)], reach));
    block.residuals.resize(block.points.size());
    block.by_sharpness.resize(block.points.size());
    block.by_sphere.resize(block.points.size() * block.neighbours.size());
  });
}

// The neighbours of the block, then the other spheres whose support reaches the block now.
std::vector<std::int32_t> ResidualBlocks::contributors(std::size_t b, const MetaballModel& model,
                                                       double cutoff) const {
  std::vector<std::int32_t> all = blocks_[b].neighbours;
  const std::vector<std::int32_t> within = spheres_within(model, clusters_[b], cutoff);
  std::set_difference(within.begin(), within.end(), blocks_[b].neighbours.begin(),
                      blocks_[b].neighbours.end(), std::back_inserter(all));
  return all;
}

void ResidualBlocks::evaluate_block(std::size_t b, const MetaballModel& model,
                                    const ModelEvaluation& evaluation, bool with_derivatives) {
  ResidualBlock& block = blocks_[b];
  const std::vector<std::int32_t> spheres = contributors(b, model, std::sqrt(evaluation.cutoff_squared));
  std::vector<SphereDerivatives> row(with_derivatives ? spheres.size() : 0);
  const std::size_t n = block.neighbours.size();
  for (std::size_t j = 0; j < block.points.size(); ++j) {
    const ScaledResidual scaled = block.condition == PointCondition::on_surface
                                      ? surface_condition(block, j, model, evaluation, spheres, row)
                                      : containment_condition(block, j, model, evaluation, spheres, row);
    block.residuals[j] = scaled.value;
    if (!with_derivatives) continue;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < 4; ++k) block.by_sphere[j * n + i][k] = row[i][k] * scaled.derivative;
    }
    block.by_sharpness[j] *= scaled.derivative * parameters_.sharpness_slope();
  }
}

ScaledResidual ResidualBlocks::surface_condition(ResidualBlock& block, std::size_t j,
                                                 const MetaballModel& model,
                                                 const ModelEvaluation& evaluation,
                                                 std::span<const std::int32_t> spheres,
                                                 std::span<SphereDerivatives> row) const {
  const double s =
      distance_with_derivatives(model, evaluation, spheres, block.points[j], row, &block.by_sharpness[j]);
  return pseudo_huber(s, options_.loss_scale);
}

ScaledResidual ResidualBlocks::containment_condition(ResidualBlock& block, std::size_t j,
                                                     const MetaballModel& model,
                                                     const ModelEvaluation& evaluation,
                                                     std::span<const std::int32_t> spheres,
                                                     std::span<SphereDerivatives> row) const {
  const double level =
      level_with_derivatives(model, evaluation, spheres, block.points[j], row, &block.by_sharpness[j]);
  const double sign = block.condition == PointCondition::inside ? -1.0 : 1.0;
  const double lack = options_.containment_margin + sign * level;
  if (!(lack > 0.0)) return {0.0, 0.0};
  return {options_.containment_weight * lack, options_.containment_weight * sign};
}

}  // namespace astrolith
