#include "estimation/gabor/lobes/lobe_refinement.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <cmath>
#include <memory>

#include "estimation/gabor/lobes/lobe_misfit.h"

namespace astrolith {
namespace {

class MisfitFunction : public ceres::FirstOrderFunction {
 public:
  explicit MisfitFunction(const LobeMisfit& misfit) : misfit_(misfit) {}
  int NumParameters() const override { return misfit_.parameters(); }
  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    const auto n = static_cast<std::size_t>(misfit_.parameters());
    *cost = misfit_({parameters, n}, gradient != nullptr ? std::span(gradient, n) : std::span<double>{});
    return std::isfinite(*cost);
  }

 private:
  const LobeMisfit& misfit_;
};

constexpr const char* kRefining = "refining";

// Ends the minimisation, with its best so far, when progress asks to stop.
class StopWhenAsked : public ceres::IterationCallback {
 public:
  explicit StopWhenAsked(const Progress& progress) : progress_(progress) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return report(progress_, 1.0, kRefining) ? ceres::SOLVER_CONTINUE : ceres::SOLVER_TERMINATE_SUCCESSFULLY;
  }

 private:
  const Progress& progress_;
};

// The weighted optimal-transport distance: the root of the misfit, whose small offset e is neglected.
double distance_of(const std::vector<SpectralLobe>& lobes, const SpectrumEstimate& estimate) {
  const LobeMisfit misfit(lobes, estimate.spectrum, estimate.weights);
  const std::vector<double> start(static_cast<std::size_t>(misfit.parameters()), 0.0);
  return std::sqrt(misfit(start, {}));
}

}  // namespace

RefinedLobes refine_lobes(const std::vector<SpectralLobe>& lobes, const SpectrumEstimate& target,
                          const Progress& progress) {
  if (lobes.empty()) return {};
  const LobeMisfit misfit(lobes, target.spectrum, target.weights);
  std::vector<double> parameters(static_cast<std::size_t>(misfit.parameters()), 0.0);
  const ceres::GradientProblem problem(new MisfitFunction(misfit));
  ceres::GradientProblemSolver::Options options;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 40;
  options.function_tolerance = 1e-3;  // stop when a step lowers the misfit by a smaller share
  StopWhenAsked stop_when_asked(progress);
  options.callbacks.push_back(&stop_when_asked);
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(options, problem, parameters.data(), &summary);
  return {misfit.lobes_at(parameters), summary.termination_type == ceres::CONVERGENCE};
}

RefinedLobes fewest_lobes(const std::vector<SpectralLobe>& lobes, const SpectrumEstimate& estimate,
                          const std::vector<double>& weight, const Progress& progress) {
  if (!report(progress, 1.0, kRefining)) return {lobes, false};
  const double allowed = estimate.weighted_error / 3.0;
  RefinedLobes best = refine_lobes(lobes, estimate, progress);
  while (best.lobes.size() > 1 && report(progress, 1.0, kRefining)) {
    const auto fewer = static_cast<int>(0.75 * static_cast<double>(best.lobes.size()));
    RefinedLobes candidate = refine_lobes(
        select_lobes(best.lobes, estimate.spectrum, weight, std::max(1, fewer)), estimate, progress);
    if (candidate.lobes.empty() || distance_of(candidate.lobes, estimate) > allowed) break;
    best = std::move(candidate);
  }
  return best;
}

}  // namespace astrolith
