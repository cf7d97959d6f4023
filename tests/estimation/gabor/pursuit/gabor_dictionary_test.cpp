#include <Eigen/Cholesky>
#include <cmath>

#include "estimation/gabor/pursuit/gabor_dictionary.h"
#include "estimation/gabor/pursuit/nonnegative_quadratic.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// Weights that differ everywhere and are symmetric under f -> -f, zero at frequency 0.
std::vector<double> uneven_weight(int width, int height) {
  std::vector<double> weight;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double fx = signed_frequency(x, width);
      const double fy = signed_frequency(y, height);
      weight.push_back(x == 0 && y == 0 ? 0.0 : 1.0 + std::cos(0.1 * fx * fy) + 0.01 * (fx * fx + fy * fy));
    }
  }
  return weight;
}

// A column computed by its definition, without transforms.
std::vector<double> column(const GaborDictionary& dictionary, std::size_t j) {
  const GaborAtom& atom = dictionary.atom(j);
  const double deviation = lobe_deviation(atom.bandwidth);
  const int w = dictionary.width();
  const int h = dictionary.height();
  std::vector<double> values(dictionary.rows(), 0.0);
  for (const int sign : {1, -1}) {
    const auto gx = periodic_gaussian(w, sign * atom.kx, deviation * w);
    const auto gy = periodic_gaussian(h, sign * atom.ky, deviation * h);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] += dictionary.scale(j) * dictionary.weight()[i] * gx[i % static_cast<std::size_t>(w)] *
                   gy[i / static_cast<std::size_t>(w)];
    }
  }
  return values;
}

class DictionarySizes : public ::testing::TestWithParam<std::pair<int, int>> {
 protected:
  int w = GetParam().first;
  int h = GetParam().second;
  GaborDictionary dictionary{w, h, 2, narrowest_bandwidth(w, h), uneven_weight(w, h)};
};

TEST_P(DictionarySizes, ColumnsAreUnitVectorsAndProductsAreTheirs) {
  CounterRandom random(11);
  std::vector<double> r(dictionary.rows());
  for (double& value : r) value = random.normal();
  std::vector<double> correlations(dictionary.size());
  dictionary.analyze(r, correlations);
  std::vector<double> image(dictionary.rows());
  for (std::size_t j = 0; j < dictionary.size(); j += 37) {
    const std::vector<double> a = column(dictionary, j);
    double squared = 0.0;
    double product = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      squared += a[i] * a[i];
      product += a[i] * r[i];
    }
    EXPECT_NEAR(squared, 1.0, 1e-9) << "atom " << j;
    EXPECT_NEAR(correlations[j], product, 1e-9) << "atom " << j;
    std::vector<double> x(dictionary.size(), 0.0);
    x[j] = 2.0;
    dictionary.synthesize(x, image);
    for (std::size_t i = 0; i < a.size(); i += 5) ASSERT_NEAR(image[i], 2.0 * a[i], 1e-10) << "atom " << j;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, DictionarySizes,
                         ::testing::Values(std::pair{32, 32}, std::pair{40, 33}, std::pair{35, 64}));

TEST(GaborDictionary, HasTheAtomsOfThePaper) {
  // The reference estimator counts 26,836 atoms at 128 x 128 for bandwidths 2 .. 7. It also keeps atoms at
  // the Nyquist frequencies, which belong to no pair.
  const GaborDictionary dictionary(128, 128, 2, 7, std::vector<double>(128 * 128, 1.0));
  EXPECT_NEAR(static_cast<double>(dictionary.size()), 26836.0, 0.02 * 26836.0);
  EXPECT_EQ(narrowest_bandwidth(128, 128), 7);
  EXPECT_EQ(narrowest_bandwidth(256, 256), 8);
}

TEST(GaborDictionary, NeighboursOfOneBandwidthCorrelateByAtMost95Percent) {
  const GaborDictionary dictionary(128, 128, 2, 4, std::vector<double>(128 * 128, 1.0));
  std::vector<double> correlations(dictionary.size());
  for (std::size_t j = 50; j < dictionary.size(); j += 301) {
    dictionary.analyze(column(dictionary, j), correlations);
    for (std::size_t i = 0; i < dictionary.size(); ++i) {
      if (i == j || dictionary.atom(i).bandwidth != dictionary.atom(j).bandwidth) continue;
      const int far_x = std::min(std::abs(dictionary.atom(i).kx), std::abs(dictionary.atom(j).kx));
      const int far_y = std::min(std::abs(dictionary.atom(i).ky), std::abs(dictionary.atom(j).ky));
      if (std::max(far_x, far_y) < 40) continue;  // near frequency 0 a pair overlaps itself
      EXPECT_LE(correlations[i], 0.96);
    }
  }
}

TEST(GaborDictionary, ThreadsDoNotChangeABit) {
  const GaborDictionary dictionary(48, 40, 2, 5, uneven_weight(48, 40));
  std::vector<double> r(dictionary.rows(), 0.0);
  CounterRandom random(13);
  for (double& value : r) value = random.normal();
  std::vector<double> one(dictionary.size());
  std::vector<double> many(dictionary.size());
  {
    const ThreadLimit limit(1);
    dictionary.analyze(r, one);
  }
  {
    const ThreadLimit limit(4);
    dictionary.analyze(r, many);
  }
  EXPECT_EQ(one, many);
}

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
