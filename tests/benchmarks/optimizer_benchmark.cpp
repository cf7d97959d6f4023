// Compares the optimisers at equal evaluations on eight shifted test functions, in 4 and in 34 dimensions
// (like the global parameters of a body, and its details). Prints the mean over functions and seeds of
// log10(gap / gap of the box's centre), and the evaluations that cmaes needs for the median value of pso.
//
//   optimizer_benchmark [EVALUATIONS = 2000] [SEEDS = 15]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "estimation/optimize/optimizer.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

using Function = double (*)(std::span<const double> u);  // least value 0 at u = 0

double sphere(std::span<const double> u) {
  double sum = 0;
  for (const double v : u) sum += v * v;
  return sum;
}
double ellipsoid(std::span<const double> u) {
  double sum = 0;
  for (std::size_t d = 0; d < u.size(); ++d) {
    sum += std::pow(1e4, double(d) / double(u.size() - 1)) * u[d] * u[d];
  }
  return sum;
}
double rosenbrock(std::span<const double> u) {
  double sum = 0;
  for (std::size_t d = 0; d + 1 < u.size(); ++d) {
    const double a = u[d] + 1, b = u[d + 1] + 1;
    sum += 100 * (b - a * a) * (b - a * a) + (1 - a) * (1 - a);
  }
  return sum;
}
double rastrigin(std::span<const double> u) {
  double sum = 0;
  for (const double v : u) sum += v * v + 10 * (1 - std::cos(2 * std::numbers::pi * v));
  return sum;
}
double ackley(std::span<const double> u) {
  const double n = double(u.size());
  double cosines = 0;
  for (const double v : u) cosines += std::cos(2 * std::numbers::pi * v);
  return 20 - 20 * std::exp(-0.2 * std::sqrt(sphere(u) / n)) + std::numbers::e - std::exp(cosines / n);
}
double griewank(std::span<const double> u) {
  double product = 1;
  for (std::size_t d = 0; d < u.size(); ++d) product *= std::cos(20 * u[d] / std::sqrt(double(d + 1)));
  return 0.1 * sphere(u) + 1 - product;
}
double schwefel_ridge(std::span<const double> u) {
  double sum = 0, partial = 0;
  for (const double v : u) {
    partial += v;
    sum += partial * partial;
  }
  return sum;
}
double sharp(std::span<const double> u) {
  double sum = 0;
  for (const double v : u) sum += std::sqrt(std::abs(v));
  return sum;
}

struct Problem {
  Function function;
  std::vector<double> optimum;
};

// The optimum lies anywhere in the middle four fifths of the box [-5, 5]^n.
Problem shifted(Function function, std::size_t n, std::uint64_t seed) {
  CounterRandom random(seed, 77);
  Problem problem{function, {}};
  for (std::size_t d = 0; d < n; ++d) problem.optimum.push_back(random.uniform(-4.0, 4.0));
  return problem;
}

double value_of(const Problem& problem, std::span<const double> x) {
  std::vector<double> u(x.begin(), x.end());
  for (std::size_t d = 0; d < u.size(); ++d) u[d] -= problem.optimum[d];
  return problem.function(u);
}

OptimizeResult solve(const Problem& problem, OptimizerAlgorithm algorithm, std::int64_t evaluations,
                     std::uint64_t seed, double target) {
  OptimizeOptions options;
  options.algorithm = algorithm;
  options.max_evaluations = evaluations;
  options.seed = seed;
  options.target = target;
  const std::size_t n = problem.optimum.size();
  return minimize([&](std::span<const double> x) { return value_of(problem, x); },
                  {std::vector<double>(n, -5.0), std::vector<double>(n, 5.0)}, options);
}

constexpr Function kFunctions[] = {sphere, ellipsoid,      rosenbrock, rastrigin,
                                   ackley, schwefel_ridge, griewank,   sharp};

double mean_log_gap(OptimizerAlgorithm algorithm, std::size_t n, std::int64_t evaluations, int seeds) {
  double sum = 0;
  for (const Function function : kFunctions) {
    for (int seed = 1; seed <= seeds; ++seed) {
      const Problem problem = shifted(function, n, std::uint64_t(seed));
      const double start = value_of(problem, std::vector<double>(n, 0.0));
      const double end = solve(problem, algorithm, evaluations, std::uint64_t(seed), 0.0).value;
      sum += std::log10(std::max(end / start, 1e-12));
    }
  }
  return sum / double(std::size(kFunctions) * std::size_t(seeds));
}

// The median over functions and seeds of the evaluations that cmaes needs to reach the value of pso.
std::int64_t evaluations_to_match(std::size_t n, std::int64_t evaluations, int seeds) {
  std::vector<std::int64_t> needed;
  for (const Function function : kFunctions) {
    for (int seed = 1; seed <= seeds; ++seed) {
      const Problem problem = shifted(function, n, std::uint64_t(seed));
      const auto s = std::uint64_t(seed);
      const double reached = solve(problem, OptimizerAlgorithm::pso, evaluations, s, 0.0).value;
      needed.push_back(solve(problem, OptimizerAlgorithm::cmaes, 5 * evaluations, s, reached).evaluations);
    }
  }
  std::nth_element(needed.begin(), needed.begin() + std::ptrdiff_t(needed.size() / 2), needed.end());
  return needed[needed.size() / 2];
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  using namespace astrolith;
  const std::int64_t evaluations = argc > 1 ? std::atoll(argv[1]) : 2000;
  const int seeds = argc > 2 ? std::atoi(argv[2]) : 15;
  fmt::print("mean log10 gap, {} evaluations, {} seeds\n{:8}{:>8}{:>8}\n", evaluations, seeds, "", "D = 4",
             "D = 34");
  for (const char* name : {"pso", "crs2", "isres", "esch", "sbplx", "cmaes"}) {
    const OptimizerAlgorithm algorithm = optimizer_from_name(name);
    fmt::print("{:8}{:8.2f}{:8.2f}\n", name, mean_log_gap(algorithm, 4, evaluations, seeds),
               mean_log_gap(algorithm, 34, evaluations, seeds));
  }
  fmt::print("evaluations in which cmaes reaches pso's value, median: {} (D = 4), {} (D = 34)\n",
             evaluations_to_match(4, evaluations, seeds), evaluations_to_match(34, evaluations, seeds));
}
