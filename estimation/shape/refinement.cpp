#include "estimation/shape/refinement.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

#include "estimation/shape/residual_blocks_internal.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

// A round without any step that lowers the cost ends the refinement only below this radius of the trust
// region.
constexpr double kSmallestTrustRegion = 1e-6;

// Centres are asked to lie this part of their radius inside the target.
constexpr double kCenterDepth = 0.05;

// Evaluates every block when Ceres asks for the first one; the blocks then only copy.
class EvaluateAll : public ceres::EvaluationCallback {
 public:
  explicit EvaluateAll(ResidualBlocks& residuals) : residuals_(residuals) {}

  void PrepareForEvaluation(bool with_derivatives, bool new_point) override {
    if (!new_point && (!with_derivatives || derivatives_are_current_)) return;
    derivatives_are_current_ = with_derivatives;
    residuals_.evaluate(with_derivatives);
  }

 private:
  ResidualBlocks& residuals_;
  bool derivatives_are_current_ = false;
};

// Hands one evaluated block to Ceres. Parameter blocks: the neighbours (4 each), then the sharpness (1).
class BlockCost : public ceres::CostFunction {
 public:
  explicit BlockCost(const ResidualBlock& block) : block_(block) {
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
  const ResidualBlock& block_;
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
ceres::Solver::Summary solve_round(RefinementParameters& parameters, const FitPoints& points,
                                   const RefinementOptions& options, int iterations, double trust_region,
                                   const std::function<bool(int, double)>& go_on) {
  ResidualBlocks residuals(points, options, parameters);
  EvaluateAll evaluation(residuals);
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &evaluation;
  ceres::Problem problem(problem_options);
  for (const ResidualBlock& block : residuals.blocks()) {
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
  RefinementParameters parameters(start);
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
