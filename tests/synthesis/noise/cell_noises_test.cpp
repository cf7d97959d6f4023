#include <algorithm>
#include <cmath>
#include <vector>

#include "synthesis/noise/block_noise.h"
#include "synthesis/noise/sparse_noise.h"
#include "synthesis/noise/worley_noise.h"
#include "tests/support/points.h"
#include "tests/synthesis/lone_noise.h"
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
  expect(testing::noise_statistics(worley_f1, n), f1, 0.149);
  expect(testing::noise_statistics(worley_f2, n), f2, 0.119);
  expect(testing::noise_statistics(worley_f2_minus_f1, n), f2 - f1, 0.148);
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

TEST(BlockNoise, IsTheDepthInTheDeepestOfAllBlocks) {
  CounterRandom random(3);
  for (int i = 0; i < 10000; ++i) {
    const Vec3f p = random_place(random, 100.0);
    const float x = std::floor(p.x), y = std::floor(p.y), z = std::floor(p.z);
    constexpr float kOffset = 1.5f * kWorleyJitter - 0.5f;
    float deepest = 0.0f;
    for (int c = 0; c < 125; ++c) {
      const float a = static_cast<float>(c % 5 - 2), b = static_cast<float>(c / 5 % 5 - 2),
                  e = static_cast<float>(c / 25 - 2);
      deepest = std::max(deepest, block_depth(lattice_point(x + a, y + b, z + e, 8u), p.x - x + kOffset - a,
                                              p.y - y + kOffset - b, p.z - z + kOffset - e));
    }
    ASSERT_EQ(block_noise(p.x, p.y, p.z, 8u), deepest);
  }
}

TEST(BlockNoise, CoversTheStatedShareWithTheStatedMean) {
  constexpr int n = 400000;
  int within = 0;
  const testing::NoiseStatistics s = testing::noise_statistics(
      [&](float x, float y, float z, std::uint32_t seed) {
        const float depth = block_noise(x, y, z, seed);
        within += depth > 0.0f;
        return depth;
      },
      n);
  EXPECT_EQ(s.least, 0.0);
  EXPECT_GT(s.greatest, 0.95);
  EXPECT_LE(s.greatest, 1.0);
  EXPECT_NEAR(s.mean, kBlockMean, 0.001);
  EXPECT_NEAR(s.deviation, kBlockDeviation, 0.001);
  EXPECT_NEAR(static_cast<double>(within) / n, kBlockCover, 0.002);
}

TEST(BlockNoise, IsNowhereSteeperThanTheNearestFaces) {
  CounterRandom random(4);
  double steepest = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3f p = random_place(random, 4.0), q = p + random_place(random, 0.01);
    const double change = std::fabs(block_noise(q.x, q.y, q.z, 1u) - block_noise(p.x, p.y, p.z, 1u));
    steepest = std::max(steepest, (change - 1e-6) / static_cast<double>(norm(q - p)));
  }
  EXPECT_LE(steepest, static_cast<double>(kBlockHeight));
  EXPECT_GT(steepest, 0.9 * static_cast<double>(kBlockHeight));
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

const Box kSparseDomain{{-50, -50, -50}, {50, 50, 50}};

SparseLayer one_level(double probability) {
  SparseLayer layer;
  layer.amplitude = 1.0;
  layer.levels = 1;
  layer.probability = probability;
  layer.threshold = 0.0;
  return layer;
}

float height_at(const LoneNoise<SparseNoise>& noise, float x, float y, float z) {
  float h = 0.0f;
  noise.evaluate(1, &x, &y, &z, &h);
  return h;
}

// The method in one dimension: doubling an image eight times by quadratic interpolation (the corner-cutting
// rule 3/4, 1/4) gives the bump that the noise evaluates directly.
TEST(SparseNoise, RepeatedUpscalingConvergesToTheBump) {
  std::vector<double> image(9, 0.0);
  image[4] = 1.0;
  double first = 0.0, step = 1.0;  // position of the first pixel relative to the lone one; pixel spacing
  first = -4.0;
  for (int doubling = 0; doubling < 8; ++doubling) {
    std::vector<double> finer;
    for (std::size_t i = 0; i + 1 < image.size(); ++i) {
      finer.push_back(0.75 * image[i] + 0.25 * image[i + 1]);
      finer.push_back(0.25 * image[i] + 0.75 * image[i + 1]);
    }
    first += 0.25 * step;
    step *= 0.5;
    image = finer;
  }
  double worst = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const double x = first + step * static_cast<double>(i), cell = std::floor(x + 0.5);
    if (std::fabs(x) > 1.5) {
      ASSERT_EQ(image[i], 0.0);
      continue;
    }
    const BumpWeights w = bump_weights(static_cast<float>(x - cell));
    const float bump = cell == 0.0 ? w.at : cell > 0.0 ? w.below : w.above;
    worst = std::max(worst, std::fabs(static_cast<double>(bump) - image[i]));
  }
  EXPECT_LT(worst, 0.01);
}

