#include "estimation/gabor/pursuit/nonnegative_quadratic.h"

#include <Eigen/Cholesky>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

struct Problem {
  Eigen::MatrixXd G;
  Eigen::VectorXd q;
  double value(const Eigen::VectorXd& x) const { return 0.5 * x.dot(G * x) - q.dot(x); }
};

// A problem whose columns are positive and therefore much alike, as those of lobes are.
Problem random_problem(int n, std::uint64_t seed) {
  CounterRandom random(seed);
  Eigen::MatrixXd A(n + 2, n);
  for (Eigen::Index i = 0; i < A.size(); ++i) A(i) = random.uniform();
  Eigen::VectorXd s(n + 2);
  for (double& v : s) v = random.uniform();
  return {A.transpose() * A, A.transpose() * s - Eigen::VectorXd::Constant(n, 0.1)};
}

// The least value over every set of positive coordinates.
double exhaustive_minimum(const Problem& p) {
  const int n = static_cast<int>(p.q.size());
  double best = 0.0;
  for (int set = 1; set < 1 << n; ++set) {
    std::vector<Eigen::Index> at;
    for (int i = 0; i < n; ++i) {
      if ((set >> i & 1) != 0) at.push_back(i);
    }
    const Eigen::VectorXd z = Eigen::MatrixXd(p.G(at, at)).ldlt().solve(Eigen::VectorXd(p.q(at)));
    if (z.minCoeff() < 0.0) continue;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    x(at) = z;
    best = std::min(best, p.value(x));
  }
  return best;
}

TEST(NonnegativeQuadratic, FindsTheMinimumOfAllActiveSets) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Problem p = random_problem(1 + static_cast<int>(seed % 9), seed);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(p.q.size());
    EXPECT_TRUE(minimize_nonnegative_quadratic(p.G, p.q, x));
    EXPECT_GE(x.minCoeff(), 0.0);
    EXPECT_NEAR(p.value(x), exhaustive_minimum(p), 1e-10) << seed;
  }
}

TEST(NonnegativeQuadratic, MeetsTheOptimalityConditionsOfALargeProblem) {
  const Problem p = random_problem(150, 3);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(150);
  EXPECT_TRUE(minimize_nonnegative_quadratic(p.G, p.q, x));
  const Eigen::VectorXd gradient = p.G * x - p.q;
  for (Eigen::Index i = 0; i < 150; ++i) {
    EXPECT_GE(gradient(i), -1e-8);
    EXPECT_NEAR(x(i) * gradient(i), 0.0, 1e-8);
  }
}

// After any number of factorisations the point is feasible and its value no higher than before.
TEST(NonnegativeQuadratic, NeverRisesWhereverItStops) {
  const Problem p = random_problem(80, 5);
  Eigen::VectorXd x = Eigen::VectorXd::Constant(80, 0.05);
  double before = p.value(x);
  bool done = false;
  for (int call = 0; call < 400 && !done; ++call) {
    done = minimize_nonnegative_quadratic(p.G, p.q, x, 1 + call % 7);
    EXPECT_GE(x.minCoeff(), 0.0);
    EXPECT_LE(p.value(x), before + 1e-12);
    before = p.value(x);
  }
  Eigen::VectorXd exact = Eigen::VectorXd::Zero(80);
  minimize_nonnegative_quadratic(p.G, p.q, exact);
  EXPECT_NEAR(before, p.value(exact), 1e-9);
}

TEST(NonnegativeQuadratic, EqualColumnsAreNoTrouble) {
  Problem p;
  p.G = Eigen::MatrixXd::Constant(5, 5, 1.0);
  p.q = Eigen::VectorXd::Constant(5, 2.0);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(5);
  minimize_nonnegative_quadratic(p.G, p.q, x);
  EXPECT_NEAR(x.sum(), 2.0, 1e-6);
}

}  // namespace
}  // namespace astrolith
