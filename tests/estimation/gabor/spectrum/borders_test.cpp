#include <cmath>
#include <string>
#include <vector>

#include "estimation/gabor/spectrum/border_taper.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "estimation/gabor/spectrum/spectrum_estimate.h"
#include "estimation/gabor/spectrum/tapered_periodogram.h"
#include "numerics/hash_random.h"
#include "numerics/sample_statistics.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

// The decision is statistical: the cut of one of these textures continues by chance.
TEST(BorderTaper, TellsAPeriodFromACut) {
  int false_cuts = 0, false_periods = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const PowerSpectrum& s : {testing::four_lobe_spectrum(), testing::steep_spectrum()}) {
      const GreyImage period = testing::draw_realisation(s, seed), cut = period.part(0, 0, 64, 64);
      false_cuts += !repeats_along_x(period) + !repeats_along_y(period);
      false_periods += repeats_along_x(cut) + repeats_along_y(cut);
    }
  }
  EXPECT_EQ(false_cuts, 0);     // of 20
  EXPECT_LE(false_periods, 1);  // of 20
}

// One bright layer of rock, or one bright grain, bends the image more than a cut border does.
TEST(BorderTaper, OneStrongStratumOrGrainDoesNotHideACut) {
  int false_periods = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const PowerSpectrum& s : {testing::four_lobe_spectrum(), testing::steep_spectrum()}) {
      const GreyImage cut = testing::draw_realisation(s, seed).part(0, 0, 64, 64);
      GreyImage upright = cut, level = cut, grain = cut;
      for (int i = 0; i < 64; ++i) {
        upright.values[static_cast<std::size_t>(i * 64 + 20)] += 10.0;
        level.values[static_cast<std::size_t>(41 * 64 + i)] -= 10.0;
      }
      grain.values[30 * 64 + 37] += 200.0;
      false_periods +=
          repeats_along_x(upright) + repeats_along_y(level) + repeats_along_x(grain) + repeats_along_y(grain);
    }
  }
  EXPECT_LE(false_periods, 2);  // of 40; the cut that continues by chance is taken for a period twice
}

TEST(BorderTaper, AStrongStratumInAPeriodDoesNotHideIt) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    GreyImage period = testing::draw_realisation(testing::steep_spectrum(), seed);
    for (int i = 0; i < period.height; ++i)
      period.values[static_cast<std::size_t>(i * period.width + 20)] += 10.0;
    EXPECT_TRUE(repeats_along_x(period) && repeats_along_y(period)) << seed;
  }
}

TEST(BorderTaper, LeavesAPeriodAsItIs) {
  const GreyImage period = testing::draw_realisation(testing::four_lobe_spectrum(), 2);
  const BorderTaper taper = make_taper(period);
  EXPECT_DOUBLE_EQ(taper.looks(), 1.0);
  EXPECT_LT(optimal_transport_distance(power_spectrum(faded(period, taper)), power_spectrum(period)), 1e-6);
}

TEST(BorderTaper, FadesACut) {
  const GreyImage cut = testing::draw_realisation(testing::steep_spectrum(), 3).part(0, 0, 70, 70);
  const BorderTaper taper = make_taper(cut);
  EXPECT_LT(std::abs(faded(cut, taper).at(0, 35)), 0.1 * std::sqrt(sample_variance(cut.values)));
  EXPECT_GT(taper.looks(), 0.7);
  EXPECT_LT(taper.looks(), 1.0);
}

GreyImage random_image(int width, int height) {
  CounterRandom random(7);
  GreyImage image{width, height, {}};
  for (int i = 0; i < width * height; ++i) image.values.push_back(random.uniform());
  return image;
}

// The Laplacian over neighbours. `wrap` decides whether neighbours across the border count.
double laplacian(const GreyImage& image, int x, int y, bool wrap) {
  const int w = image.width;
  const int h = image.height;
  double sum = 0.0;
  for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    const int nx = x + dx;
    const int ny = y + dy;
    const bool inside = nx >= 0 && nx < w && ny >= 0 && ny < h;
    if (inside || wrap) sum += image.at((nx + w) % w, (ny + h) % h) - image.at(x, y);
  }
  return sum;
}

TEST(PeriodicComponent, PartsAddUpToTheImage) {
  const GreyImage image = random_image(33, 40);
  const PeriodicDecomposition parts = decompose_periodic(image);
  double smooth_sum = 0.0;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    EXPECT_NEAR(parts.periodic.values[i] + parts.smooth.values[i], image.values[i], 1e-14);
    smooth_sum += parts.smooth.values[i];
  }
  EXPECT_NEAR(smooth_sum, 0.0, 1e-10);
}

// By Moisan's definition the periodic Laplacian of the periodic component is the interior Laplacian of the
// image.
TEST(PeriodicComponent, ItsPeriodicLaplacianIsTheInteriorLaplacianOfTheImage) {
  for (const auto& [w, h] : {std::pair{33, 40}, {32, 17}, {2, 5}}) {
    const GreyImage image = random_image(w, h);
    const GreyImage periodic = decompose_periodic(image).periodic;
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        EXPECT_NEAR(laplacian(periodic, x, y, true), laplacian(image, x, y, false), 1e-12);
      }
    }
  }
}