TEST(SparseNoise, ShareOfCellsIsTheProbability) {
  int hit = 0;
  double sum = 0.0;
  const int n = 40;
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) {
      for (int z = 0; z < n; ++z) {
        const float v = sparse_value(float(x), float(y), float(z), 77u, 0.03f, 1.0f / 0.03f);
        hit += v > 0.0f;
        sum += double{v};
      }
    }
  }
  const double cells = n * n * n;
  EXPECT_NEAR(hit, 0.03 * cells, 4.0 * std::sqrt(0.03 * cells));
  EXPECT_NEAR(sum / hit, 0.5, 4.0 / std::sqrt(12.0 * hit));
}

// All cells are occupied by u in [0, 1). The mean of n is the mean of the values, since bumps add up to one.
TEST(SparseNoise, BumpsAddUpToOne) {
  const LoneNoise<SparseNoise> noise(one_level(1.0), 5, 0, kSparseDomain);
  CounterRandom random(2);
  double sum = 0.0;
  const int n = 4000;
  for (int i = 0; i < n; ++i) {
    const auto c = [&] { return static_cast<float>(random.uniform(-40, 40)); };
    sum -= double{height_at(noise, c(), c(), c())};
  }
  EXPECT_NEAR(sum / n, 0.5 * 64.0 / 27.0, 0.03);
}

TEST(SparseNoise, ThresholdCutsMostOfTheSurfaceFlat) {
  SparseLayer layer = one_level(0.02);
  layer.levels = 3;
  for (const bool merged : {false, true}) {
    layer.merged = merged;
    layer.threshold = 0.3;
    const LoneNoise<SparseNoise> noise(layer, 5, 0, kSparseDomain);
    CounterRandom random(3);
    int flat = 0;
    for (int i = 0; i < 2000; ++i) {
      const auto c = [&] { return static_cast<float>(random.uniform(-40, 40)); };
      const float h = height_at(noise, c(), c(), c());
      ASSERT_LE(h, 0.0f);
      flat += h == 0.0f;
    }
    EXPECT_GT(flat, 1700);
    EXPECT_LT(flat, 1999);
  }
}

TEST(SparseNoise, BoundsOverBoxesAreNeverWrongAndGroupsDoNotMatter) {
  CounterRandom random(7);
  int tight = 0;
  for (int k = 0; k < 300; ++k) {
    SparseLayer layer = one_level(random.uniform(0.0, 0.3));
    layer.amplitude = random.uniform(-1.0, 1.0);
    layer.cell_size = std::pow(10.0, random.uniform(-1.0, 1.0));
    layer.levels = 1 + static_cast<int>(random.below(4));
    layer.threshold = random.uniform();
    layer.merged = random.uniform() < 0.5;
    const LoneNoise<SparseNoise> noise(layer, random.next(), 1, kSparseDomain);
    const double size = layer.cell_size * std::pow(10.0, random.uniform(-2.0, 1.0));
    const Vec3d corner{random.uniform(-52, 50), random.uniform(-20, 20), random.uniform(-20, 20)};
    const Box box{corner, corner + Vec3d{size, size * random.uniform(0.2, 1.0), size}};
    const Interval bound = noise.bound_heights(box);
    std::vector<float> h(64);
    const auto [x, y, z] = testing::FloatPoints(random, box, h.size());
    noise.evaluate(64, x.data(), y.data(), z.data(), h.data());
    for (std::size_t i = 0; i < h.size(); ++i) {
      ASSERT_GE(double{h[i]}, bound.low);
      ASSERT_LE(double{h[i]}, bound.high);
      ASSERT_LE(double{std::fabs(h[i])}, noise.height_bound());
      if (i % 9 == 0) {
        ASSERT_EQ(h[i], height_at(noise, x[i], y[i], z[i]));
      }
    }
    tight += bound.high - bound.low < 0.3 * noise.height_bound();
  }
  EXPECT_GT(tight, 80);
}

}  // namespace
}  // namespace astrolith
