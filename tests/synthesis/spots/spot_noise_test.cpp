#include "synthesis/spots/spot_noise.h"
#include "tests/synthesis/lone_noise.h"

#include <array>
#include <cmath>
#include <vector>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

const Box kSpotDomain{{-50, -50, -50}, {50, 50, 50}};

// The impulses of kind k whose spots may reach the box.
std::vector<SpotImpulse> impulses_reaching(const LoneNoise<SpotNoise>& noise, std::uint32_t k,
                                           const Box& box) {
  const SpotNoise& n = noise.noise();
  return draw_spots(noise.arrays()[n.kinds][k], noise.arrays()[n.thresholds], box);
}

float height_at(const LoneNoise<SpotNoise>& noise, float x, float y, float z) {
  float h = 0.0f;
  noise.evaluate(1, &x, &y, &z, &h);
  return h;
}

// Spots with a tenth of the size of a cell, in unit cells whose impulses stay within their cells.
SpotLayer small_spots(double density) {
  SpotLayer layer;
  layer.amplitude = 1.0;
  layer.cell_size = 1.0;
  layer.size = 0.05;
  layer.density = density;
  layer.reach = 0.0;
  return layer;
}

constexpr int kSide = 40;  // cells

std::vector<int> counts_by_cell(const SpotLayer& layer) {
  const Box box{{0, 0, 0}, {kSide, kSide, kSide}};
  std::vector<int> counts(kSide * kSide * kSide);
  for (const SpotImpulse& p : impulses_reaching(LoneNoise<SpotNoise>(layer, 3, 1, kSpotDomain), 0, box)) {
    const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y)),
              z = static_cast<int>(std::floor(p.z));
    if (x < 0 || y < 0 || z < 0 || x >= kSide || y >= kSide || z >= kSide) continue;
    ++counts[static_cast<std::size_t>((z * kSide + y) * kSide + x)];
  }
  return counts;
}

TEST(SpotNoise, CountsArePoissonDistributed) {
  const double density = 1.7, cells = kSide * kSide * kSide;
  const std::vector<int> counts = counts_by_cell(small_spots(density));
  std::array<double, 8> seen{};
  for (const int c : counts) ++seen[static_cast<std::size_t>(std::min(c, 7))];
  double probability = std::exp(-density), rest = 1.0, chi_squared = 0.0;
  for (int k = 0; k < 8; ++k) {
    const double expected = cells * (k < 7 ? probability : rest);
    chi_squared += std::pow(seen[static_cast<std::size_t>(k)] - expected, 2) / expected;
    rest -= probability;
    probability *= density / (k + 1);
  }
  EXPECT_LT(chi_squared, 24.3);  // 7 degrees of freedom: one seed in a thousand is above
}

TEST(SpotNoise, NeighbouringCellsAreIndependent) {
  const double density = 2.0;
  const std::vector<int> counts = counts_by_cell(small_spots(density));
  for (const int step : {1, kSide, kSide * kSide}) {
    double covariance = 0.0;
    const auto pairs = static_cast<int>(counts.size()) - step;
    for (int i = 0; i < pairs; ++i) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(i + step);
      covariance += (counts[a] - density) * (counts[b] - density) / pairs;
    }
    EXPECT_NEAR(covariance, 0.0, 4.0 * density / std::sqrt(pairs));
  }
}

TEST(SpotNoise, ProbabilityThinsCellsAndReachSpreadsImpulses) {
  SpotLayer layer = small_spots(1.5);
  layer.probability = 0.3;
  int occupied = 0;
  for (const int c : counts_by_cell(layer)) occupied += c > 0;
  const double cells = kSide * kSide * kSide, expected = 0.3 * (1.0 - std::exp(-1.5));
  EXPECT_NEAR(occupied / cells, expected, 4.0 * std::sqrt(expected / cells));

  layer.probability = 1.0;
  layer.reach = 1.0;
  double total = 0.0, left_half = 0.0, weight = 0.0;
  const Box box{{-5, -5, -5}, {5, 5, 5}};
  for (const SpotImpulse& p : impulses_reaching(LoneNoise<SpotNoise>(layer, 3, 1, kSpotDomain), 0, box)) {
    total += 1.0;
    left_half += p.x - std::floor(p.x) < 0.5f;
    weight += static_cast<double>(p.weight);
    ASSERT_TRUE(p.weight >= 0.5f && p.weight <= 1.0f);
  }
  EXPECT_NEAR(total, 1.5 * std::pow(10.2, 3), 4 * std::sqrt(1.5 * 1061));
  EXPECT_NEAR(left_half / total, 0.5, 0.05);
  EXPECT_NEAR(weight / total, 0.75, 0.02);
}

