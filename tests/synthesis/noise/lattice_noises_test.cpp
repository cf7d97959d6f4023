#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "synthesis/noise/coordinate_warp.h"
#include "synthesis/noise/fractal_noise.h"
#include "synthesis/noise/lattice_noise.h"
#include "synthesis/noise/perlin_noise.h"
#include "synthesis/noise/simplex_noise.h"
#include "synthesis/noise/worley_noise.h"
#include "tests/support/points.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/lone_noise.h"
#include "tests/synthesis/noise_sampling.h"

namespace astrolith {
namespace {

// chi^2 of the joint histogram of four bits at neighbouring lattice points, minus its mean, in its standard
// deviations.
template <typename Hash>
double neighbour_dependence(const Hash& hash, int dx, int dy, int dz, int shift) {
  std::array<double, 256> count{};
  constexpr std::uint32_t kSide = 32;
  const std::uint32_t step = static_cast<std::uint32_t>(dx) * kLatticeX +
                             static_cast<std::uint32_t>(dy) * kLatticeY +
                             static_cast<std::uint32_t>(dz) * kLatticeZ;
  for (std::uint32_t i = 0; i < kSide * kSide * kSide; ++i) {
    const std::uint32_t point =
        99u + (i % kSide) * kLatticeX + (i / kSide % kSide) * kLatticeY + i / (kSide * kSide) * kLatticeZ;
    ++count[(hash(point) >> shift & 15) * 16 + (hash(point + step) >> shift & 15)];
  }
  const double expected = kSide * kSide * kSide / 256.0;
  double chi_squared = 0.0;
  for (const double c : count) chi_squared += (c - expected) * (c - expected) / expected;
  return (chi_squared - 255.0) / std::sqrt(2.0 * 255.0);
}

template <typename Hash>
double worst_dependence(const Hash& hash, int shift) {
  double worst = 0.0;
  for (int d = 0; d < 125; ++d) {
    if (d == 62) continue;  // the point itself
    worst = std::max(worst, neighbour_dependence(hash, d % 5 - 2, d / 5 % 5 - 2, d / 25 - 2, shift));
  }
  return worst;
}

TEST(LatticeNoise, NeighboursHashesAreIndependent) {
  EXPECT_LT(worst_dependence(lattice_hash, 28), 5.0);
  EXPECT_LT(worst_dependence(short_lattice_hash, 28), 5.0);
  // The bit fields of the three coordinates of a feature point: bits 9 to 31, 0 to 22 and 0 to 12.
  const auto mixed = [](std::uint32_t point) {
    const std::uint32_t h = short_lattice_hash(point);
    return h ^ (h >> 15);
  };
  for (const int shift : {28, 19, 9}) EXPECT_LT(worst_dependence(mixed, shift), 5.0) << shift;
}

TEST(LatticeNoise, GradientsAreTheTwelveEdgesOfACube) {
  for (std::uint32_t g = 0; g < 16; ++g) {
    const Vec3f v = lattice_gradient(g << 28);
    EXPECT_EQ(dot(v, v), 2.0f);
    EXPECT_EQ(std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z), 2.0f);
    EXPECT_EQ(gradient_product(g << 28, 0.5f, -3.0f, 8.0f), 0.5f * v.x - 3.0f * v.y + 8.0f * v.z);
  }
}

// Perlin and simplex noise.

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
  const testing::NoiseStatistics s = testing::noise_statistics(GetParam().value, 1000000);
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

constexpr Noise kNoises[] = {Noise::kSimplex,  Noise::kPerlin,          Noise::kWorleyF1,
                             Noise::kWorleyF2, Noise::kWorleyF2MinusF1, Noise::kWorleyBlocks};
const Box kFractalDomain{{-10, -10, -10}, {10, 10, 10}};

struct Heights : testing::FloatPoints {
  Heights(const LoneNoise<FractalNoise>& noise, const Box& box, int n, std::uint64_t seed)
      : height(static_cast<std::size_t>(n)) {
    CounterRandom random(seed);
    for (int i = 0; i < n; ++i) add(testing::random_point(random, box));
    noise.evaluate(n, x.data(), y.data(), z.data(), height.data());
  }

