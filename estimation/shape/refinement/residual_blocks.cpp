#include <algorithm>
#include <array>
#include <cmath>

#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/refinement/residual_blocks_internal.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

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

// The places of the neighbours in a list of spheres that holds them, unless they have left it. Both lists are
// ascending. Neighbours that have left reach no point of the block.
struct PlacesInList {
  std::vector<std::int32_t> places;  // in the list of spheres
  std::vector<std::size_t> columns;  // in the list of neighbours
};
PlacesInList find_places(const std::vector<std::int32_t>& neighbours,
                         const std::vector<std::int32_t>& spheres) {
  PlacesInList found;
  std::size_t i = 0;
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    while (i < spheres.size() && spheres[i] < neighbours[k]) ++i;
    if (i == spheres.size() || spheres[i] != neighbours[k]) continue;
    found.places.push_back(static_cast<std::int32_t>(i));
    found.columns.push_back(k);
  }
  return found;
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
}

void ResidualBlocks::evaluate() {
  const MetaballModel model = parameters_.model();
  const ModelEvaluation evaluation = evaluation_parameters(model);
  for_each_cluster(model, clusters_, groups_, std::sqrt(evaluation.cutoff_squared),
                   [&](std::size_t b, ClusterScratch& scratch) {
                     ResidualBlock& block = blocks_[b];
                     scratch.kernels.evaluate(model, evaluation, scratch.spheres, block.points);
                     if (!has_neighbours_) choose_neighbours(block, scratch);
                     evaluate(block, model, evaluation, scratch);
                   });
  has_neighbours_ = true;
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
  const std::size_t before = clusters_.size();
  for (PointCluster& cluster : cluster_points(points, BlockKernels::kMostPoints)) {
    ResidualBlock block{condition, {}, {}, {}, {}, {}};
    for (const std::int32_t i : cluster.points) block.points.push_back(points[static_cast<std::size_t>(i)]);
    blocks_.push_back(std::move(block));
    clusters_.push_back(std::move(cluster));
  }
  const std::span<const PointCluster> own(clusters_.begin() + static_cast<std::ptrdiff_t>(before),
                                          clusters_.end());
  for (ClusterGroup group : group_clusters(own, kClustersPerGroup)) {
    group.begin += before;
    group.end += before;
    groups_.push_back(group);
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

void ResidualBlocks::choose_neighbours(ResidualBlock& block, const ClusterScratch& scratch) const {
  for (std::size_t i = 0; i < scratch.spheres.size(); ++i) {
    if (scratch.kernels.largest_share(i) >= kSmallestShare) block.neighbours.push_back(scratch.spheres[i]);
  }
  block.residuals.resize(block.points.size());
  block.by_sharpness.resize(block.points.size());
  block.by_sphere.resize(block.points.size() * block.neighbours.size());
}

ScaledResidual ResidualBlocks::scaled(PointCondition condition, double value) const {
  if (condition == PointCondition::on_surface) return pseudo_huber(value, options_.loss_scale);
  const double sign = condition == PointCondition::inside ? -1.0 : 1.0;
  const double lack = options_.containment_margin + sign * value;
  if (!(lack > 0.0)) return {0.0, 0.0};
  return {options_.containment_weight * lack, options_.containment_weight * sign};
}

void ResidualBlocks::evaluate(ResidualBlock& block, const MetaballModel& model,
                              const ModelEvaluation& evaluation, const ClusterScratch& scratch) const {
  std::array<BlockKernels::Slopes, BlockKernels::kMostPoints> slopes;
  const std::size_t points = block.points.size();
  for (std::size_t j = 0; j < points; ++j) {
    const MetaballTotals<double> totals = scratch.kernels.totals(j);
    const double value = block.condition == PointCondition::on_surface
                             ? distance_with_slopes(model, evaluation, totals, slopes[j])
                             : level_with_slopes(model, totals, slopes[j]);
    const ScaledResidual residual = scaled(block.condition, value);
    block.residuals[j] = residual.value;
    slopes[j].scale(residual.derivative);
  }
  const auto [places, columns] = find_places(block.neighbours, scratch.spheres);
  if (places.size() != block.neighbours.size())
    std::fill(block.by_sphere.begin(), block.by_sphere.end(), SphereDerivatives{});
  scratch.kernels.differentiate({slopes.data(), points}, {places, columns, block.neighbours.size()},
                                block.by_sphere.data(), block.by_sharpness);
  const double slope = parameters_.sharpness_slope();
  for (double& by : block.by_sharpness) by *= slope;
}

}  // namespace astrolith
