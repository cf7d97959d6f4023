#include <array>
#include <complex>
#include <cstdio>
#include <vector>

#include "numerics/scalar_math.h"
#include "synthesis/noise/phasor_noise.h"
#include "synthesis/noise/random_phase_noise.h"
#include "tests/support/points.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/lone_noise.h"

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

const Box kPhaseDomain{{-100, -100, -100}, {100, 100, 100}};

RandomPhaseLayer phase_layer(double randomness) {
  RandomPhaseLayer layer;
  layer.height_rms = 0.5;
  layer.cell_size = 2.0;
  layer.waves = 12;
  layer.frequency_min = 1.5;
  layer.frequency_max = 3.0;
  layer.randomness = randomness;
  return layer;
}

std::span<const Wave> find_waves(const LoneNoise<RandomPhaseNoise>& noise) {
  return noise.arrays().span(noise.noise().waves);
}

float height_at(const LoneNoise<RandomPhaseNoise>& noise, const Vec3d& p) {
  const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
  float height = 0.0f;
  noise.evaluate(1, &x, &y, &z, &height);
  return height;
}

// Mean and variance are as stated at a lattice point, in the middle of a cell and elsewhere, for any
// randomness.
TEST(RandomPhaseNoise, HasItsMeanAndVarianceEverywhere) {
  for (const double randomness : {0.0, 0.6, 1.0}) {
    for (const Vec3d& p : {Vec3d{2, 4, -6}, Vec3d{1, 3, 5}, Vec3d{0.3, 7.7, -1.2}}) {
      double sum = 0.0, squares = 0.0, fourth = 0.0;
      constexpr int kSeeds = 4000;
      for (int seed = 0; seed < kSeeds; ++seed) {
        const LoneNoise<RandomPhaseNoise> noise(phase_layer(randomness), static_cast<std::uint64_t>(seed), 0,
                                                kPhaseDomain);
        const double h = height_at(noise, p) / 0.5;
        sum += h;
        squares += h * h;
        fourth += h * h * h * h;
        ASSERT_LE(std::fabs(h), 6.0);
      }
      EXPECT_NEAR(sum / kSeeds, 0.0, 4.0 / std::sqrt(kSeeds));
      const double variance = squares / kSeeds;
      const double error = std::sqrt((fourth / kSeeds - variance * variance) / kSeeds);
      EXPECT_NEAR(variance, 1.0, 4.0 * error) << randomness;
    }
  }
}

// All waves run along x. A line along x shows their spectrum, widened by the spectrum of the windows.
TEST(RandomPhaseNoise, PowerLiesInItsBandAndIsFlatThere) {
  RandomPhaseLayer layer = phase_layer(1.0);
  layer.waves = 48;
  layer.spread = 0.0;
  layer.direction = {2, 0, 0};
  constexpr int kSamples = 1024, kSeeds = 60;
  constexpr double kStep = 1.0 / 16, kResolution = 1.0 / (kSamples * kStep);  // 8 cycles up to Nyquist
  std::vector<double> power(kSamples / 2);
  std::vector<float> x(kSamples), y(kSamples), z(kSamples), height(kSamples);
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const LoneNoise<RandomPhaseNoise> noise(layer, seed, 3, kPhaseDomain);
    for (std::size_t i = 0; i < kSamples; ++i) {
      x[i] = static_cast<float>(kStep * (static_cast<double>(i) - 512.0));
      y[i] = z[i] = 0.37f;
    }
    noise.evaluate(kSamples, x.data(), y.data(), z.data(), height.data());
    for (std::size_t k = 8; k < power.size(); k += 4) {
      std::complex<double> sum = 0.0;
      for (std::size_t i = 0; i < kSamples; ++i) {
        const double turns = static_cast<double>(k * i % kSamples) / kSamples;
        sum += double{height[i]} *
               std::pow(math::sin_turns(0.5 * (static_cast<double>(i) + 0.5) / kSamples), 2) *
               std::complex<double>(math::cos_turns(turns), math::sin_turns(turns));
      }
      power[k] += std::norm(sum);
    }
  }
  double total = 0.0, in_band = 0.0, lower_half = 0.0, upper_half = 0.0;
  for (std::size_t k = 8; k < power.size(); k += 4) {
    const double f = static_cast<double>(k) * kResolution;
    total += power[k];
    in_band += f > 1.5 - 0.5 && f < 3.0 + 0.5 ? power[k] : 0.0;
    lower_half += f > 1.5 && f < 2.25 ? power[k] : 0.0;
    upper_half += f > 2.25 && f < 3.0 ? power[k] : 0.0;
  }
  std::printf("power within the band and half a cell's frequency: %.4f; halves of the band: %.3f\n",
              in_band / total, lower_half / upper_half);
  EXPECT_GT(in_band / total, 0.97);
  EXPECT_NEAR(lower_half / upper_half, 1.0, 0.15);
}

TEST(RandomPhaseNoise, WithoutRandomnessWavesRunThroughAllCells) {
  RandomPhaseLayer layer = phase_layer(0.0);
  layer.waves = 1;
  const LoneNoise<RandomPhaseNoise> noise(layer, 5, 0, kPhaseDomain);
  const Wave& wave = find_waves(noise)[0];
  CounterRandom random(2);
  // Dividing by the sum of the windows, between 1 and sqrt 8, leaves exactly the wave.
  for (int i = 0; i < 200; ++i) {
    const Vec3d p{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)};
    const double turns =
        dot(Vec3d{wave.frequency.x, wave.frequency.y, wave.frequency.z}, p) + double{wave.phase};
    EXPECT_NEAR(height_at(noise, p), 0.5 * std::sqrt(2.0) * math::cos_turns(turns), 1e-3);
  }
}

TEST(RandomPhaseNoise, ExponentTiltsThePowerAndSpreadHoldsDirections) {
  RandomPhaseLayer layer = phase_layer(1.0);
  layer.exponent = 2.0;
  layer.spread = 0.1;
  layer.direction = {0, -3, 0};
  const LoneNoise<RandomPhaseNoise> noise(layer, 1, 0, kPhaseDomain);
  ASSERT_EQ(find_waves(noise).size(), 12u);
  double variance = 0.0;
  const auto length = [](const Wave& w) { return norm(Vec3d{w.frequency.x, w.frequency.y, w.frequency.z}); };
  const double first = length(find_waves(noise)[0]) * double{find_waves(noise)[0].amplitude};
  for (const Wave& w : find_waves(noise)) {
    EXPECT_NEAR(length(w) * double{w.amplitude}, first, 1e-5);
    EXPECT_GE(-double{w.frequency.y} / length(w), 0.9 - 1e-6);
    variance += 0.5 * double{w.amplitude} * double{w.amplitude};
  }
  EXPECT_NEAR(variance, 0.25, 1e-6);
}

}  // namespace
}  // namespace astrolith
