#include "estimation/gabor/pursuit/basis_pursuit.h"

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

std::vector<double> speckled_target(const GaborDictionary& dictionary, std::uint64_t seed) {
  CounterRandom random(seed);
  std::vector<double> x(dictionary.size(), 0.0);
  for (int k = 0; k < 6; ++k) x[random.below(x.size())] += 1.0 + random.uniform();
  std::vector<double> s(dictionary.rows());
  dictionary.synthesize(x, s);
  // Symmetric speckle, as in a periodogram.
  const int w = dictionary.width();
  const int h = dictionary.height();
  for (int y = 0; y < h; ++y) {
    for (int xx = 0; xx < w; ++xx) {
      const auto i = static_cast<std::size_t>(y * w + xx);
      const auto mirror = static_cast<std::size_t>((h - y) % h * w + (w - xx) % w);
      if (mirror < i) continue;
      s[i] = s[mirror] = -std::log(1.0 - random.uniform()) * s[i];
    }
  }
  return s;
}

TEST(BasisPursuit, EndsAtTheMinimumAndItsCertificateIsTrue) {
  const GaborDictionary dictionary(20, 16, 2, 3, std::vector<double>(20 * 16, 1.0));
  ASSERT_LE(dictionary.size(), 300u);
  for (const std::uint64_t seed : {1, 2, 3}) {
    BasisPursuitProblem problem{dictionary, speckled_target(dictionary, seed), 0.0};
    problem.penalty = 0.02 * largest_penalty(dictionary, problem.target);
    // MeetsTheOptimalityConditions shows that this is the minimum.
    BasisPursuitOptions exact;
    exact.relative_gap = 1e-11;
    exact.max_iterations = 100000;
    const double minimum = solve_working_set(problem, exact).primal;
    for (const double gap : {1e-2, 1e-4, 1e-7}) {
      BasisPursuitOptions options;
      options.relative_gap = gap;
      const BasisPursuitResult result = solve_working_set(problem, options);
      EXPECT_TRUE(result.reached);
      EXPECT_GE(result.primal, minimum * (1.0 - 1e-9));
      EXPECT_LE(result.primal - minimum, result.relative_gap * result.primal + 1e-9 * minimum);
      for (const GapSample& sample : result.history) EXPECT_GE(sample.relative_gap, 0.0);
      EXPECT_GE(*std::min_element(result.x.begin(), result.x.end()), 0.0);
    }
  }
}

TEST(BasisPursuit, AboveTheLargestPenaltyTheSolutionIsZero) {
  const GaborDictionary dictionary(32, 32, 2, 4, std::vector<double>(32 * 32, 1.0));
  BasisPursuitProblem problem{dictionary, speckled_target(dictionary, 4), 0.0};
  problem.penalty = 1.001 * largest_penalty(dictionary, problem.target);
  const BasisPursuitResult result = solve_working_set(problem, {});
  EXPECT_TRUE(result.reached);
  EXPECT_EQ(*std::max_element(result.x.begin(), result.x.end()), 0.0);
}

// The gap stays a true bound on targets that no spectrum has: negative values, zeros and one spike.
TEST(BasisPursuit, AdversarialTargetsKeepTheGapNonNegative) {
  const GaborDictionary dictionary(32, 32, 2, 5, std::vector<double>(32 * 32, 1.0));
  std::vector<std::vector<double>> targets(3, std::vector<double>(dictionary.rows(), 0.0));
  for (double& v : targets[0]) v = -1.0;
  targets[1][5 * 32 + 3] = 1.0;
  CounterRandom random(5);
  for (double& v : targets[2]) v = random.normal();
  for (std::vector<double>& target : targets) {
    BasisPursuitProblem problem{dictionary, target, 0.05};
    BasisPursuitOptions options;
    options.max_iterations = 300;
    const BasisPursuitResult result = solve_working_set(problem, options);
    for (const GapSample& sample : result.history) EXPECT_GE(sample.relative_gap, 0.0);
  }
  const BasisPursuitResult zero = solve_working_set(
      {dictionary, std::vector<double>(dictionary.rows(), 0.0), 0.05}, BasisPursuitOptions{});
  EXPECT_TRUE(zero.reached);
}

// The test checks the optimality conditions in its own arithmetic: a_j'r <= penalty everywhere, with equality
// where x_j > 0.
TEST(BasisPursuit, MeetsTheOptimalityConditions) {
  const GaborDictionary dictionary(32, 24, 2, 5, std::vector<double>(32 * 24, 1.0));
  BasisPursuitProblem problem{dictionary, speckled_target(dictionary, 12), 0.0};
  const double largest = largest_penalty(dictionary, problem.target);
  for (const double share : {0.3, 0.03}) {
    problem.penalty = share * largest;
    BasisPursuitOptions options;
    options.relative_gap = 1e-9;
    options.max_iterations = 100000;
    const BasisPursuitResult exact = solve_working_set(problem, options);
    EXPECT_TRUE(exact.reached);
    std::vector<double> a(dictionary.rows()), correlations(dictionary.size());
    dictionary.synthesize(exact.x, a);
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = problem.target[i] - a[i];
    dictionary.analyze(a, correlations);
    // By strong convexity every correlation is at most this far from its value at the optimum.
    const double slack = std::sqrt(2.0 * options.relative_gap * exact.primal);
    for (std::size_t j = 0; j < correlations.size(); ++j) {
      EXPECT_LE(correlations[j], problem.penalty + slack);
      if (exact.x[j] > 0.01 * largest) {
        EXPECT_NEAR(correlations[j], problem.penalty, slack);
      }
    }
  }
}

// Where the residual points away from the target, the scaled dual has a negative factor. A certificate
// without a clip would then claim a bound above the minimum.
TEST(DualityCertificate, ResidualsAgainstTheTargetGiveNoFalseBound) {
  const GaborDictionary dictionary(32, 32, 2, 4, std::vector<double>(32 * 32, 1.0));
  const BasisPursuitProblem problem{dictionary, speckled_target(dictionary, 6), 1.0};
  DualityCertificate certificate(problem);
  std::vector<double> r = problem.target;
  for (double& v : r) v *= -3.0;
  std::vector<double> correlations(dictionary.size());
  dictionary.analyze(r, correlations);
  EXPECT_GE(certificate.check(r, correlations, 1.0), 0.0);
  EXPECT_GE(certificate.best_dual(), 0.0);
}

TEST(DualityCertificate, AWrongTransposeIsCaught) {
  const GaborDictionary dictionary(32, 32, 2, 4, std::vector<double>(32 * 32, 1.0));
  const BasisPursuitProblem problem{dictionary, speckled_target(dictionary, 6), 1.0};
  DualityCertificate certificate(problem);
  const std::vector<double> correlations(dictionary.size(), 0.0);  // claims that every theta is feasible
  certificate.check(problem.target, correlations, 0.0);
  const std::vector<double> nearly_fitted(dictionary.rows(), 0.0);
  EXPECT_THROW(certificate.check(nearly_fitted, correlations, 0.0), WorkError);
}

}  // namespace
}  // namespace astrolith
