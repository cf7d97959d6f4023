#include "synthesis/noise/worley_noise.h"

#include <algorithm>
#include <vector>

#include "tests/synthesis/noise_sampling.h"

namespace astrolith {
namespace {

using testing::random_place;

// The two smallest squared distances to feature points, searched in 5^3 cells.
WorleyDistances searched_widely(const Vec3f& p, std::uint32_t seed) {
  const float i = std::floor(p.x), j = std::floor(p.y), k = std::floor(p.z);
  constexpr float kOffset = 1.5f * kWorleyJitter - 0.5f, kLimit = kWorleyFarthest * kWorleyFarthest;
  std::vector<float> distances{kLimit, kLimit};
  for (int c = 0; c < 125; ++c) {
    const float a = static_cast<float>(c % 5 - 2), b = static_cast<float>(c / 5 % 5 - 2),
                e = static_cast<float>(c / 25 - 2);
    distances.push_back(feature_distance(lattice_point(i + a, j + b, k + e, seed), p.x - i + kOffset - a,
                                         p.y - j + kOffset - b, p.z - k + kOffset - e));
  }
  std::sort(distances.begin(), distances.end());
  return {distances[0], distances[1]};
}

TEST(WorleyNoise, FindsTheTwoNearestOfAllFeaturePoints) {
  CounterRandom random(3);
  for (int i = 0; i < 30000; ++i) {
    const Vec3f p = random_place(random, 100.0);
    const WorleyDistances wide = searched_widely(p, 8u);
    const WorleyDistances found = worley_distances<true>(p.x, p.y, p.z, 8u);
    ASSERT_EQ(found.nearest, wide.nearest);
    ASSERT_EQ(found.second, wide.second);
    ASSERT_EQ(worley_distances<false>(p.x, p.y, p.z, 8u).nearest, wide.nearest);
  }
}

TEST(WorleyNoise, HasTheStatedRangesMeansAndDeviations) {
  constexpr int n = 400000;
  const auto expect = [](const testing::NoiseStatistics& s, double mean, double deviation) {
    EXPECT_GE(s.least, -mean);
    EXPECT_LE(s.greatest, 1.0 - mean);
    EXPECT_NEAR(s.mean, 0.0, 6 * deviation / std::sqrt(static_cast<double>(n)));
    EXPECT_NEAR(s.deviation, deviation, 0.001);
  };
  const double f1 = kWorleyMeanF1, f2 = kWorleyMeanF2;
  expect(testing::statistics_of(worley_f1, n), f1, 0.149);
  expect(testing::statistics_of(worley_f2, n), f2, 0.119);
  expect(testing::statistics_of(worley_f2_minus_f1, n), f2 - f1, 0.148);
}

TEST(WorleyNoise, ChangesNoFasterThanDistances) {
  CounterRandom random(4);
  for (int i = 0; i < 100000; ++i) {
    const Vec3f p = random_place(random, 4.0), step = random_place(random, 0.01);
    const Vec3f q = p + step;
    const float way = norm(step) / kWorleyFarthest + 1e-6f;
    ASSERT_LE(std::fabs(worley_f1(q.x, q.y, q.z, 1u) - worley_f1(p.x, p.y, p.z, 1u)), way);
    ASSERT_LE(std::fabs(worley_f2(q.x, q.y, q.z, 1u) - worley_f2(p.x, p.y, p.z, 1u)), way);
  }
}

// Feature points of neighbouring cells are independent, so that the noise prefers no direction but the axes
// of its grid.
TEST(WorleyNoise, HasNoPreferredAxis) {
  CounterRandom random(6);
  Vec3d slopes;
  const float h = 0.01f;
  for (int i = 0; i < 200000; ++i) {
    const Vec3f p = random_place(random, 200.0);
    const float v = worley_f1(p.x, p.y, p.z, 9u);
    const float dx = worley_f1(p.x + h, p.y, p.z, 9u) - v, dy = worley_f1(p.x, p.y + h, p.z, 9u) - v,
                dz = worley_f1(p.x, p.y, p.z + h, 9u) - v;
    slopes += Vec3d{dx * dx, dy * dy, dz * dz};
  }
  EXPECT_NEAR(slopes.y / slopes.x, 1.0, 0.03);
  EXPECT_NEAR(slopes.z / slopes.x, 1.0, 0.03);
}

}  // namespace
}  // namespace astrolith
