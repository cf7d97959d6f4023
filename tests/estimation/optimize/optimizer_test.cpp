#include "estimation/optimize/optimizer.h"

#include <atomic>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <thread>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

using Algorithm = OptimizerAlgorithm;
// The optimum lies off the box's centre and differs in each variable, so that no symmetry helps.
const std::vector<double> kOptimum = {0.7, -1.3, 2.1, -0.4};
const Bounds kBox = {{-5, -5, -5, -5}, {5, 5, 5, 5}};

double sphere(std::span<const double> x) {
  double sum = 0;
  for (std::size_t d = 0; d < x.size(); ++d) sum += (x[d] - kOptimum[d]) * (x[d] - kOptimum[d]);
  return sum;
}

// The Rosenbrock function, moved so that its least value, 0, lies at kOptimum.
double rosenbrock(std::span<const double> x) {
  double sum = 0;
  for (std::size_t d = 0; d + 1 < x.size(); ++d) {
    const double u = x[d] - kOptimum[d] + 1, v = x[d + 1] - kOptimum[d + 1] + 1;
    sum += 100 * (v - u * u) * (v - u * u) + (1 - u) * (1 - u);
  }
  return sum;
}

double rastrigin(std::span<const double> x) {
  double sum = 0;
  for (std::size_t d = 0; d < x.size(); ++d) {
    const double u = x[d] - kOptimum[d];
    sum += u * u + 10 * (1 - std::cos(2 * std::numbers::pi * u));
  }
  return sum;
}

OptimizeOptions make_options(Algorithm algorithm, std::int64_t evaluations) {
  OptimizeOptions options;
  options.algorithm = algorithm;
  options.max_evaluations = evaluations;
  return options;
}

class EveryOptimizer : public ::testing::TestWithParam<Algorithm> {};
INSTANTIATE_TEST_SUITE_P(All, EveryOptimizer,
                         ::testing::Values(Algorithm::pso, Algorithm::crs2, Algorithm::isres, Algorithm::esch,
                                           Algorithm::sbplx));

TEST_P(EveryOptimizer, FindsTheSphere) {
  // The two evolutionary algorithms explore much longer before they home in.
  const bool evolutionary = GetParam() == Algorithm::esch || GetParam() == Algorithm::isres;
  const double bound = evolutionary ? 0.1 : 1e-6;
  const OptimizeResult result = minimize(sphere, kBox, make_options(GetParam(), 6000));
  EXPECT_LT(result.value, bound);
  EXPECT_EQ(result.value, sphere(result.x));
}

TEST_P(EveryOptimizer, StaysInsideTheBoundsAndTheBudget) {
  const Bounds box = {{-1, 2, 0.5, -3}, {1, 4, 0.5, 3}};  // the third variable is fixed
  std::atomic<int> outside = 0, calls = 0;
  const auto objective = [&](std::span<const double> x) {
    ++calls;
    for (std::size_t d = 0; d < x.size(); ++d) outside += x[d] < box.lower[d] || x[d] > box.upper[d];
    return -sphere(x);  // pushes into the corners
  };
  const OptimizeResult result = minimize(objective, box, make_options(GetParam(), 500));
  EXPECT_EQ(outside, 0);
  EXPECT_EQ(result.evaluations, calls);
  EXPECT_LE(result.evaluations, 500);
  EXPECT_EQ(result.x[2], 0.5);
}

TEST_P(EveryOptimizer, SameSeedSameBytesForAnyThreadCount) {
  OptimizeOptions options = make_options(GetParam(), 700);
  options.seed = 12345678901ull;
  OptimizeResult one, again;
  {
    const ThreadLimit limit(1);
    one = minimize(rastrigin, kBox, options);
  }
  // Another run at the same time, on the same function, must not disturb this one.
  OptimizeOptions other = options;
  other.seed = 3;
  std::thread neighbour([&] { minimize(rastrigin, kBox, other); });
  {
    const ThreadLimit limit(4);
    again = minimize(rastrigin, kBox, options);
  }
  neighbour.join();
  EXPECT_EQ(one.x, again.x);
  EXPECT_EQ(one.history, again.history);
  EXPECT_EQ(one.evaluations, again.evaluations);
  if (GetParam() != Algorithm::sbplx) {
    EXPECT_NE(minimize(rastrigin, kBox, other).history, one.history);
  }
}

