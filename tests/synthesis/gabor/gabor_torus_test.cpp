#include "synthesis/gabor/gabor_texture.h"

#include <cmath>

#include "numerics/errors.h"

namespace astrolith {
namespace {

GaborLayer make_layer(std::vector<GaborLobe> lobes) {
  GaborLayer layer;
  layer.height_rms = 1.0;
  layer.lobes = std::move(lobes);
  return layer;
}

double mean_square(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float v : values) sum += static_cast<double>(v) * static_cast<double>(v);
  return sum / static_cast<double>(values.size());
}

// The correlation of the ideal Gaussian is exp(-pi tau^2 / 2). The window changes it little.
TEST(GaborTorus, CorrelationIsTheGaussians) {
  EXPECT_NEAR(gabor_profile_correlation(0.0), 1.0, 1e-6);
  for (const double tau : {0.3, 0.7, 1.0, 1.5}) {
    EXPECT_NEAR(gabor_profile_correlation(tau), std::exp(-M_PI * tau * tau / 2), 1e-2) << tau;
  }
  EXPECT_EQ(gabor_profile_correlation(2.81), 0.0);
}

TEST(GaborTorus, WideLobesKeepTheirVarianceAndNarrowOnesDependOnTheirFrequency) {
  EXPECT_NEAR(torus_variance(make_layer({{4, 0.11, 0.23, 1.0}}), 256, 300), 1.0, 1e-12);
  // Lobes narrower than the steps between frequencies: one has all its variance on one frequency, the other
  // lies between two.
  EXPECT_GT(torus_variance(make_layer({{7, 4.0 / 64, 0.0, 1.0}}), 64, 256), 1.5);
  EXPECT_LT(torus_variance(make_layer({{8, 4.5 / 64, 0.0, 1.0}}), 64, 256), 0.1);
}

// A period of 1.5 / a is longer than the reach of one kernel and shorter than that of two.
TEST(GaborTorus, VarianceCountsKernelsThatOverlapTheirCopies) {
  const double period = 64 * std::ldexp(std::sqrt(M_PI / (2.0 * std::log(2.0))), -6);
  EXPECT_NEAR(torus_variance(make_layer({{6, 4.0 / 64, 0.0, 1.0}}), 64, 4096),
              1.0 + 2.0 * std::exp(-M_PI * period * period / 2), 0.02);
}

// Every pixel equals the one a period away. A texture of twice the period in each direction shows this for
// any position of the inner squares of 64 pixels.
TEST(GaborTorus, TheTextureRepeatsExactly) {
  const GaborLayer layer = make_layer({{2, 0.2, 0.1, 1.0}, {5, -0.03, 0.04, 2.0}, {6, 0.1, 0.02, 1.0}});
  TextureOptions options{7};
  options.period_width = 150;
  options.period_height = 97;
  const std::vector<float> t = synthesize_texture(layer, 300, 194, options);
  double largest = 0.0;
  for (std::size_t y = 0; y < 194; ++y) {
    for (std::size_t x = 0; x < 300; ++x) {
      const float other = t[y % 97 * 300 + x % 150];
      largest = std::max(largest, static_cast<double>(std::fabs(t[y * 300 + x] - other)));
    }
  }
  EXPECT_LT(largest, 2e-5);
  EXPECT_GT(mean_square(t), 0.5);
}

TEST(GaborTorus, VarianceIsStatedWhateverThePeriod) {
  const GaborLayer layer = make_layer({{3, 0.2, 0.1, 1.0}, {6, 0.05, 0.04, 1.0}, {6, 0.21, 0.01, 1.0}});
  for (const int n : {48, 64, 100}) {
    double sum = 0.0;
    constexpr int kSeeds = 400;
    for (int seed = 0; seed < kSeeds; ++seed) {
      sum +=
          mean_square(synthesize_texture(layer, n, n, {static_cast<std::uint64_t>(seed), 0, n, n})) / kSeeds;
    }
    EXPECT_NEAR(sum, 1.0, 0.06) << n;  // 3 standard deviations, since few frequencies make a lobe
  }
}

TEST(GaborTorus, PeriodsTooSmallForTheLobesAreRefused) {
  const GaborLayer narrow = make_layer({{12, 0.1, 0.1, 1.0}});
  EXPECT_THROW(synthesize_texture(narrow, 64, 64, {1, 0, 64, 64}), InputError);
  EXPECT_THROW(synthesize_texture(narrow, 1, 1, {1, 0, 1, 1}), InputError);
  EXPECT_NO_THROW(synthesize_texture(make_layer({{1, 0.0, 0.0, 1.0}}), 8, 8, {1, 0, 8, 8}));
}

}  // namespace
}  // namespace astrolith