  std::vector<float> height;
};

FractalLayer random_layer(CounterRandom& random) {
  FractalLayer layer = testing::fractal_layer(random.uniform(-2, 2), random.uniform(0.1, 4),
                                              1 + static_cast<int>(random.below(6)));
  layer.noise = kNoises[random.below(std::size(kNoises))];
  layer.gain = random.uniform(0.2, 1.2);
  layer.scale = {random.uniform(-2, 2), 1.0, random.uniform(0.5, 1.5)};
  layer.bias = {random.uniform(-3, 3), 0.0, 1.0};
  if (!is_worley(layer.noise) && random.uniform() < 0.5) layer.gradient_modulation = random.uniform(0.0, 2.0);
  if (random.uniform() < 0.5) layer.warp = Warp{random.uniform(-1, 1), random.uniform(0.1, 2), 2, 0.5, 2.0};
  return layer;
}

TEST(FractalNoise, OneOctaveOfSimplexNoiseKeepsItsBits) {
  const LoneNoise<FractalNoise> noise(testing::fractal_layer(0.5, 1.0, 1), 1, 0, kFractalDomain);
  const Heights h(noise, kFractalDomain, 4096, 1);
  std::uint32_t checksum = 0;
  for (const float v : h.height) checksum = checksum * 31u + static_cast<std::uint32_t>(math::to_bits(v));
  EXPECT_EQ(checksum, 2811787874u);
}

// Compares the loops, which use the widest vectors of this machine, with calls that the compiler leaves
// scalar.
TEST(FractalNoise, VectorsGiveTheBitsOfSinglePoints) {
  using Function = float (*)(float, float, float, std::uint32_t);
  constexpr std::pair<Noise, Function> kFunctions[] = {{Noise::kSimplex, simplex_noise},
                                                       {Noise::kPerlin, perlin_noise},
                                                       {Noise::kWorleyF1, worley_f1},
                                                       {Noise::kWorleyF2, worley_f2},
                                                       {Noise::kWorleyF2MinusF1, worley_f2_minus_f1},
                                                       {Noise::kWorleyBlocks, block_noise}};
  for (const auto& [noise, function] : kFunctions) {
    FractalLayer layer = testing::fractal_layer(1.0, 1.0, 1);
    layer.noise = noise;
    const Heights h(LoneNoise<FractalNoise>(layer, 4, 0, kFractalDomain), kFractalDomain, 5000, 1);
    const std::uint32_t seed = hash_append(hash_seed(4, 0), 0);
    for (std::size_t i = 0; i < h.x.size(); ++i) {
      ASSERT_EQ(h.height[i], function(h.x[i], h.y[i], h.z[i], seed));
    }
  }
}

TEST(FractalNoise, IsTheSumOfItsOctaves) {
  FractalLayer layer = testing::fractal_layer(0.8, 1.3, 3);
  layer.gain = 0.4;
  const LoneNoise<FractalNoise> noise(layer, 5, 2, kFractalDomain);
  const Heights h(noise, kFractalDomain, 500, 2);
  const std::uint32_t seed = hash_seed(5, 2);
  for (std::size_t i = 0; i < h.x.size(); ++i) {
    double sum = 0.0;
    for (int o = 0; o < 3; ++o) {
      const auto f = static_cast<float>(1.3 * std::pow(1.95, o));
      sum += 0.8 * std::pow(0.4, o) *
             static_cast<double>(simplex_noise(f * h.x[i], f * h.y[i], f * h.z[i],
                                               hash_append(seed, static_cast<std::uint32_t>(o))));
    }
    ASSERT_NEAR(static_cast<double>(h.height[i]), sum, 1e-5);
  }
}

TEST(FractalNoise, ModulationSubduesSteepPlaces) {
  FractalLayer layer = testing::fractal_layer(1.0, 1.0, 6);
  const Heights plain(LoneNoise<FractalNoise>(layer, 1, 0, kFractalDomain), kFractalDomain, 5000, 4);
  layer.gradient_modulation = 1e-9;
  const Heights same(LoneNoise<FractalNoise>(layer, 1, 0, kFractalDomain), kFractalDomain, 5000, 4);
  layer.gradient_modulation = 0.3;
  const Heights subdued(LoneNoise<FractalNoise>(layer, 1, 0, kFractalDomain), kFractalDomain, 5000, 4);
  double plain_squares = 0.0, subdued_squares = 0.0;
  for (std::size_t i = 0; i < plain.height.size(); ++i) {
    ASSERT_NEAR(plain.height[i], same.height[i], 1e-5);
    plain_squares += static_cast<double>(plain.height[i] * plain.height[i]);
    subdued_squares += static_cast<double>(subdued.height[i] * subdued.height[i]);
  }
  EXPECT_LT(subdued_squares, 0.6 * plain_squares);
  EXPECT_GT(subdued_squares, 0.01 * plain_squares);
}

TEST(FractalNoise, BoundsOverBoxesAreNeverWrong) {
  CounterRandom random(7);
  int tight = 0;
  for (int k = 0; k < 3000; ++k) {
    const LoneNoise<FractalNoise> noise(random_layer(random), random.next(), 1, kFractalDomain);
    const double size = std::pow(10.0, random.uniform(-3.0, 0.5));
    const Vec3d corner{random.uniform(-11, 10), random.uniform(-11, 10), random.uniform(-11, 10)};
    const Box box{corner, corner + Vec3d{size, size * random.uniform(0.2, 1.0), size}};
    const Interval bound = noise.bound_heights(box);
    const Heights h(noise, box, 100, random.next());
    for (const float v : h.height) {
      ASSERT_GE(static_cast<double>(v), bound.low);
      ASSERT_LE(static_cast<double>(v), bound.high);
      ASSERT_LE(std::fabs(static_cast<double>(v)), noise.height_bound());
    }
    tight += bound.high - bound.low < noise.height_bound();
  }
  EXPECT_GT(tight, 800);
}

const Box kWarpDomain{{-4, -4, -4}, {4, 4, 4}};

struct LoneWarp {
  LoneWarp(const Warp& warp, std::uint32_t seed)
      : tables(make_coordinate_warp(warp, seed, kWarpDomain, arrays)) {}