TEST_P(EveryOptimizer, HistoryFalls) {
  const OptimizeResult result = minimize(rosenbrock, kBox, make_options(GetParam(), 1000));
  ASSERT_GE(result.history.size(), 2u);
  for (std::size_t i = 1; i < result.history.size(); ++i) {
    ASSERT_LE(result.history[i], result.history[i - 1]);
  }
  EXPECT_EQ(result.history.back(), result.value);
}

TEST_P(EveryOptimizer, ValuesThatAreNotFiniteAreTheWorst) {
  const auto objective = [](std::span<const double> x) {
    if (x[0] < 0) return std::nan("");
    if (x[1] > 0) return -std::numeric_limits<double>::infinity();
    return sphere(x);
  };
  OptimizeOptions options = make_options(GetParam(), 3000);
  options.start = {1, -1, 0, 0};
  const OptimizeResult result = minimize(objective, kBox, options);
  EXPECT_TRUE(std::isfinite(result.value));
  EXPECT_LT(result.value, 0.5);
  EXPECT_GE(result.x[0], 0);
  EXPECT_LE(result.x[1], 0);
  const auto hopeless = [](std::span<const double>) { return std::nan(""); };
  EXPECT_EQ(minimize(hopeless, kBox, make_options(GetParam(), 100)).x.size(), 4u);
}

TEST_P(EveryOptimizer, StopsWhenAskedWithTheBestSoFar) {
  OptimizeOptions options = make_options(GetParam(), 100000);
  options.population = 20;
  int reports = 0;
  const auto result =
      minimize(rastrigin, kBox, options, [&](double, std::string_view) { return ++reports < 5; });
  EXPECT_TRUE(result.stopped);
  EXPECT_EQ(result.evaluations, 100);
  EXPECT_EQ(result.value, rastrigin(result.x));
}

TEST_P(EveryOptimizer, RethrowsWhatTheObjectiveThrows) {
  const auto objective = [](std::span<const double>) -> double { throw std::domain_error("no such shape"); };
  EXPECT_THROW(minimize(objective, kBox, make_options(GetParam(), 100)), std::domain_error);
}

// The median over 20 seeds. A broken update rule does not reach the bounds that the tests set for it.
double median_value(Algorithm algorithm, double (*f)(std::span<const double>), std::int64_t evaluations) {
  std::vector<double> values;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    OptimizeOptions options = make_options(algorithm, evaluations);
    options.seed = seed;
    values.push_back(minimize(f, kBox, options).value);
  }
  std::nth_element(values.begin(), values.begin() + 10, values.end());
  return values[10];
}

TEST(ParticleSwarm, RosenbrockAndRastrigin) {
  EXPECT_LT(median_value(Algorithm::pso, rosenbrock, 20000), 0.02);
  EXPECT_LT(median_value(Algorithm::pso, rastrigin, 10000), 4);
}

TEST(Nlopt, RosenbrockAndRastrigin) {
  EXPECT_LT(median_value(Algorithm::crs2, rosenbrock, 20000), 1e-6);
  EXPECT_LT(median_value(Algorithm::isres, rastrigin, 20000), 3);
  EXPECT_LT(minimize(rosenbrock, kBox, make_options(Algorithm::sbplx, 20000)).value, 0.01);
}

TEST(Optimizer, TheStartIsTried) {
  for (const Algorithm algorithm : {Algorithm::pso, Algorithm::crs2, Algorithm::isres, Algorithm::sbplx}) {
    OptimizeOptions options = make_options(algorithm, 300);
    options.start = kOptimum;
    EXPECT_EQ(minimize(rastrigin, kBox, options).value, 0) << static_cast<int>(algorithm);
  }
}

TEST(Optimizer, UnknownNamesAreRefused) {
  EXPECT_EQ(optimizer_from_name("sbplx"), Algorithm::sbplx);
  EXPECT_THROW(optimizer_from_name("PSO"), InputError);
}

TEST(Optimizer, WrongBoundsAndOptions) {
  EXPECT_THROW(minimize(sphere, {}), InputError);
  EXPECT_THROW(minimize(sphere, {{0, 0}, {1}}), InputError);
  EXPECT_THROW(minimize(sphere, {{1}, {0}}), InputError);
  EXPECT_THROW(minimize(sphere, {{0}, {std::nan("")}}), InputError);
  EXPECT_THROW(minimize(sphere, kBox, make_options(Algorithm::pso, 0)), InputError);
  OptimizeOptions options;
  options.start = {1};
  EXPECT_THROW(minimize(sphere, kBox, options), InputError);
}

}  // namespace
}  // namespace astrolith
