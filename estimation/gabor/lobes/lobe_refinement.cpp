#include "estimation/gabor/lobes/lobe_refinement.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "estimation/gabor/pursuit/gabor_dictionary.h"
#include "numerics/parallel_for.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

// One axis of a lobe at the bins where it is not negligible, and its derivative by the centre in deviations.
struct AxisProfile {
  std::vector<std::size_t> bins;
  std::vector<double> values;
  std::vector<double> slopes;
};

AxisProfile axis_profile(int n, double center, double deviation) {
  constexpr double kReach = 5.0;  // deviations; beyond, the Gaussian is below 4e-6 of its peak
  AxisProfile profile;
  const auto first = static_cast<int>(std::ceil(center - kReach * deviation));
  const auto last = static_cast<int>(std::floor(center + kReach * deviation));
  if (last - first + 1 >= n) {  // the Gaussian covers every bin, and its periodic images add up
    profile.values.assign(static_cast<std::size_t>(n), 0.0);
    profile.slopes = profile.values;
    for (int i = 0; i < n; ++i) profile.bins.push_back(static_cast<std::size_t>(i));
  }
  for (int i = first; i <= last; ++i) {
    const double t = (i - center) / deviation;
    const double g = std::exp(-0.5 * t * t);
    const auto bin = static_cast<std::size_t>(((i % n) + n) % n);
    if (last - first + 1 >= n) {
      profile.values[bin] += g;
      profile.slopes[bin] += t * g;
    } else {
      profile.bins.push_back(bin);
      profile.values.push_back(g);
      profile.slopes.push_back(t * g);
    }
  }
  return profile;
}

struct LobeOnGrid {
  AxisProfile x, y;
  double height = 0.0;
};

LobeOnGrid on_grid(const SpectralLobe& lobe, int width, int height) {
  const double deviation = lobe_deviation(lobe.bandwidth);
  return {axis_profile(width, lobe.x * width, deviation * width),
          axis_profile(height, lobe.y * height, deviation * height), lobe.height};
}

// The sum over the lobes of their Gaussians at +c. Those at -c are mirror images.
std::vector<double> sum_halves(const std::vector<LobeOnGrid>& lobes, int width, int height) {
  std::vector<std::vector<std::pair<const LobeOnGrid*, double>>> by_row(static_cast<std::size_t>(height));
  for (const LobeOnGrid& lobe : lobes) {
    for (std::size_t k = 0; k < lobe.y.bins.size(); ++k) {
      by_row[lobe.y.bins[k]].emplace_back(&lobe, lobe.height * lobe.y.values[k]);
    }
  }
  std::vector<double> grid(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0);
  parallel_for(0, height, [&](std::int64_t y) {
    double* row = grid.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    for (const auto& [lobe, factor] : by_row[static_cast<std::size_t>(y)]) {
      for (std::size_t k = 0; k < lobe->x.bins.size(); ++k)
        row[lobe->x.bins[k]] += factor * lobe->x.values[k];
    }
  });
  return grid;
}

// The sums over the grid of weight times a lobe's Gaussian at +c, and times its derivatives.
struct LobeSums {
  double value = 0.0, slope_x = 0.0, slope_y = 0.0;
};

LobeSums sums_over(const LobeOnGrid& lobe, const std::vector<double>& weight, int width) {
  LobeSums sums;
  for (std::size_t ky = 0; ky < lobe.y.bins.size(); ++ky) {
    const double* row = weight.data() + lobe.y.bins[ky] * static_cast<std::size_t>(width);
    double value = 0.0;
    double slope = 0.0;
    for (std::size_t kx = 0; kx < lobe.x.bins.size(); ++kx) {
      value += row[lobe.x.bins[kx]] * lobe.x.values[kx];
      slope += row[lobe.x.bins[kx]] * lobe.x.slopes[kx];
    }
    sums.value += value * lobe.y.values[ky];
    sums.slope_x += slope * lobe.y.values[ky];
    sums.slope_y += value * lobe.y.slopes[ky];
  }
  return sums;
}

double wrapped(double frequency) { return frequency - std::floor(frequency + 0.5); }

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
double transport_distance(const std::vector<SpectralLobe>& lobes, const SpectrumEstimate& estimate) {
  const LobeMisfit misfit(lobes, estimate.spectrum, estimate.weights);
  const std::vector<double> start(static_cast<std::size_t>(misfit.parameters()), 0.0);
  return std::sqrt(misfit(start, {}));
}

}  // namespace

LobeMisfit::LobeMisfit(std::vector<SpectralLobe> start, const PowerSpectrum& target,
                       const std::vector<double>& weights)
    : start_(std::move(start)),
      width_(target.width),
      height_(target.height),
      total_(dot_product(weights, target.power)),
      weights_(weights) {
  offset_ = 1e-6 * total_ / static_cast<double>(target.power.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    target_roots_.push_back(std::sqrt(weights[i] * target.power[i] + offset_));
  }
}

std::vector<SpectralLobe> LobeMisfit::lobes_at(std::span<const double> parameters) const {
  std::vector<SpectralLobe> lobes = start_;
  for (std::size_t j = 0; j < lobes.size(); ++j) {
    const double deviation = lobe_deviation(lobes[j].bandwidth);
    lobes[j].x = wrapped(lobes[j].x + deviation * parameters[3 * j]);
    lobes[j].y = wrapped(lobes[j].y + deviation * parameters[3 * j + 1]);
    lobes[j].height *= std::exp(parameters[3 * j + 2]);
  }
  return lobes;
}

double LobeMisfit::operator()(std::span<const double> parameters, std::span<double> gradient) const {
  std::vector<LobeOnGrid> lobes;
  for (const SpectralLobe& lobe : lobes_at(parameters)) {
    if (!std::isfinite(lobe.x + lobe.y + lobe.height)) return std::numeric_limits<double>::infinity();
    lobes.push_back(on_grid(lobe, width_, height_));
  }
  const std::vector<double> halves = sum_halves(lobes, width_, height_);
  std::vector<double> weight(halves.size(), 0.0);  // derivative of the misfit by S
  double misfit = 0.0;
  const auto w = static_cast<std::size_t>(width_);
  const auto h = static_cast<std::size_t>(height_);
  for (std::size_t i = 1; i < halves.size(); ++i) {
    const std::size_t mirror = (h - i / w) % h * w + (w - i % w) % w;
    const double root = std::sqrt(weights_[i] * (halves[i] + halves[mirror]) + offset_);
    const double difference = root - target_roots_[i];
    misfit += difference * difference;
    weight[i] = weights_[i] * difference / root;
  }
  if (!gradient.empty()) {
    parallel_for(0, static_cast<std::int64_t>(lobes.size()), [&](std::int64_t i) {
      const auto j = static_cast<std::size_t>(i);
      const LobeSums sums = sums_over(lobes[j], weight, width_);
      const double both = 2.0 * lobes[j].height / total_;  // both halves give the same
      gradient[3 * j] = both * sums.slope_x;
      gradient[3 * j + 1] = both * sums.slope_y;
      gradient[3 * j + 2] = both * sums.value;
    });
  }
  return misfit / total_;
}

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
    if (candidate.lobes.empty() || transport_distance(candidate.lobes, estimate) > allowed) break;
    best = std::move(candidate);
  }
  return best;
}

}  // namespace astrolith
