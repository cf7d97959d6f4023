#include <nlopt.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <string>
#include <thread>

#include "estimation/optimize/searches_internal.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

struct DestroyNlopt {
  void operator()(nlopt_opt optimizer) const { nlopt_destroy(optimizer); }
};
using Handle = std::unique_ptr<nlopt_opt_s, DestroyNlopt>;

// sbplx and crs2 stop once all variables change by less than this share of the box.
constexpr double kTolerance = 1e-9;

nlopt_algorithm nlopt_name(OptimizerAlgorithm algorithm) {
  switch (algorithm) {
    case OptimizerAlgorithm::isres:
      return NLOPT_GN_ISRES;
    case OptimizerAlgorithm::esch:
      return NLOPT_GN_ESCH;
    case OptimizerAlgorithm::sbplx:
      return NLOPT_LN_SBPLX;
    default:
      return NLOPT_GN_CRS2_LM;
  }
}

void require(nlopt_result status, const char* what) {
  if (status < 0) throw WorkError(std::string("NLopt refuses its ") + what);
}

// One run, on one thread.
class NloptRun {
 public:
  NloptRun(const BatchObjective& objective, const Bounds& bounds, const OptimizeOptions& options,
           const Progress& progress)
      : objective_(objective), bounds_(bounds), options_(options), best_(options, progress) {}

  OptimizeResult run() {
    // The generator's state belongs to the thread, which no other run uses. Its seed has 32 bits.
    nlopt_srand(mix_bits(static_cast<std::uint32_t>(options_.seed) ^
                         mix_bits(static_cast<std::uint32_t>(options_.seed >> 32))));
    set_up();
    std::vector<double> x = options_.start;
    for (std::size_t d = x.size(); d < bounds_.lower.size(); ++d) {
      x.push_back(0.5 * (bounds_.lower[d] + bounds_.upper[d]));
    }
    double value = 0;
    const nlopt_result status = nlopt_optimize(handle_.get(), x.data(), &value);
    if (failure_) std::rethrow_exception(failure_);
    if (!ended_) finish(status);
    return best_.result();
  }

 private:
  void set_up() {
    const auto dimensions = static_cast<unsigned>(bounds_.lower.size());
    handle_.reset(nlopt_create(nlopt_name(options_.algorithm), dimensions));
    if (!handle_) throw WorkError("NLopt does not start; is there enough memory?");
    nlopt_opt optimizer = handle_.get();
    require(nlopt_set_lower_bounds(optimizer, bounds_.lower.data()), "lower bounds");
    require(nlopt_set_upper_bounds(optimizer, bounds_.upper.data()), "upper bounds");
    std::vector<double> tolerance;
    for (std::size_t d = 0; d < dimensions; ++d) {
      tolerance.push_back(kTolerance * (bounds_.upper[d] - bounds_.lower[d]));
    }
    require(nlopt_set_xtol_abs(optimizer, tolerance.data()), "tolerance");
    unsigned population = static_cast<unsigned>(options_.population);
    if (population > 0 && options_.algorithm == OptimizerAlgorithm::crs2) {
      population = std::max(population, dimensions + 1);
    }
    require(nlopt_set_population(optimizer, population), "population");
    require(nlopt_set_min_objective(optimizer, &NloptRun::evaluate, this), "objective");
  }

  // NLopt calls this through C, so no exception may leave it.
  static double evaluate(unsigned dimensions, const double* x, double*, void* data) {
    auto& run = *static_cast<NloptRun*>(data);
    try {
      return run.evaluate_one({x, dimensions});
    } catch (...) {
      run.failure_ = std::current_exception();
      nlopt_force_stop(run.handle_.get());
      return std::numeric_limits<double>::infinity();
    }
  }

  double evaluate_one(std::span<const double> x) {
    // Some algorithms make a few more calls after nlopt_force_stop.
    if (ended_) return std::numeric_limits<double>::infinity();
    const std::vector<double> point(x.begin(), x.end());
    const double value = finite_or_infinity(objective_(std::span(&point, 1)).front());
    best_.record(x, value);
    const std::int64_t generation = options_.population > 0 ? options_.population : 20;
    const bool whole = best_.result().evaluations % generation == 0 ||
                       best_.result().evaluations >= options_.max_evaluations;
    if (whole && !best_.generation_done()) {
      ended_ = true;
      nlopt_force_stop(handle_.get());
    }
    return value;
  }

  // Sets the termination after the algorithm ended by itself.
  void finish(nlopt_result status) {
    const bool converged = status == NLOPT_SUCCESS || status == NLOPT_FTOL_REACHED ||
                           status == NLOPT_XTOL_REACHED || status == NLOPT_ROUNDOFF_LIMITED;
    if (!converged) {
      throw WorkError(std::string("NLopt failed: ") + nlopt_result_to_string(status));
    }
    best_.generation_done();
  }

  const BatchObjective& objective_;
  const Bounds& bounds_;
  const OptimizeOptions& options_;
  BestSoFar best_;
  Handle handle_;
  std::exception_ptr failure_;
  bool ended_ = false;
};

}  // namespace

OptimizeResult nlopt_search(const BatchObjective& objective, const Bounds& bounds,
                            const OptimizeOptions& options, const Progress& progress) {
  // NLopt keeps its random state per thread, so each run gets a thread of its own. Runs side by side, or an
  // objective that itself minimises, then cannot change each other's random numbers.
  OptimizeResult result;
  std::exception_ptr failure;
  std::thread([&] {
    try {
      result = NloptRun(objective, bounds, options, progress).run();
    } catch (...) {
      failure = std::current_exception();
    }
  }).join();
  if (failure) std::rethrow_exception(failure);
  return result;
}

}  // namespace astrolith