// Few spots that are wider, of the profile profile_at.
SpotLayer wide_spots(double density) {
  SpotLayer layer = small_spots(density);
  layer.size = 0.1;
  layer.amplitude = 2.0;
  layer.alpha = 1.5;
  layer.kappa = -0.4;
  layer.gamma = 0.5;
  return layer;
}
double profile_at(double q2) {
  return std::exp(-1.5 * q2) - 0.4 * std::exp(-10 * std::pow(std::log(0.5 * q2), 2));
}

// The height at q sizes from the centre of a spot.
float height_beside(const LoneNoise<SpotNoise>& noise, const SpotImpulse& spot, const Vec3d& q) {
  return height_at(noise, spot.x + 0.1f * static_cast<float>(q.x), spot.y + 0.1f * static_cast<float>(q.y),
                   spot.z + 0.1f * static_cast<float>(q.z));
}

// The height of one impulse equals the kernel of the thesis.
TEST(SpotNoise, ASpotIsItsKernelAndNothingBeyondSigma) {
  SpotLayer layer = wide_spots(0.05);
  layer.variances = {1.0, 2.0, 0.5};
  layer.sigma = 6.0;
  const LoneNoise<SpotNoise> noise(layer, 8, 0, kSpotDomain);
  layer.inverted = true;
  const LoneNoise<SpotNoise> boulders(layer, 8, 0, kSpotDomain);
  const SpotImpulse spot = impulses_reaching(noise, 0, {{0, 0, 0}, {20, 20, 20}}).front();
  CounterRandom random(1);
  int within = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3d q{random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4)};
    const double cut = q.x * q.x + q.y * q.y / 2 + q.z * q.z / 0.5;
    if (std::fabs(cut - 6.0) < 1e-3) continue;
    const double expected = cut <= 6.0 ? -2.0 * double{spot.weight} * profile_at(squared_norm(q)) : 0.0;
    const float height = height_beside(noise, spot, q);
    ASSERT_NEAR(double{height}, expected, 1e-4);
    ASSERT_EQ(height_beside(boulders, spot, q), -height);
    within += cut <= 6.0;
  }
  EXPECT_GT(within, 100);
}

// The sizes of spots that a plane cuts: the number above a size falls with the exponent.
TEST(SpotNoise, SizesOnASurfaceFollowTheExponent) {
  for (const double exponent : {1.5, 2.0, 2.9}) {
    SpotLayer layer = small_spots(2.0);
    layer.size = 0.4;
    layer.layers = 4;
    layer.exponent = exponent;
    const LoneNoise<SpotNoise> noise(layer, 5, 0, kSpotDomain);
    double slope = 0.0, error = 0.0;
    std::vector<double> count;
    for (std::uint32_t j = 0; j < noise.noise().kinds.count; ++j) {
      double n = 0;
      for (const SpotImpulse& p : impulses_reaching(noise, j, {{-20, -20, 0.3}, {20, 20, 0.3}})) {
        n += std::fabs(p.x) < 20 && std::fabs(p.y) < 20;
      }
      count.push_back(n);
    }
    ASSERT_EQ(count.size(), 4u);
    slope = std::log2(count[3] / count[0]) / 3.0;
    error = std::sqrt(1.0 / count[0] + 1.0 / count[3]) / std::log(2.0) / 3.0;
    EXPECT_NEAR(slope, exponent, 3.0 * error) << count[0] << " " << count[3];
  }
}

SpotPart random_part(CounterRandom& random) {
  const auto triple = [&](double low, double high) {
    const double x = random.uniform(low, high), y = random.uniform(low, high);
    return Vec3d{x, y, random.uniform(low, high)};
  };
  SpotPart part;
  part.center = triple(-1, 1);
  part.axes = triple(0.3, 1.5);
  part.turn = triple(-180, 180);
  part.weight = random.uniform(-1, 1);
  return part;
}