TEST(PeriodicComponent, AnImageWhoseBordersMatchIsUnchanged) {
  GreyImage image = random_image(32, 32);
  for (int y = 0; y < 32; ++y) image.values[static_cast<std::size_t>(y) * 32 + 31] = image.at(0, y);
  for (int x = 0; x < 32; ++x) image.values[31 * 32 + static_cast<std::size_t>(x)] = image.at(x, 0);
  const GreyImage periodic = decompose_periodic(image).periodic;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    EXPECT_NEAR(periodic.values[i], image.values[i], 1e-13);
  }
}

TEST(PeriodicComponent, ARampIsAlmostAllSmooth) {
  GreyImage image{64, 64, {}};
  for (int i = 0; i < 64 * 64; ++i) image.values.push_back(i % 64 / 64.0);
  const GreyImage periodic = decompose_periodic(image).periodic;
  double square = 0.0;
  double mean = 0.0;
  for (const double v : periodic.values) mean += v / 4096.0;
  for (const double v : periodic.values) square += (v - mean) * (v - mean) / 4096.0;
  EXPECT_LT(square, 1e-3 / 12.0);  // the ramp itself has variance 1/12
}

// The mean power of an octave, from `lowest` to twice as many cycles a side.
double octave_power(const PowerSpectrum& s, double lowest) {
  double sum = 0.0;
  int bins = 0;
  for (int y = 0; y < s.height; ++y) {
    for (int x = 0; x < s.width; ++x) {
      const double r = std::hypot(signed_frequency(x, s.width), signed_frequency(y, s.height));
      if (r < lowest || r >= 2.0 * lowest) continue;
      sum += s.power[static_cast<std::size_t>(y * s.width + x)];
      ++bins;
    }
  }
  return sum / bins;
}

PowerSpectrum square_spectrum(const GreyImage& image) {
  return least_leaky(tapered_power(image, image.width, image.height));
}

// Spectra with most power below three cycles an image, and white noise, on squares cut out of larger
// textures.
TEST(TaperedPeriodogram, DoesNotLeak) {
  const auto falling = [](double exponent) {
    return [exponent](double fx, double fy) { return std::pow(0.1 + fx * fx + fy * fy, -0.5 * exponent); };
  };
  for (const double exponent : {0.0, 2.0, 3.0, 4.0, 5.0}) {
    const auto truth = falling(exponent);
    std::vector<double> ratio(4);
    constexpr int kSeeds = 12;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const testing::CutTexture cut = testing::unscaled_cut(truth, seed);
      const PowerSpectrum spectrum = square_spectrum(cut.image);
      for (std::size_t k = 0; k < ratio.size(); ++k) {
        const double lowest = std::ldexp(4.0, static_cast<int>(k));
        ratio[k] += octave_power(spectrum, lowest) / octave_power(cut.truth, lowest) / kSeeds;
      }
    }
    for (const double r : ratio) EXPECT_NEAR(std::log(r), 0.0, 0.3) << "f^-" << exponent;
  }
}

// A texture has the variance of its pixels. A ramp of ten times as much is left out, and does not enter the
// texture's octaves.
TEST(TaperedPeriodogram, LeavesARampOut) {
  GreyImage image = testing::unscaled_cut(testing::ring_power, 3).image;
  const PowerSpectrum bare = square_spectrum(image);
  const double variance = sample_variance(image.values);
  EXPECT_NEAR(bare.variance(), variance, 0.05 * variance);
  const double slope = std::sqrt(10.0 * variance * 12.0) / 128.0;
  for (std::size_t i = 0; i < image.values.size(); ++i)
    image.values[i] += slope * static_cast<double>(i % 128);
  const PowerSpectrum spectrum = square_spectrum(image);
  EXPECT_NEAR(spectrum.variance(), variance, 0.2 * variance);
  EXPECT_NEAR(octave_power(spectrum, 16.0) / octave_power(bare, 16.0), 1.0, 0.1);
}

// A grid of finer frequencies shows the same spectrum.
TEST(TaperedPeriodogram, OnAFinerGridIsTheSame) {
  const GreyImage cut =
      testing::unscaled_cut([](double fx, double fy) { return 1.0 / (1.0 + fx * fx + fy * fy); }, 4).image;
  const PowerSpectrum coarse = square_spectrum(cut), fine = least_leaky(tapered_power(cut, 256, 256));
  EXPECT_NEAR(fine.variance() / coarse.variance(), 1.0, 0.1);
  for (const double lowest : {4.0, 8.0, 16.0, 32.0}) {
    EXPECT_NEAR(octave_power(fine, 2.0 * lowest) / octave_power(coarse, lowest), 1.0, 0.1) << lowest;
  }
}

}  // namespace
}  // namespace astrolith