  ArrayStore arrays;
  CoordinateWarp tables;
};

Vec3d warped(const LoneWarp& warp, const Vec3f& p) {
  Vec3f w;
  warp_points(warp.tables, warp.arrays.view(), 1, &p.x, &p.y, &p.z, &w.x, &w.y, &w.z);
  const Vec3f alone = warped(warp.tables, warp.arrays.view(), p);
  EXPECT_EQ(w, alone);
  return {w.x, w.y, w.z};
}

Vec3d to_double(const Vec3f& p) { return {p.x, p.y, p.z}; }

TEST(CoordinateWarp, DisplacesEachAxisOnItsOwnWithinItsBound) {
  const LoneWarp warp({0.5, 1.5, 3, 0.5, 2.0}, 7u);
  EXPECT_NEAR(warp.tables.bound, 0.875, 1e-3);
  CounterRandom random(1);
  double xx = 0.0, xy = 0.0, xz = 0.0;
  constexpr int n = 50000;
  for (int i = 0; i < n; ++i) {
    const Vec3f p = testing::random_place(random, 4.0);
    const Vec3d d = warped(warp, p) - to_double(p);
    ASSERT_LE(std::fabs(d.x), warp.tables.bound);
    ASSERT_LE(std::fabs(d.y), warp.tables.bound);
    ASSERT_LE(std::fabs(d.z), warp.tables.bound);
    xx += d.x * d.x / n;
    xy += d.x * d.y / n;
    xz += d.x * d.z / n;
  }
  EXPECT_NEAR(std::sqrt(xx), 0.5 * 0.389 * std::sqrt(1 + 0.25 + 0.0625), 0.02);
  EXPECT_NEAR(xy / xx, 0.0, 0.1);
  EXPECT_NEAR(xz / xx, 0.0, 0.1);
}

TEST(CoordinateWarp, EveryOctaveOfEveryAxisHasASeedOfItsOwn) {
  const LoneWarp warp({0.5, 1.5, 4, 0.5, 2.0}, 7u);
  std::set<std::uint32_t> seeds;
  for (const ArrayRange<NoiseOctave>& octaves : warp.tables.octaves) {
    for (const NoiseOctave& o : warp.arrays.view().span(octaves)) seeds.insert(o.seed);
  }
  EXPECT_EQ(seeds.size(), 12u);
}

TEST(CoordinateWarp, ImagesOfBoxesHoldTheirPoints) {
  CounterRandom random(2);
  int tight = 0;
  for (int k = 0; k < 2000; ++k) {
    const LoneWarp warp({random.uniform(-1, 1), random.uniform(0.1, 3), 1 + k % 4, 0.5, 2.0},
                        static_cast<std::uint32_t>(random.next()));
    const double size = std::pow(10.0, random.uniform(-3.0, 0.3));
    const Vec3d corner = to_double(testing::random_place(random, 6.0));  // some lie outside
    const Box box{corner, corner + Vec3d{size, size, size}};
    const Box image = warped_box(warp.tables, warp.arrays.view(), box);
    for (int i = 0; i < 50; ++i) {
      const Vec3d p = warped(warp, to_float(testing::random_point(random, box)));
      ASSERT_TRUE(p.x >= image.min.x && p.y >= image.min.y && p.z >= image.min.z);
      ASSERT_TRUE(p.x <= image.max.x && p.y <= image.max.y && p.z <= image.max.z);
    }
    tight += image.extent().x < size + warp.tables.bound;
  }
  EXPECT_GT(tight, 500);
}

TEST(CoordinateWarp, KeepsItsLipschitzBound) {
  const LoneWarp warp({0.5, 1.5, 3, 0.5, 2.0}, 7u);
  CounterRandom random(3);
  for (int i = 0; i < 50000; ++i) {
    const Vec3f p = testing::random_place(random, 4.0), q = p + testing::random_place(random, 0.05);
    ASSERT_LE(norm(warped(warp, p) - warped(warp, q)),
              warp.tables.lipschitz_bound * norm(to_double(p) - to_double(q)) + 1e-5);
  }
}

}  // namespace
}  // namespace astrolith
