#include "synthesis/gabor/gabor_texture.h"

#include <cmath>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

GaborLayer texture_layer(std::vector<GaborLobe> lobes, double rms = 1.0) {
  GaborLayer layer;
  layer.height_rms = rms;
  layer.lobes = std::move(lobes);
  return layer;
}

struct Moments {
  double mean, variance, excess_kurtosis;
};

Moments moments(const std::vector<float>& values) {
  double mean = 0, second = 0, fourth = 0;
  for (const float v : values) mean += static_cast<double>(v);
  mean /= static_cast<double>(values.size());
  for (const float v : values) {
    const double d = static_cast<double>(v) - mean;
    second += d * d;
    fourth += d * d * d * d;
  }
  second /= static_cast<double>(values.size());
  fourth /= static_cast<double>(values.size());
  return {mean, second, fourth / (second * second) - 3.0};
}

// A single band, since more bands or more impulses would bring the noise closer to a Gaussian.
TEST(GaborTexture, OneBandOfFewImpulsesIsGaussian) {
  GaborLayer layer = texture_layer({{2, 0.2, 0.1, 1.0}});
  layer.impulses_per_kernel = 4;
  const Moments m = moments(synthesize_texture(layer, 1024, 1024, {9}));
  EXPECT_NEAR(m.variance, 1.0, 0.01);
  EXPECT_NEAR(m.excess_kurtosis, 0.0, 0.05);
}

// Each band alone, at the default number of impulses, over several seeds.
TEST(GaborTexture, EveryBandHasTheStatedDeviationAndIsGaussian) {
  constexpr int kSeeds = 6;
  for (int bandwidth = 1; bandwidth <= 4; ++bandwidth) {
    const GaborLayer layer = texture_layer({{bandwidth, 0.21, -0.13, 1.0}}, 0.5);
    const int side = 64 << bandwidth;  // the same number of kernels for every band
    double second = 0, fourth = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const Moments m = moments(synthesize_texture(layer, side, side, {seed}));
      second += m.variance / kSeeds;
      fourth += (m.excess_kurtosis + 3.0) * m.variance * m.variance / kSeeds;
    }
    EXPECT_NEAR(std::sqrt(second) / 0.5, 1.0, 0.01) << bandwidth;
    EXPECT_NEAR(fourth / (second * second) - 3.0, 0.0, 0.05) << bandwidth;
  }
}

// The autocovariance of lobes is known in closed form: sum of variance exp(-pi a^2 r^2 / 2) cos(2 pi f.r).
// The average over a large texture must equal it at every lag. This checks the spectrum with its signs and
// axes.
TEST(GaborTexture, AutocovarianceIsTheLobes) {
  const std::vector<GaborLobe> lobes = {{3, 0.18, 0.05, 2.0}, {2, -0.1, 0.2, 1.0}, {3, 0.0, 0.0, 1.0}};
  constexpr int n = 1536;
  const std::vector<float> texture = synthesize_texture(texture_layer(lobes), n, n, {17});
  for (int dy = 0; dy <= 6; ++dy) {
    for (int dx = -6; dx <= 6; ++dx) {
      double measured = 0.0, expected = 0.0;
      for (int y = 0; y + dy < n; ++y) {
        for (int x = 8; x + 8 < n; ++x) {
          measured += static_cast<double>(texture[static_cast<std::size_t>(y * n + x)]) *
                      static_cast<double>(texture[static_cast<std::size_t>((y + dy) * n + x + dx)]);
        }
      }
      measured /= double{n - 16} * (n - dy);
      for (const GaborLobe& lobe : lobes) {
        const double a = std::ldexp(std::sqrt(M_PI / (2 * std::log(2.0))), -lobe.bandwidth);
        expected += lobe.variance / 4.0 * std::exp(-M_PI * a * a * (dx * dx + dy * dy) / 2) *
                    std::cos(2 * M_PI * (lobe.frequency_x * dx + lobe.frequency_y * dy));
      }
      EXPECT_NEAR(measured, expected, 0.012) << dx << " " << dy;
    }
  }
}

TEST(GaborTexture, DependsOnLayerAndSeedAlone) {
  GaborLayer layer = texture_layer({{2, 0.1, 0.2, 1.0}, {5, -0.02, 0.05, 2.0}});
  const std::vector<float> one = synthesize_texture(layer, 333, 201, {5});
  {
    const ThreadLimit single(1);
    EXPECT_EQ(synthesize_texture(layer, 333, 201, {5}), one);
  }
  EXPECT_NE(synthesize_texture(layer, 333, 201, {6}), one);
  // A larger texture continues the smaller one.
  const std::vector<float> larger = synthesize_texture(layer, 400, 300, {5});
  for (std::size_t y = 0; y < 201; ++y) {
    for (std::size_t x = 0; x < 333; ++x) ASSERT_EQ(larger[y * 400 + x], one[y * 333 + x]);
  }
}

// The texture has no seams: second differences at the borders of squares (every 64 pixels) are as large as
// elsewhere.
TEST(GaborTexture, HasNoSeams) {
  const std::vector<float> t = synthesize_texture(texture_layer({{5, 0.02, 0.03, 1.0}}), 1024, 1024, {2});
  double at_seams = 0, elsewhere = 0;
  int seams = 0, others = 0;
  for (std::size_t y = 0; y < 1024; ++y) {
    for (std::size_t x = 1; x < 1023; ++x) {
      const std::size_t i = y * 1024 + x;
      const double d = static_cast<double>(t[i - 1] - 2 * t[i] + t[i + 1]);
      const bool seam = x % 64 == 0 || x % 64 == 63;
      (seam ? at_seams : elsewhere) += d * d;
      ++(seam ? seams : others);
    }
  }
  EXPECT_NEAR((at_seams / seams) / (elsewhere / others), 1.0, 0.15);
}

TEST(GaborTexture, AnySizeAndNoNonsense) {
  const GaborLayer layer = texture_layer({{1, 0.5, -0.5, 1.0}, {12, 0.0, 0.0, 1.0}});
  EXPECT_EQ(synthesize_texture(layer, 1, 1, {1}).size(), 1u);
  EXPECT_EQ(synthesize_texture(layer, 1, 130, {1}).size(), 130u);
  for (const float v : synthesize_texture(layer, 65, 3, {1})) EXPECT_LE(std::fabs(v), 6.0f);
  EXPECT_THROW(synthesize_texture(layer, 0, 5, {1}), InputError);
  EXPECT_THROW(synthesize_texture(layer, 5, -1, {1}), InputError);
}

TEST(GaborTexture, StopsWhenAsked) {
  const GaborLayer layer = texture_layer({{3, 0.1, 0.1, 1.0}});
  int calls = 0;
  const auto texture =
      synthesize_texture(layer, 64, 256, {1}, [&](double, std::string_view) { return ++calls < 2; });
  EXPECT_EQ(calls, 2);
  EXPECT_NE(texture[0], 0.0f);
  EXPECT_EQ(texture[64 * 64], 0.0f);
}

}  // namespace
}  // namespace astrolith
