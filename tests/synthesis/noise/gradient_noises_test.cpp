// Perlin and simplex noise.
#include <cmath>

#include "synthesis/noise/perlin_noise.h"
#include "synthesis/noise/simplex_noise.h"
#include "tests/synthesis/noise_sampling.h"

namespace astrolith {
namespace {

using testing::random_place;

struct GradientNoise {
  const char* name;
  float (*value)(float, float, float, std::uint32_t);
  NoiseSample (*with_gradient)(float, float, float, std::uint32_t);
  double deviation, greatest;  // greatest: less than the largest of a million values
  float steepest, bend;        // the largest slope, and second difference of steps of 1e-3
  double value_error, gradient_error, unevenness;  // unevenness: of the squared slopes along the axes
};

class GradientNoises : public ::testing::TestWithParam<GradientNoise> {};

TEST_P(GradientNoises, HaveTheStatedRangeMeanAndDeviation) {
  const testing::NoiseStatistics s = testing::statistics_of(GetParam().value, 1000000);
  EXPECT_GE(s.least, -1.0);
  EXPECT_LE(s.greatest, 1.0);
  EXPECT_GT(s.greatest, GetParam().greatest);
  EXPECT_NEAR(s.mean, 0.0, 6 * GetParam().deviation / 1000);
  EXPECT_NEAR(s.deviation, GetParam().deviation, 0.002);
}

TEST_P(GradientNoises, AreContinuousWithTheirSlopes) {
  CounterRandom random(2);
  const float h = 1e-3f;
  for (int i = 0; i < 150000; ++i) {
    const Vec3f p = random_place(random, 4.0);
    const auto at = [&](float step) { return GetParam().value(p.x + step, p.y, p.z, 3u); };
    ASSERT_LT(std::fabs(at(h) - at(-h)), 2 * h * GetParam().steepest);
    ASSERT_LT(std::fabs(at(h) - 2 * at(0.0f) + at(-h)), GetParam().bend);
  }
}

TEST_P(GradientNoises, GradientsAreThoseOfTheValues) {
  CounterRandom random(4);
  for (int i = 0; i < 10000; ++i) {
    const Vec3f p = random_place(random, 50.0);
    const NoiseSample s = GetParam().with_gradient(p.x, p.y, p.z, 9u);
    ASSERT_NEAR(s.value, GetParam().value(p.x, p.y, p.z, 9u), GetParam().value_error);
    ASSERT_LT(norm(s.gradient), 7.0f);
  }
  EXPECT_LT(testing::gradient_error(GetParam().with_gradient, 20000), GetParam().gradient_error);
}

TEST_P(GradientNoises, HaveNoPreferredAxisAndIndependentSeeds) {
  CounterRandom random(6);
  Vec3d slopes;
  double product = 0.0;
  constexpr int n = 300000;
  for (int i = 0; i < n; ++i) {
    const Vec3f p = random_place(random, 200.0);
    const NoiseSample s = GetParam().with_gradient(p.x, p.y, p.z, 9u);
    slopes += Vec3d{s.gradient.x * s.gradient.x, s.gradient.y * s.gradient.y, s.gradient.z * s.gradient.z};
    product += s.value * GetParam().value(p.x, p.y, p.z, 10u);
  }
  EXPECT_NEAR(slopes.y / slopes.x, 1.0, GetParam().unevenness);
  EXPECT_NEAR(slopes.z / slopes.x, 1.0, GetParam().unevenness);
  const double square = GetParam().deviation * GetParam().deviation;  // of the product
  EXPECT_NEAR(product / n, 0.0, 4 * square / std::sqrt(static_cast<double>(n)));
}

// Perlin's sixteen choices of a gradient prefer y a little.
INSTANTIATE_TEST_SUITE_P(Both, GradientNoises,
                         ::testing::Values(GradientNoise{"Perlin", perlin_noise, perlin_with_gradient, 0.2605,
                                                         0.85, 3.65f, 3e-5f, 0.0, 1.5e-3, 0.2},
                                           GradientNoise{"Simplex", simplex_noise, simplex_with_gradient,
                                                         0.392, 0.9, 8.0f, 5e-5f, 1e-6, 1e-2, 0.15}),
                         [](const auto& noise) { return noise.param.name; });

TEST(PerlinNoise, IsZeroAtLatticePoints) {
  for (const float x : {-2.0f, 0.0f, 5.0f}) EXPECT_EQ(perlin_noise(x, 1.0f, -7.0f, 3u), 0.0f);
}

// Corners of the skewed lattice lie at i - (i + j + k)/6.
TEST(SimplexNoise, IsZeroAtLatticeCorners) {
  EXPECT_EQ(simplex_noise(0.0f, 0.0f, 0.0f, 5u), 0.0f);
  EXPECT_NEAR(simplex_noise(5.0f / 6, -1.0f / 6, -1.0f / 6, 5u), 0.0f, 1e-5f);
  EXPECT_NEAR(simplex_noise(-1.0f, 1.0f, 0.0f, 5u), 0.0f, 1e-5f);
}

}  // namespace
}  // namespace astrolith
