#include "estimation/shape/refinement.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "estimation/shape/field_derivatives.h"
#include "estimation/shape/model_evaluation_internal.h"
#include "estimation/shape/point_clusters.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// Points a residual block: larger blocks make the solver's sums longer and fewer, but gather more spheres
// that reach only some of the points.
constexpr std::size_t kPointsPerBlock = 24;

// Derivatives are taken by the spheres that may reach a block after they moved or grew by this part of their
// support; the residuals themselves see every sphere in reach.
constexpr double kSupportSlack = 1.15;

// |grad L| counts as at least this over the largest radius: a lone sphere has twice that on its surface.
constexpr double kSmallestSlope = 1.0;

// Containment points are left out of a round when their condition holds by more than this level.
constexpr double kIdleLevel = 0.05;

// A round without any step that lowers the cost ends the refinement only below this radius of the trust
// region.
constexpr double kSmallestTrustRegion = 1e-6;

// Centres are asked to lie this part of their radius inside the target.
constexpr double kCenterDepth = 0.05;

enum class Condition { on_surface, inside, outside };

// One group of near points: its residuals and their derivatives by the spheres that reach it.
struct Block {
  Condition condition;
  std::vector<Vec3d> points;
  std::vector<std::int32_t> neighbours;      // spheres with derivatives, ascending
  std::vector<double> residuals;             // (#points)
  std::vector<SphereDerivatives> by_sphere;  // (#points x #neighbours)
  std::vector<double> by_sharpness;          // (#points)
  std::vector<double> slopes;                // (#points) |grad L| at the round's start, on the surface
};

// The model as Ceres's parameter blocks: centre and log radius a sphere, and t for the sharpness, which
//   log kappa = middle + half tanh(t / half)
// keeps between limits: a lone sphere has the same surface at every kappa, and nothing else would hold it.
struct Parameters {
  explicit Parameters(const MetaballModel& model) {
    const double part = (std::log(model.sharpness) - kMiddle) / kHalf;
    sharpness = kHalf * std::atanh(std::clamp(part, -0.99, 0.99));
    for (const Sphere& s : model.spheres) {
      spheres.push_back({s.center.x, s.center.y, s.center.z, std::log(s.radius)});
    }
  }
  MetaballModel model() const {
    MetaballModel m{std::exp(kMiddle + kHalf * std::tanh(sharpness / kHalf)), {}};
    for (const auto& s : spheres) m.spheres.push_back({{s[0], s[1], s[2]}, std::exp(s[3])});
    return m;
  }
  // d log kappa / dt
  double sharpness_slope() const { return 1.0 - std::pow(std::tanh(sharpness / kHalf), 2); }

  static constexpr double kMiddle = 1.0986122886681098;  // log 3
  static constexpr double kHalf = 2.3025850929940457;    // log 10: kappa between 0.3 and 30

  std::vector<SphereDerivatives> spheres;
  double sharpness = 0.0;  // t
};

struct Scaled {
  double value;
  double derivative;
};

// phi and dphi/ds of the pseudo-Huber loss. phi^2 = 2 s^2 / (1 + t), t = sqrt(1 + s^2 / c^2), which has no
// cancellation near zero.
Scaled pseudo_huber(double s, double c) {
  const double t = std::sqrt(1.0 + s * s / (c * c));
  const double shrink = std::sqrt(2.0 / (1.0 + t));
  return {s * shrink, 1.0 / (shrink * t)};
}

// Evaluates every block when Ceres asks for the first one, in parallel; the blocks only copy.
class Evaluation : public ceres::EvaluationCallback {
 public:
  Evaluation(const FitPoints& points, const RefinementOptions& options, Parameters& parameters)
      : options_(options), parameters_(parameters) {
    add_blocks(points.on_surface, Condition::on_surface);
    if (options.containment_weight > 0.0) {
      add_blocks(active(points.inside, Condition::inside), Condition::inside);
      add_blocks(active(points.outside, Condition::outside), Condition::outside);
    }
    find_neighbours();
    if (options.freeze_slopes) find_slopes();
  }

