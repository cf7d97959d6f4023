#include "estimation/optimize/evaluation_log.h"

#include <cmath>
#include <thread>
#include <vector>

namespace astrolith {
namespace {

double bowl(std::span<const double> x) {
  double sum = 0.0;
  for (const double v : x) sum += (v - 0.3) * (v - 0.3);
  return sum;
}

TEST(EvaluationLog, TellsPointsApartByTheirBits) {
  EvaluationLog log;
  const std::vector<double> a{1.0, 2.0}, b{2.0, 1.0}, c{1.0, std::nextafter(2.0, 3.0)};
  log.add(a, 5.0);
  EXPECT_EQ(log.find(a), 5.0);
  EXPECT_FALSE(log.find(b).has_value());
  EXPECT_FALSE(log.find(c).has_value());
  EXPECT_EQ(log.size(), 1u);
}

// For the thread sanitizer: one thread adds, the others ask.
TEST(EvaluationLog, ThreadsAskWhileAnotherAdds) {
  EvaluationLog log;
  constexpr int kPoints = 400;
  const auto point = [](int i) { return std::vector<double>{static_cast<double>(i), 1.0}; };
  log.add(point(0), 0.0);
  std::vector<std::thread> others;
  for (int thread = 0; thread < 2; ++thread) {
    others.emplace_back([&] {
      for (int i = 0; i < kPoints; ++i) EXPECT_EQ(log.find(point(0)), 0.0);
    });
  }
  for (int i = 1; i < kPoints; ++i) log.add(point(i), i);
  for (std::thread& other : others) other.join();
  EXPECT_EQ(log.size(), std::size_t{kPoints});
}

TEST(EvaluationLog, EveryAlgorithmGoesOnWhereItStopped) {
  const Bounds bounds{{-1, -1, -1}, {1, 1, 1}};
  for (const char* name : {"pso", "crs2", "isres", "esch", "sbplx"}) {
    OptimizeOptions options;
    options.algorithm = optimizer_from_name(name);
    options.population = 8;
    options.max_evaluations = 80;
    const OptimizeResult whole = minimize(bowl, bounds, options);
    EvaluationLog log;
    int asked = 0;
    const BatchObjective counted = [&](std::span<const std::vector<double>> points) {
      asked += static_cast<int>(points.size());
      std::vector<double> values;
      for (const std::vector<double>& x : points) values.push_back(bowl(x));
      return values;
    };
    const BatchObjective remembered = logged(counted, log);
    OptimizeOptions part = options;
    part.max_evaluations = 40;
    part.algorithm = options.algorithm;
    minimize(remembered, bounds, part);
    const int before = asked;
    const OptimizeResult rest = minimize(remembered, bounds, options);
    EXPECT_EQ(rest.x, whole.x) << name;
    EXPECT_EQ(rest.value, whole.value) << name;
    EXPECT_EQ(rest.history, whole.history) << name;
    EXPECT_LT(asked - before, 60) << name;
  }
}

}  // namespace
}  // namespace astrolith