SpotLayer random_layer(CounterRandom& random) {
  SpotLayer layer;
  layer.amplitude = random.uniform(-1, 1);
  layer.inverted = random.uniform() < 0.5;
  layer.size = std::pow(10.0, random.uniform(-1.5, 0.5));
  layer.variances = {random.uniform(0.3, 2), random.uniform(0.3, 2), 1.0};
  layer.sigma = random.uniform(0.5, 4);
  layer.cell_size = layer.size * random.uniform(1, 5);
  layer.density = random.uniform(0, 3);
  layer.reach = random.uniform();
  layer.gaussian = random.uniform(-1, 1);
  layer.alpha = random.uniform(0, 3);
  layer.kappa = random.uniform(-1, 1);
  layer.beta = random.uniform(0, 20);
  layer.gamma = random.uniform(0.2, 2);
  layer.layers = 1 + static_cast<int>(random.below(3));
  for (auto parts = random.below(4); parts > 1; --parts) layer.parts.push_back(random_part(random));
  if (random.uniform() < 0.5) {
    layer.even = random.uniform() < 0.5;
    layer.lattice = {{1, 0, 0}, {random.uniform(-0.5, 0.5), 1, 0}, {0, random.uniform(-0.5, 0.5), 0.8}};
  }
  return layer;
}

TEST(SpotNoise, BoundsOverBoxesAreNeverWrong) {
  CounterRandom random(7);
  int tight = 0;
  for (int k = 0; k < 800; ++k) {
    const SpotLayer layer = random_layer(random);
    const LoneNoise<SpotNoise> noise(layer, random.next(), 1, kSpotDomain);
    const double size = layer.size * std::pow(10.0, random.uniform(-2.5, 0.5));
    const Vec3d corner{random.uniform(-52, 50), random.uniform(-20, 20), random.uniform(-20, 20)};
    const Box box{corner, corner + Vec3d{size, size * random.uniform(0.2, 1.0), size}};
    const Interval bound = noise.bound_heights(box);
    for (int i = 0; i < 60; ++i) {
      const double v =
          static_cast<double>(height_at(noise, static_cast<float>(random.uniform(box.min.x, box.max.x)),
                                        static_cast<float>(random.uniform(box.min.y, box.max.y)),
                                        static_cast<float>(random.uniform(box.min.z, box.max.z))));
      ASSERT_GE(v, bound.low);
      ASSERT_LE(v, bound.high);
      ASSERT_LE(std::fabs(v), noise.height_bound());
    }
    tight += bound.high - bound.low < 0.3 * noise.height_bound();
  }
  EXPECT_GT(tight, 200);
}

// One impulse: each of its parts is the kernel, moved, scaled and rotated.
TEST(SpotNoise, ASpotIsTheSumOfItsParts) {
  SpotLayer layer = wide_spots(0.02);
  layer.parts = {{{1, 0, 0}, {2, 0.5, 1}, {0, 0, 30}, 0.75}, {{0, -2, 1}, {1, 1, 3}, {90, 0, 0}, -1.0}};
  const LoneNoise<SpotNoise> noise(layer, 8, 0, kSpotDomain);
  ASSERT_EQ(noise.noise().kinds.count, 2);
  SpotLayer plain = layer;
  plain.parts.clear();
  const SpotImpulse spot =
      impulses_reaching(LoneNoise<SpotNoise>(plain, 8, 0, kSpotDomain), 0, {{0, 0, 0}, {20, 20, 20}}).front();
  const auto kernel = [](const Vec3d& q) {
    const double q2 = squared_norm(q);
    return q2 <= 4.0 ? profile_at(q2) : 0.0;
  };
  const double c = std::cos(std::acos(-1.0) / 6), s = 0.5;
  CounterRandom random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d q{random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)};
    const Vec3d u{q.x - 1, q.y, q.z}, first{(c * u.x + s * u.y) / 2, (c * u.y - s * u.x) / 0.5, u.z};
    const Vec3d v{q.x, q.y + 2, q.z - 1}, second{v.x, v.z, -v.y / 3};  // z turned about x to -y
    if (std::fabs(squared_norm(first) - 4) < 1e-2 || std::fabs(squared_norm(second) - 4) < 1e-2) continue;
    const double expected = -2.0 * static_cast<double>(spot.weight) * (0.75 * kernel(first) - kernel(second));
    ASSERT_NEAR(double{height_beside(noise, spot, q)}, expected, 2e-4);
  }
}