  void PrepareForEvaluation(bool with_derivatives, bool new_point) override {
    if (!new_point && (!with_derivatives || derivatives_are_current_)) return;
    derivatives_are_current_ = with_derivatives;
    const MetaballModel model = parameters_.model();
    const MetaballParameters<double> evaluation = evaluation_parameters(model);
    parallel_for(0, static_cast<std::int64_t>(blocks_.size()), [&](std::int64_t b) {
      evaluate(static_cast<std::size_t>(b), model, evaluation, with_derivatives);
    });
  }

  const std::vector<Block>& blocks() const { return blocks_; }

 private:
  void add_blocks(const std::vector<Vec3d>& points, Condition condition) {
    for (const PointCluster& cluster : cluster_points(points, kPointsPerBlock)) {
      Block block{condition, {}, {}, {}, {}, {}, {}};
      for (const std::int32_t i : cluster.points) block.points.push_back(points[static_cast<std::size_t>(i)]);
      blocks_.push_back(std::move(block));
      reach_.push_back(cluster);
    }
  }

  // Points whose condition nearly fails, or fails: the others would only fill the normal equations with
  // zeros.
  std::vector<Vec3d> active(const std::vector<Vec3d>& points, Condition condition) const {
    const std::vector<double> levels = model_levels(parameters_.model(), points);
    const double sign = condition == Condition::inside ? -1.0 : 1.0;
    std::vector<Vec3d> kept;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (options_.containment_margin + sign * levels[i] > -kIdleLevel) kept.push_back(points[i]);
    }
    return kept;
  }

  void find_neighbours() {
    const MetaballModel model = parameters_.model();
    const double reach = kSupportSlack * cutoff_radii(model.sharpness);
    parallel_for(0, static_cast<std::int64_t>(blocks_.size()), [&](std::int64_t b) {
      Block& block = blocks_[static_cast<std::size_t>(b)];
      block.neighbours = spheres_within(model, reach_[static_cast<std::size_t>(b)], reach);
      block.residuals.resize(block.points.size());
      block.by_sharpness.resize(block.points.size());
      block.by_sphere.resize(block.points.size() * block.neighbours.size());
    });
  }

  // Neighbours of the block first, then the other spheres whose support reaches it now.
  std::vector<std::int32_t> contributors(std::size_t b, const MetaballModel& model, double cutoff) const {
    std::vector<std::int32_t> all = blocks_[b].neighbours;
    const std::vector<std::int32_t> within = spheres_within(model, reach_[b], cutoff);
    std::set_difference(within.begin(), within.end(), blocks_[b].neighbours.begin(),
                        blocks_[b].neighbours.end(), std::back_inserter(all));
    return all;
  }

  void evaluate(std::size_t b, const MetaballModel& model, const MetaballParameters<double>& evaluation,
                bool with_derivatives) {
    Block& block = blocks_[b];
    const std::vector<std::int32_t> spheres = contributors(b, model, std::sqrt(evaluation.cutoff_squared));
    std::vector<SphereDerivatives> row(with_derivatives ? spheres.size() : 0);
    const std::size_t n = block.neighbours.size();
    for (std::size_t j = 0; j < block.points.size(); ++j) {
      const Scaled scaled = block.condition == Condition::on_surface
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

  Scaled surface_condition(Block& block, std::size_t j, const MetaballModel& model,
                           const MetaballParameters<double>& evaluation,
                           std::span<const std::int32_t> spheres, std::span<SphereDerivatives> row) const {
    if (!options_.freeze_slopes) {
      const double s =
          distance_with_derivatives(model, evaluation, spheres, block.points[j], row, &block.by_sharpness[j]);
      return pseudo_huber(s, options_.loss_scale);
    }
    const double level =
        level_with_derivatives(model, evaluation, spheres, block.points[j], row, &block.by_sharpness[j]);
    const Scaled scaled = pseudo_huber(level / block.slopes[j], options_.loss_scale);
    return {scaled.value, scaled.derivative / block.slopes[j]};
  }

  // Frozen for a round: s = L / |grad L| is far from linear where the slope nearly vanishes, in necks and
  // between lobes, and a few such samples would shrink the steps of all. On the surface both are the same.
  void find_slopes() {
    const MetaballModel model = parameters_.model();
    const MetaballParameters<double> evaluation = evaluation_parameters(model);
    const double smallest = kSmallestSlope / largest_radius(model.spheres);
    parallel_for(0, static_cast<std::int64_t>(blocks_.size()), [&](std::int64_t b) {
      Block& block = blocks_[static_cast<std::size_t>(b)];
      if (block.condition != Condition::on_surface) return;
      for (const Vec3d& p : block.points) {
        MetaballSums<double> sums;
        for (const std::int32_t i : block.neighbours) {
          const Sphere& s = model.spheres[static_cast<std::size_t>(i)];
          accumulate_metaball(evaluation, MetaballSphere<double>{s.center, 1.0 / (s.radius * s.radius)}, p,
                              sums);
        }
        block.slopes.push_back(std::max(norm(metaball_distance(evaluation, sums).log_gradient), smallest));
      }
    });
  }

  Scaled containment_condition(Block& block, std::size_t j, const MetaballModel& model,
                               const MetaballParameters<double>& evaluation,
                               std::span<const std::int32_t> spheres,
                               std::span<SphereDerivatives> row) const {
    const double level =
        level_with_derivatives(model, evaluation, spheres, block.points[j], row, &block.by_sharpness[j]);
    const double sign = block.condition == Condition::inside ? -1.0 : 1.0;
    const double lack = options_.containment_margin + sign * level;
    if (!(lack > 0.0)) return {0.0, 0.0};
    return {options_.containment_weight * lack, options_.containment_weight * sign};
  }

  const RefinementOptions& options_;
  Parameters& parameters_;
  std::vector<Block> blocks_;
  std::vector<PointCluster> reach_;
  bool derivatives_are_current_ = false;
};

// Hands one evaluated block to Ceres. Parameter blocks: the neighbours (4 each), then the sharpness (1).
class BlockCost : public ceres::CostFunction {
 public:
  explicit BlockCost(const Block& block) : block_(block) {
    set_num_residuals(static_cast<int>(block.points.size()));
    mutable_parameter_block_sizes()->assign(block.neighbours.size(), 4);
    mutable_parameter_block_sizes()->push_back(1);
  }

  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    std::copy(block_.residuals.begin(), block_.residuals.end(), residuals);
    for (const double r : block_.residuals) {
      if (!std::isfinite(r)) return false;
    }
    if (jacobians == nullptr) return true;
    const std::size_t n = block_.neighbours.size();
    for (std::size_t i = 0; i < n; ++i) {
      if (jacobians[i] == nullptr) continue;
      for (std::size_t j = 0; j < block_.points.size(); ++j) {
        const SphereDerivatives& d = block_.by_sphere[j * n + i];
        std::copy(d.begin(), d.end(), jacobians[i] + 4 * j);
      }
    }
    if (jacobians[n] != nullptr) {
      std::copy(block_.by_sharpness.begin(), block_.by_sharpness.end(), jacobians[n]);
    }
    return true;
  }

 private:
  const Block& block_;
};

