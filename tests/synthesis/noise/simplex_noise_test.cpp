#include "synthesis/noise/simplex_noise.h"

#include <cmath>

#include "numerics/hash_random.h"
#include "tests/synthesis/noise_sampling.h"

namespace astrolith {
namespace {

float random_coordinate(CounterRandom& random, double reach) {
  return static_cast<float>(random.uniform(-reach, reach));
}

TEST(SimplexNoise, StaysWithinOneAndHasNoMean) {
  CounterRandom random(1);
  double sum = 0.0, sum_squares = 0.0, largest = 0.0;
  constexpr int n = 1000000;
  for (int i = 0; i < n; ++i) {
    const double v = simplex_noise(random_coordinate(random, 300), random_coordinate(random, 300),
                                   random_coordinate(random, 300), 42u);
    sum += v;
    sum_squares += v * v;
    largest = std::max(largest, std::fabs(v));
  }
  EXPECT_LE(largest, 1.0);
  EXPECT_GT(largest, 0.9);  // the scale uses most of the range
  EXPECT_NEAR(sum / n, 0.0, 4 * 0.4 / std::sqrt(n / 20.0));
  EXPECT_NEAR(std::sqrt(sum_squares / n), 0.39, 0.01);
}

TEST(SimplexNoise, IsZeroAtLatticeCorners) {
  // Corners of the skewed lattice lie at i - (i + j + k)/6.
  EXPECT_EQ(simplex_noise(0.0f, 0.0f, 0.0f, 5u), 0.0f);
  EXPECT_NEAR(simplex_noise(5.0f / 6, -1.0f / 6, -1.0f / 6, 5u), 0.0f, 1e-5f);
  EXPECT_NEAR(simplex_noise(-1.0f, 1.0f, 0.0f, 5u), 0.0f, 1e-5f);
}

TEST(SimplexNoise, IsContinuousWithItsSlope) {
  // Short random steps, also across cell borders, change the value and the slope little.
  CounterRandom random(2);
  const float h = 1e-3f;
  for (int i = 0; i < 200000; ++i) {
    const float x = random_coordinate(random, 4), y = random_coordinate(random, 4),
                z = random_coordinate(random, 4);
    const float a = simplex_noise(x - h, y, z, 3u), b = simplex_noise(x, y, z, 3u),
                c = simplex_noise(x + h, y, z, 3u);
    ASSERT_LT(std::fabs(c - a), 2 * h * 8.0f);
    ASSERT_LT(std::fabs(c - 2 * b + a), 5e-5f);  // h^2 times the largest curvature, about 40
  }
}

TEST(SimplexNoise, GradientIsThatOfItsValues) {
  CounterRandom random(4);
  for (int i = 0; i < 10000; ++i) {
    const float x = random_coordinate(random, 50), y = random_coordinate(random, 50),
                z = random_coordinate(random, 50);
    const NoiseSample s = simplex_with_gradient(x, y, z, 9u);
    ASSERT_NEAR(s.value, simplex_noise(x, y, z, 9u), 1e-6);
    ASSERT_LT(norm(s.gradient), 7.0f);
  }
  EXPECT_LT(testing::gradient_error(simplex_with_gradient, 20000), 1e-2);
}

TEST(SimplexNoise, SeedsAreIndependent) {
  CounterRandom random(3);
  double product = 0.0;
  constexpr int n = 200000;
  for (int i = 0; i < n; ++i) {
    const float x = random_coordinate(random, 200), y = random_coordinate(random, 200),
                z = random_coordinate(random, 200);
    product += simplex_noise(x, y, z, 1u) * simplex_noise(x, y, z, 2u);
  }
  EXPECT_NEAR(product / n, 0.0, 4 * 0.16 / std::sqrt(static_cast<double>(n)));
}

TEST(SimplexNoise, HasNoPreferredAxis) {
  CounterRandom random(6);
  double slopes[3] = {0, 0, 0};
  const float h = 0.01f;
  constexpr int n = 300000;
  for (int i = 0; i < n; ++i) {
    const float x = random_coordinate(random, 200), y = random_coordinate(random, 200),
                z = random_coordinate(random, 200);
    const float v = simplex_noise(x, y, z, 9u);
    const float d[3] = {simplex_noise(x + h, y, z, 9u) - v, simplex_noise(x, y + h, z, 9u) - v,
                        simplex_noise(x, y, z + h, 9u) - v};
    for (int k = 0; k < 3; ++k) slopes[k] += d[k] * d[k];
  }
  EXPECT_NEAR(slopes[0] / slopes[1], 1.0, 0.15);
  EXPECT_NEAR(slopes[0] / slopes[2], 1.0, 0.15);
}

}  // namespace
}  // namespace astrolith
