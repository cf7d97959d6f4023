#include "synthesis/noise/perlin_noise.h"

#include "tests/synthesis/noise_sampling.h"

namespace astrolith {
namespace {

using testing::random_place;

TEST(PerlinNoise, HasTheStatedRangeMeanAndDeviation) {
  const testing::NoiseStatistics s = testing::statistics_of(perlin_noise, 1000000);
  EXPECT_GE(s.least, -1.0);
  EXPECT_LE(s.greatest, 1.0);
  EXPECT_GT(s.greatest, 0.85);
  EXPECT_NEAR(s.mean, 0.0, 6 * 0.2605 / 1000);
  EXPECT_NEAR(s.deviation, 0.2605, 0.002);
}

TEST(PerlinNoise, IsZeroAtLatticePoints) {
  for (const float x : {-2.0f, 0.0f, 5.0f}) EXPECT_EQ(perlin_noise(x, 1.0f, -7.0f, 3u), 0.0f);
}

TEST(PerlinNoise, GradientIsThatOfTheSameValues) {
  CounterRandom random(2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3f p = random_place(random, 50.0);
    ASSERT_EQ(perlin_with_gradient(p.x, p.y, p.z, 9u).value, perlin_noise(p.x, p.y, p.z, 9u));
  }
  EXPECT_LT(testing::gradient_error(perlin_with_gradient, 20000), 1.5e-3);
}

TEST(PerlinNoise, IsContinuousWithItsSlope) {
  CounterRandom random(2);
  const float h = 1e-3f;
  for (int i = 0; i < 100000; ++i) {
    const Vec3f p = random_place(random, 4.0);
    const float a = perlin_noise(p.x - h, p.y, p.z, 3u), b = perlin_noise(p.x, p.y, p.z, 3u),
                c = perlin_noise(p.x + h, p.y, p.z, 3u);
    ASSERT_LT(std::fabs(c - a), 2 * h * 3.65f);
    ASSERT_LT(std::fabs(c - 2 * b + a), 3e-5f);
  }
}

TEST(PerlinNoise, HasNoPreferredAxisAndIndependentSeeds) {
  CounterRandom random(6);
  Vec3d slopes;
  double product = 0.0;
  constexpr int n = 300000;
  for (int i = 0; i < n; ++i) {
    const Vec3f p = random_place(random, 200.0);
    const NoiseSample s = perlin_with_gradient(p.x, p.y, p.z, 9u);
    slopes += Vec3d{s.gradient.x * s.gradient.x, s.gradient.y * s.gradient.y, s.gradient.z * s.gradient.z};
    product += s.value * perlin_noise(p.x, p.y, p.z, 10u);
  }
  EXPECT_NEAR(slopes.y / slopes.x, 1.0, 0.2);  // Perlin's sixteen choices prefer y a little
  EXPECT_NEAR(slopes.z / slopes.x, 1.0, 0.1);
  EXPECT_NEAR(product / n, 0.0, 4 * 0.07 / std::sqrt(static_cast<double>(n)));
}

}  // namespace
}  // namespace astrolith