// weight * max(0, r / 20 - d(c)) for one sphere's parameter block (centre, log radius).
class CenterInside : public ceres::SizedCostFunction<1, 4> {
 public:
  CenterInside(const SurfaceTree& target, double weight) : target_(target), weight_(weight) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const double* p = parameters[0];
    const Vec3d center{p[0], p[1], p[2]};
    if (!std::isfinite(squared_norm(center))) return false;
    const ClosestPoint closest = target_.closest(center);
    const double sign = dot(center - closest.point, closest.normal) > 0.0 ? -1.0 : 1.0;
    const double depth = kCenterDepth * std::exp(p[3]);
    const double lack = depth - sign * closest.distance;
    residuals[0] = weight_ * std::max(0.0, lack);
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    // The signed distance's gradient points inwards, from the nearest point or towards it.
    const Vec3d inward =
        closest.distance > 0.0 ? (center - closest.point) * (sign / closest.distance) : -closest.normal;
    const double active = lack > 0.0 ? weight_ : 0.0;
    jacobians[0][0] = -active * inward.x;
    jacobians[0][1] = -active * inward.y;
    jacobians[0][2] = -active * inward.z;
    jacobians[0][3] = active * depth;
    return true;
  }

 private:
  const SurfaceTree& target_;
  double weight_;
};

