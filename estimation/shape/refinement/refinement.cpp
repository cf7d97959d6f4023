#include "estimation/shape/refinement/refinement.h"

#include <algorithm>
#include <cmath>

#include "estimation/shape/refinement/normal_equations_internal.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

// A round without a step that lowers the cost ends the refinement only above this damping.
constexpr double kLargestDamping = 1e6;
constexpr double kSmallestDamping = 1e-8;

// One step moves a centre by at most this fraction of its sphere's radius, and changes a log radius by at
// most this much.
constexpr double kLongestStep = 0.3;

// A step is taken only if it lowers the cost by more than this fraction of what the linear model predicts.
constexpr double kWorthwhile = 1e-3;

// Levenberg-Marquardt with Nielsen's rule for the damping (H. B. Nielsen, "Damping parameter in Marquardt's
// method", 1999). The lists of neighbours are fixed during a round of some iterations.
class Refinement {
 public:
  Refinement(const MetaballModel& start, const FitPoints& points, const RefinementOptions& options,
             const Progress& progress)
      : points_(points), options_(options), progress_(progress), parameters_(start) {}

  RefinementSummary run() {
    for (bool first = true; result_.iterations < options_.max_iterations && !result_.interrupted;
         first = false) {
      ResidualBlocks residuals(points_, options_, parameters_);
      const bool moved = round(residuals, first);
      if (!moved ? damping_ > kLargestDamping
                 : round_start_ - result_.final_cost <= options_.relative_decrease * round_start_) {
        break;
      }
    }
    result_.model = parameters_.model();
    return std::move(result_);
  }

 private:
  // Takes the steps of one round. Returns true if one of them lowered the cost.
  bool round(ResidualBlocks& residuals, bool first) {
    residuals.evaluate();
    round_start_ = result_.final_cost = residuals.cost();
    if (!std::isfinite(round_start_)) throw WorkError("refinement: the distances are not finite");
    if (first) result_.initial_cost = round_start_;
    NormalEquations equations(residuals, parameters_.spheres.size());
    const int last = std::min(result_.iterations + options_.iterations_per_round, options_.max_iterations);
    bool moved = false, stale = true;
    while (result_.iterations < last && damping_ <= kLargestDamping && go_on()) {
      if (stale) equations.assemble();
      stale = step(residuals, equations);
      moved = moved || stale;
      ++result_.iterations;
    }
    return moved;
  }

  bool go_on() {
    const double done = static_cast<double>(result_.iterations) / options_.max_iterations;
    result_.interrupted =
        !report(progress_, std::min(done, 1.0), "cost " + std::to_string(result_.final_cost));
    return !result_.interrupted;
  }

  // Returns true if the step was taken.
  bool step(ResidualBlocks& residuals, NormalEquations& equations) {
    Eigen::VectorXd change;
    if (equations.solve(damping_, change)) {
      keep_within_reach(change);
      const RefinementParameters before = parameters_;
      parameters_.add(change.data());
      // Most steps are taken, and the next one needs the derivatives. Their sums at the present parameters
      // stay in the equations if the step is not taken.
      residuals.evaluate();
      const double cost = residuals.cost();
      const double ratio = (result_.final_cost - cost) / equations.predicted_decrease(change);
      if (cost < result_.final_cost && ratio > kWorthwhile) {
        result_.final_cost = cost;
        damping_ =
            std::max(kSmallestDamping, damping_ * std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * ratio - 1.0, 3)));
        growth_ = 2.0;
        return true;
      }
      parameters_ = before;
    }
    damping_ *= growth_;
    growth_ *= 2.0;
    return false;
  }

  // Shortens the steps of single spheres. In necks and between lobes the residuals are far from linear. There
  // a few spheres with long steps would otherwise raise the damping, and so shorten the steps of all spheres.
  void keep_within_reach(Eigen::VectorXd& change) const {
    for (std::size_t i = 0; i < parameters_.spheres.size(); ++i) {
      auto step = change.segment<4>(static_cast<Eigen::Index>(4 * i));
      const double radii = step.head<3>().norm() / std::exp(parameters_.spheres[i][3]);
      const double length = std::max(radii, std::abs(step[3]));
      if (length > kLongestStep) step *= kLongestStep / length;
    }
  }

  const FitPoints& points_;
  const RefinementOptions& options_;
  const Progress& progress_;
  RefinementParameters parameters_;
  RefinementSummary result_;
  double damping_ = 1.0;  // large at the start, where the residuals are far from linear
  double growth_ = 2.0;
  double round_start_ = 0.0;
};

}  // namespace

RefinementSummary refine(const MetaballModel& start, const FitPoints& points,
                         const RefinementOptions& options, const Progress& progress) {
  return Refinement(start, points, options, progress).run();
}

}  // namespace astrolith