// Each cell of an oblique lattice has one spot in its middle. The height repeats along each edge of a cell.
TEST(SpotNoise, AnEvenLatticeRepeats) {
  SpotLayer layer = small_spots(1.0);
  layer.size = 0.3;
  layer.even = true;
  layer.reach = -0.5;
  layer.least_weight = 1.0;
  layer.lattice = {{1, 0, 0}, {0.5, 0.75, 0}, {0.25, 0, 1.25}};
  const LoneNoise<SpotNoise> noise(layer, 5, 0, kSpotDomain);
  CounterRandom random(2);
  double lowest = 0.0;
  for (int i = 0; i < 300; ++i) {
    const auto at = [&] { return static_cast<float>(random.uniform(-9, 9)); };
    const float x = at(), y = at(), z = at(), height = height_at(noise, x, y, z);
    ASSERT_NEAR(height_at(noise, x + 1.0f, y, z), height, 1e-4f);
    ASSERT_NEAR(height_at(noise, x + 0.5f, y + 0.75f, z), height, 1e-4f);
    ASSERT_NEAR(height_at(noise, x + 0.25f, y, z + 1.25f), height, 1e-4f);
    lowest = std::min(lowest, static_cast<double>(height));
  }
  EXPECT_LT(lowest, -0.5);
  EXPECT_NEAR(height_at(noise, 0.875f, 0.375f, 0.625f), -1.0f, 1e-3f);
}

TEST(SpotNoise, EvenCellsHoldTheFractionByChance) {
  SpotLayer layer = small_spots(2.25);
  layer.even = true;
  double total = 0.0;
  int others = 0;  // cells that lose or gain an impulse by rounding at a side
  for (const int count : counts_by_cell(layer)) {
    others += count != 2 && count != 3;
    total += count;
  }
  EXPECT_LE(others, 8);
  const double cells = kSide * kSide * kSide;
  EXPECT_NEAR(total / cells, 2.25, 4.0 * std::sqrt(0.25 * 0.75 / cells));
}

// Points are split into groups that few impulses reach. The group of a point changes no bit of its height.
TEST(SpotNoise, DenseSpotsAreTheSameTogetherAndOneByOne) {
  SpotLayer layer = small_spots(60.0);
  layer.size = 0.4;
  layer.layers = 3;
  layer.reach = 0.5;
  layer.kappa = -0.5;
  const LoneNoise<SpotNoise> noise(layer, 3, 1, kSpotDomain);
  CounterRandom random(4);
  std::vector<float> x, y, z, height(700);
  for (std::size_t i = 0; i < height.size(); ++i) {
    x.push_back(static_cast<float>(random.uniform(-3, 3)));
    y.push_back(static_cast<float>(0.01 * static_cast<double>(i)));
    z.push_back(static_cast<float>(random.uniform(-1, 1)));
  }
  noise.evaluate(static_cast<int>(height.size()), x.data(), y.data(), z.data(), height.data());
  for (std::size_t i = 0; i < height.size(); ++i) {
    ASSERT_EQ(height[i], height_at(noise, x[i], y[i], z[i])) << i;
  }
}

TEST(SpotNoise, DrawsAtAPointAreCounted) {
  SpotLayer layer = small_spots(60.0);
  const LoneNoise<SpotNoise> one(layer, 3, 1, kSpotDomain);
  const double draws = draws_at_a_point(one.noise(), one.arrays());
  EXPECT_GE(draws, 61.0);  // those of the point's own cell
  EXPECT_LE(draws, 27.0 * 61.0);
  layer.layers = 12;
  layer.lacunarity = 1.1;
  const LoneNoise<SpotNoise> twelve(layer, 3, 1, kSpotDomain);
  EXPECT_NEAR(draws_at_a_point(twelve.noise(), twelve.arrays()), 12.0 * draws, 1e-6 * draws);
}

TEST(SpotNoise, NoDensityNoSpots) {
  EXPECT_TRUE(impulses_reaching(LoneNoise<SpotNoise>(small_spots(0.0), 3, 1, kSpotDomain), 0,
                                {{-9, -9, -9}, {9, 9, 9}})
                  .empty());
}

}  // namespace
}  // namespace astrolith