class ProgressCallback : public ceres::IterationCallback {
 public:
  explicit ProgressCallback(const std::function<bool(int, double)>& go_on) : go_on_(go_on) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    return go_on_(summary.iteration, summary.cost) ? ceres::SOLVER_CONTINUE
                                                   : ceres::SOLVER_TERMINATE_SUCCESSFULLY;
  }

 private:
  const std::function<bool(int, double)>& go_on_;
};

ceres::Solver::Options solver_options(int iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = iterations;
  // One thread: with more, Ceres sums in an order that depends on their speed. The evaluation has its own.
  options.num_threads = 1;
  options.function_tolerance = 1e-5;
  options.logging_type = ceres::SILENT;
  return options;
}

// One round with fixed lists of neighbours; moves `parameters`.
ceres::Solver::Summary solve_round(Parameters& parameters, const FitPoints& points,
                                   const RefinementOptions& options, int iterations, double trust_region,
                                   const std::function<bool(int, double)>& go_on) {
  Evaluation evaluation(points, options, parameters);
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &evaluation;
  ceres::Problem problem(problem_options);
  for (const Block& block : evaluation.blocks()) {
    std::vector<double*> blocks;
    for (const std::int32_t i : block.neighbours) {
      blocks.push_back(parameters.spheres[static_cast<std::size_t>(i)].data());
    }
    blocks.push_back(&parameters.sharpness);
    problem.AddResidualBlock(new BlockCost(block), nullptr, blocks);
  }
  if (options.keep_centers_inside != nullptr) {
    for (SphereDerivatives& sphere : parameters.spheres) {
      problem.AddResidualBlock(new CenterInside(*options.keep_centers_inside, options.center_weight), nullptr,
                               sphere.data());
    }
  }
  ProgressCallback callback(go_on);
  ceres::Solver::Options ceres_options = solver_options(iterations);
  ceres_options.initial_trust_region_radius = trust_region;
  ceres_options.callbacks.push_back(&callback);
  ceres::Solver::Summary summary;
  ceres::Solve(ceres_options, &problem, &summary);
  return summary;
}

}  // namespace

RefinementSummary refine(const MetaballModel& start, const FitPoints& points,
                         const RefinementOptions& options, const Progress& progress) {
  RefinementSummary result{start, 0, 0.0, 0.0, false};
  Parameters parameters(start);
  // Damped at first: far from the surface the residuals are far from linear.
  double trust_region = 1.0;
  for (bool first = true; result.iterations < options.max_iterations && !result.interrupted; first = false) {
    const std::function<bool(int, double)> go_on = [&](int iteration, double cost) {
      const double done = static_cast<double>(result.iterations + iteration) / options.max_iterations;
      result.interrupted = !report(progress, std::min(done, 1.0), "cost " + std::to_string(cost));
      return !result.interrupted;
    };
    const int iterations = std::min(options.iterations_per_round, options.max_iterations - result.iterations);
    const ceres::Solver::Summary summary =
        solve_round(parameters, points, options, iterations, trust_region, go_on);
    if (summary.termination_type == ceres::FAILURE) {
      if (first) throw WorkError("refinement: " + summary.message);
      break;  // the parameters are still those of the last good round
    }
    if (first) result.initial_cost = summary.initial_cost;
    result.final_cost = summary.final_cost;
    result.iterations += std::max<int>(1, static_cast<int>(summary.iterations.size()) - 1);
    trust_region = std::min(summary.iterations.back().trust_region_radius, 1e8);
    const bool stuck = summary.num_successful_steps <= 1;  // counts the start as one
    if (stuck
            ? trust_region < kSmallestTrustRegion
            : summary.initial_cost - summary.final_cost <= options.relative_decrease * summary.initial_cost) {
      break;
    }
  }
  result.model = parameters.model();
  return result;
}

}  // namespace astrolith
