#include "synthesis/noise/fractal_noise.h"
#include "tests/synthesis/lone_noise.h"

#include <cmath>
#include <utility>
#include <vector>

#include "synthesis/noise/perlin_noise.h"
#include "synthesis/noise/simplex_noise.h"
#include "synthesis/noise/worley_noise.h"
#include "tests/support/points.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/noise_sampling.h"

namespace astrolith {
namespace {

constexpr Noise kNoises[] = {Noise::kSimplex, Noise::kPerlin, Noise::kWorleyF1, Noise::kWorleyF2,
                             Noise::kWorleyF2MinusF1};
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
  layer.noise = kNoises[random.below(5)];
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
  for (const float v : h.height) checksum = checksum * 31u + static_cast<std::uint32_t>(math::bits_of(v));
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
                                                       {Noise::kWorleyF2MinusF1, worley_f2_minus_f1}};
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

}  // namespace
}  // namespace astrolith
