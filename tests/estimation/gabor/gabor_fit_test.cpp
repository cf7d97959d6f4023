#include "estimation/gabor/gabor_fit.h"

#include <cmath>

#include "estimation/gabor/image/image_reader.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "tests/estimation/gabor/known_spectrum.h"
#include "tests/support/data.h"

namespace astrolith {
namespace {

double total_variance(const std::vector<GaborLobe>& lobes) {
  double sum = 0.0;
  for (const GaborLobe& lobe : lobes) sum += lobe.variance;
  return sum;
}

// The best distance of the reference estimator of Galerne et al. is 0.284. Texton noise reaches 0.193, and
// the best smoothed periodogram 0.136.
TEST(GaborFit, RecoversAKnownSpectrumFromOneRealisation) {
  const PowerSpectrum truth = testing::four_lobe_spectrum();
  constexpr int kSeeds = 4;
  double distance = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const GreyImage exemplar = testing::draw_realisation(truth, static_cast<std::uint64_t>(seed));
    const GaborFit fit = fit_gabor_lobes(exemplar, "exemplar", {});
    EXPECT_LE(fit.lobes.size(), 80u);
    EXPECT_LE(fit.pursuit.relative_gap, 1e-2);
    for (const GapSample& sample : fit.pursuit.history) EXPECT_GE(sample.relative_gap, 0.0);
    distance += optimal_transport_distance(fit.fitted, truth) / kSeeds;
  }
  EXPECT_LT(distance, 0.10);
}

// A realisation on which the pursuit's first atoms once entered and left for ever.
TEST(GaborFit, ThePursuitDoesNotGoRoundInCircles) {
  GaborFitOptions options;
  options.penalty_ratio = 0.03;
  const GaborFit fit =
      fit_gabor_lobes(testing::draw_realisation(testing::four_lobe_spectrum(), 3), "exemplar", options);
  EXPECT_TRUE(fit.pursuit.reached);
  EXPECT_LE(fit.pursuit.iterations, 100);
}

TEST(GaborFit, KeepsTheVarianceOfTheExemplar) {
  const GreyImage exemplar = testing::draw_realisation(testing::four_lobe_spectrum(), 9);
  GaborFitOptions options;
  options.max_lobes = 40;
  const GaborFit fit = fit_gabor_lobes(exemplar, "exemplar", options);
  EXPECT_LE(fit.lobes.size(), 40u);
  EXPECT_NEAR(total_variance(fit.lobes), fit.exemplar_rms * fit.exemplar_rms, 1e-5 * fit.exemplar_rms);
  EXPECT_NEAR(fit.fitted.variance(), fit.periodogram.variance(), 0.02 * fit.periodogram.variance());
  EXPECT_NEAR(fit.variance_before_scaling, 1.0, 0.05);
}

// An exemplar in other units and with another mean gives the same lobes with scaled variances.
TEST(GaborFit, ScalesWithTheExemplar) {
  const GreyImage exemplar = testing::draw_realisation(testing::four_lobe_spectrum(), 10);
  GreyImage other = exemplar;
  for (double& v : other.values) v = 1e6 + 1024.0 * v;
  const GaborFit a = fit_gabor_lobes(exemplar, "a", {});
  const GaborFit b = fit_gabor_lobes(other, "b", {});
  ASSERT_EQ(a.lobes.size(), b.lobes.size());
  for (std::size_t i = 0; i < a.lobes.size(); ++i) {
    EXPECT_EQ(a.lobes[i].bandwidth, b.lobes[i].bandwidth);
    EXPECT_NEAR(a.lobes[i].variance * 1024.0 * 1024.0, b.lobes[i].variance, 1e-3 * b.lobes[i].variance);
  }
}

TEST(GaborFit, ThreadsDoNotChangeABit) {
  const GreyImage exemplar = testing::draw_realisation(testing::four_lobe_spectrum(), 12);
  const auto fit_with = [&](int threads) {
    const ThreadLimit limit(threads);
    return fit_gabor_lobes(exemplar, "exemplar", {}).fitted.power;
  };
  EXPECT_EQ(fit_with(1), fit_with(4));
}

TEST(GaborFit, RefusesWhatHasNoTexture) {
  EXPECT_THROW(fit_gabor_lobes({1, 1, {0.5}}, "dot.png", {}), InputError);
  EXPECT_THROW(fit_gabor_lobes({64, 31, std::vector<double>(64 * 31, 0.5)}, "strip.png", {}), InputError);
  EXPECT_THROW(fit_gabor_lobes({64, 64, std::vector<double>(64 * 64, 0.5)}, "flat.png", {}), InputError);
}

// One bright pixel, a pure cosine, a checkerboard and a strip of tiles must not crash the fit.
TEST(GaborFit, SurvivesDegenerateTextures) {
  std::vector<GreyImage> images(3, GreyImage{33, 40, std::vector<double>(33 * 40, 0.0)});
  images[0].values[400] = 1.0;
  for (std::size_t i = 0; i < images[1].values.size(); ++i) {
    images[1].values[i] = std::cos(2.0 * 3.14159265358979 * 4.0 * static_cast<double>(i % 33) / 33.0);
    images[2].values[i] = static_cast<double>((i % 33 + i / 33) % 2);
  }
  // Twenty tiles side by side: a spectrum of lines with nothing between them.
  const GreyImage tile = testing::draw_realisation(testing::four_lobe_spectrum(), 4).part(0, 0, 32, 32);
  GreyImage strip{640, 32, {}};
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 640; ++x) strip.values.push_back(tile.at(x % 32, y));
  }
  images.push_back(strip);
  for (const GreyImage& image : images) {
    const GaborFit fit = fit_gabor_lobes(image, "degenerate", {});
    EXPECT_GE(fit.lobes.size(), 1u);
    EXPECT_NEAR(total_variance(fit.lobes), fit.exemplar_rms * fit.exemplar_rms, 1e-5);
  }
}

TEST(GaborFit, Gravel) {
  const auto file = testing::package_file("gravel.png");
  ASTROLITH_SKIP_WITHOUT(file);
  const GreyImage photo = read_image(file, false).planes[0];
  GreyImage corner{256, 256, {}};
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) corner.values.push_back(photo.at(x, y));
  }
  const GaborFit fit = fit_gabor_lobes(corner, "gravel", {});
  EXPECT_LE(fit.pursuit.relative_gap, 1e-2);
  EXPECT_LE(fit.lobes.size(), 80u);
  EXPECT_LT(fit.spectrum_distance, 0.06);
  EXPECT_NEAR(fit.variance_before_scaling, 1.0, 0.02);
}

}  // namespace
}  // namespace astrolith
