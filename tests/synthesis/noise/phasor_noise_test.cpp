#include "synthesis/noise/phasor_noise.h"
#include "tests/synthesis/lone_noise.h"

#include <array>
#include <vector>

#include "numerics/scalar_math.h"
#include "tests/support/points.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

const Box kPhasorDomain{{-100, -100, -100}, {100, 100, 100}};

PhasorLayer phasor_layer(PhasorProfile profile) {
  PhasorLayer layer;
  layer.amplitude = 2.0;
  layer.frequency = 2.0;
  layer.cell_size = 1.5;
  layer.profile = profile;
  return layer;
}

testing::FloatPoints scattered(std::size_t n) {
  CounterRandom random(3);
  return {random, testing::cube_about_origin(90), n};
}

TEST(PhasorNoise, PhasesAreUniform) {
  const auto [x, y, z] = scattered(40000);
  std::vector<float> turns(x.size());
  const LoneNoise<PhasorNoise> noise(phasor_layer(PhasorProfile::kSine), 1, 0, kPhasorDomain);
  evaluate_phases(noise.noise(), 40000, x.data(), y.data(), z.data(), turns.data());
  std::array<int, 16> count{};
  for (const float t : turns) {
    ASSERT_TRUE(t >= -0.5f && t <= 0.5f);
    ++count[std::min<std::size_t>(15, static_cast<std::size_t>(16.0f * (t + 0.5f)))];
  }
  double chi_squared = 0.0;
  for (const int c : count) chi_squared += (c - 2500.0) * (c - 2500.0) / 2500.0;
  EXPECT_LT(chi_squared, 37.7);  // 15 degrees of freedom, one in a thousand
}

TEST(PhasorNoise, ProfilesHaveTheirMeanVarianceAndRange) {
  const auto [x, y, z] = scattered(40000);
  const double variances[] = {0.5, 1.0 / 3.0, 1.0 / 3.0, 1.0};
  for (const PhasorProfile profile : kPhasorProfiles) {
    const LoneNoise<PhasorNoise> noise(phasor_layer(profile), 2, 0, kPhasorDomain);
    std::vector<float> height(x.size());
    noise.evaluate(40000, x.data(), y.data(), z.data(), height.data());
    double sum = 0.0, squares = 0.0;
    for (const float h : height) {
      ASSERT_LE(std::fabs(double{h}), noise.height_bound());
      sum += double{h} / 2.0;
      squares += double{h} * double{h} / 4.0;
    }
    EXPECT_NEAR(sum / 40000, 0.0, 0.02) << profile_word(profile);
    EXPECT_NEAR(squares / 40000, variances[static_cast<int>(profile)], 0.015) << profile_word(profile);
  }
}

// The phase gains `frequency` turns per length unit along the direction of the kernels, and none across it.
TEST(PhasorNoise, OscillatesAtItsFrequencyAlongItsDirection) {
  PhasorLayer layer = phasor_layer(PhasorProfile::kSine);
  layer.direction = {0, 3, 4};
  layer.spread = 0.0;
  const LoneNoise<PhasorNoise> noise(layer, 4, 0, kPhasorDomain);
  const auto gain = [&](const Vec3d& u) {
    const double h = 0.01;
    double sum = 0.0;
    const testing::FloatPoints p = scattered(4000);
    for (std::size_t i = 0; i < p.x.size(); ++i) {
      std::array<float, 2> x, y, z, turns;
      for (std::size_t k = 0; k < 2; ++k) {
        x[k] = p.x[i] + static_cast<float>(h * static_cast<double>(k) * u.x);
        y[k] = p.y[i] + static_cast<float>(h * static_cast<double>(k) * u.y);
        z[k] = p.z[i] + static_cast<float>(h * static_cast<double>(k) * u.z);
      }
      evaluate_phases(noise.noise(), 2, x.data(), y.data(), z.data(), turns.data());
      const double step = double{turns[1]} - double{turns[0]};
      sum += step - std::round(step);
    }
    return sum / (static_cast<double>(p.x.size()) * h);
  };
  EXPECT_NEAR(gain({0, 0.6, 0.8}), 2.0, 0.1);
  EXPECT_NEAR(gain({1, 0, 0}), 0.0, 0.1);
}

// Phasor noise with a sine profile reaches its full height in every wavelength. Gabor noise does not.
TEST(PhasorNoise, ContrastNeverFades) {
  const LoneNoise<PhasorNoise> noise(phasor_layer(PhasorProfile::kSine), 6, 0, kPhasorDomain);
  int full = 0, stretches = 0;
  for (double start = -90.0; start < 90.0; start += 0.6) {
    float highest = -2.0f, lowest = 2.0f;
    for (double t = 0.0; t < 0.6; t += 0.02) {
      const float x = static_cast<float>(start + t), y = 0.2f, z = -3.1f;
      float h = 0.0f;
      noise.evaluate(1, &x, &y, &z, &h);
      highest = math::max(highest, h);
      lowest = math::min(lowest, h);
    }
    ++stretches;
    full += highest > 1.9f && lowest < -1.9f;
  }
  EXPECT_GT(full, stretches * 8 / 10);
}

}  // namespace
}  // namespace astrolith
