#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "estimation/gabor/spectrum/power_spectrum.h"
#include "estimation/gabor/spectrum/spectrum_estimate.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

// On every kind of spectrum the estimate is nearer to the truth than the best Gaussian smoothing of one
// width, which is chosen with knowledge of the truth.
TEST(SpectrumEstimate, IsNearerToTheTruthThanTheBestSmoothing) {
  const std::map<std::string, double> best_smoothed = {{"four lobes", 0.136}, {"ring", 0.113},
                                                       {"steep", 0.154},      {"lines", 0.200},
                                                       {"broad", 0.070},      {"eight Gabor lobes", 0.175}};
  for (const testing::NamedSpectrum& known : testing::known_spectra()) {
    double distance = 0.0;
    double predicted = 0.0;
    constexpr int kSeeds = 4;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      const PowerSpectrum periodogram =
          power_spectrum(testing::draw_realisation(known.spectrum, static_cast<std::uint64_t>(seed)));
      const SpectrumEstimate estimate = estimate_spectrum(periodogram);
      EXPECT_NEAR(estimate.spectrum.variance(), periodogram.variance(), 1e-9);
      distance += optimal_transport_distance(estimate.spectrum, known.spectrum) / kSeeds;
      predicted += estimate.standard_error / kSeeds;
    }
    EXPECT_LT(distance, 0.95 * best_smoothed.at(known.name)) << known.name;
    EXPECT_NEAR(predicted / distance, 1.0, 0.35) << known.name;
  }
}

// So it is where most power lies below three cycles an image.
TEST(SpectrumEstimate, OfASmoothHeightMapIsNearerThanTheBestSmoothing) {
  double distance = 0.0;
  constexpr int kSeeds = 8;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const PowerSpectrum periodogram =
        power_spectrum(testing::draw_realisation(testing::smooth_spectrum(), seed));
    distance +=
        optimal_transport_distance(estimate_spectrum(periodogram).spectrum, testing::smooth_spectrum()) /
        kSeeds;
  }
  EXPECT_LT(distance, 0.95 * 0.288);
}

TEST(SpectrumEstimate, TurnsWithTheImage) {
  const GreyImage image = testing::draw_realisation(testing::four_lobe_spectrum(), 8);
  GreyImage turned = image;
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) turned.values[static_cast<std::size_t>(x * 128 + y)] = image.at(x, y);
  }
  const PowerSpectrum a = estimate_spectrum(power_spectrum(image)).spectrum;
  const PowerSpectrum b = estimate_spectrum(power_spectrum(turned)).spectrum;
  double largest = 0.0;
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      largest = std::max(largest, std::abs(a.power[static_cast<std::size_t>(y * 128 + x)] -
                                           b.power[static_cast<std::size_t>(x * 128 + y)]));
    }
  }
  EXPECT_LT(largest, 1e-4 * *std::max_element(a.power.begin(), a.power.end()));
}

// White noise has no features that smoothing could blur. An oblique peak has.
TEST(SpectrumEstimate, SmoothsWhiteNoiseMoreThanAPeak) {
  PowerSpectrum flat{128, 128, std::vector<double>(128 * 128, 1.0)};
  flat.power[0] = 0.0;
  const SpectrumEstimate white = estimate_spectrum(power_spectrum(testing::draw_realisation(flat, 3)));
  const PowerSpectrum peaked = testing::four_lobe_spectrum();
  const SpectrumEstimate peaks = estimate_spectrum(power_spectrum(testing::draw_realisation(peaked, 3)));
  EXPECT_GE(white.smoothing[5].width_bins, 5.0);
  EXPECT_LE(peaks.smoothing[3].width_bins, 2.5);  // 8 to 16 bins: where the strongest lobe sits
}

TEST(SpectrumEstimate, IsSymmetricPositiveAndZeroAtFrequencyZero) {
  PowerSpectrum lines{35, 48, std::vector<double>(35 * 48, 0.0)};  // a cosine: nearly all bins empty
  lines.power[3] = lines.power[32] = 10.0;
  const SpectrumEstimate estimate = estimate_spectrum(lines);
  EXPECT_EQ(estimate.spectrum.power[0], 0.0);
  EXPECT_GT(*std::min_element(estimate.spectrum.power.begin() + 1, estimate.spectrum.power.end()), 0.0);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 35; ++x) {
      const double here = estimate.spectrum.power[static_cast<std::size_t>(y * 35 + x)];
      EXPECT_NEAR(here, estimate.spectrum.power[static_cast<std::size_t>((48 - y) % 48 * 35 + (35 - x) % 35)],
                  1e-9 * (1.0 + here));
    }
  }
}

GreyImage white_noise(int width, int height, std::uint64_t seed) {
  CounterRandom random(seed);
  GreyImage image{width, height, {}};
  for (int i = 0; i < width * height; ++i) image.values.push_back(0.5 + 0.1 * random.normal());
  return image;
}

double sample_variance(const GreyImage& image) {
  double mean = 0.0;
  for (const double v : image.values) mean += v;
  mean /= static_cast<double>(image.values.size());
  double sum = 0.0;
  for (const double v : image.values) sum += (v - mean) * (v - mean);
  return sum / static_cast<double>(image.values.size());
}

TEST(PowerSpectrum, MeanPowerIsTheVariance) {
  for (const auto& [w, h] : {std::pair{32, 32}, {33, 48}, {47, 35}}) {
    const GreyImage image = white_noise(w, h, 3);
    EXPECT_NEAR(power_spectrum(image).variance(), sample_variance(image), 1e-14);
  }
}

// A photo of 12,000 x 5,000 pixels has 200 segments, which take seconds.
TEST(PowerSpectrum, AMeanOverSegmentsIsReportedAndStops) {
  const GreyImage image = white_noise(160, 96, 3);
  int reports = 0;
  exemplar_periodogram(image, 32, [&](double, std::string_view) { return ++reports > 0; });
  EXPECT_EQ(reports, 9 * 5);
  EXPECT_THROW(exemplar_periodogram(image, 32, [](double, std::string_view) { return false; }), WorkError);
}

TEST(PowerSpectrum, IsSymmetric) {
  const PowerSpectrum s = power_spectrum(white_noise(33, 48, 4));
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 33; ++x) {
      EXPECT_DOUBLE_EQ(s.power[static_cast<std::size_t>(y * 33 + x)],
                       s.power[static_cast<std::size_t>((48 - y) % 48 * 33 + (33 - x) % 33)]);
    }
  }
}

// A cosine of amplitude a has the variance a^2/2, all of it in two bins.
TEST(PowerSpectrum, OfACosineIsTwoBins) {
  GreyImage image{64, 48, {}};
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      image.values.push_back(0.5 + 0.2 * std::cos(2.0 * std::numbers::pi * (5.0 * x / 64 - 7.0 * y / 48)));
    }
  }
  const PowerSpectrum s = power_spectrum(image);
  const double each = 0.5 * 0.5 * 0.2 * 0.2 * 64 * 48;
  EXPECT_NEAR(s.power[41 * 64 + 5], each, 1e-10);
  EXPECT_NEAR(s.power[7 * 64 + 59], each, 1e-10);
  EXPECT_NEAR(s.variance(), 0.02, 1e-13);
}

TEST(PowerSpectrum, LargeExemplarsAreAveragedOverSegments) {
  const GreyImage image = white_noise(150, 100, 5);
  const PowerSpectrum s = exemplar_periodogram(image, 64);
  EXPECT_EQ(s.width, 64);
  EXPECT_EQ(s.height, 64);
  EXPECT_NEAR(s.variance(), sample_variance(image), 0.05 * sample_variance(image));
  // The speckle of a single periodogram is as large as the spectrum. Averaging must have lowered it.
  double square = 0.0;
  for (const double p : s.power) square += (p / s.variance() - 1.0) * (p / s.variance() - 1.0);
  EXPECT_LT(square / static_cast<double>(s.power.size()), 1.5 / s.averages);
  EXPECT_GT(s.averages, 3.0);
}

PowerSpectrum draw_periodogram(const PowerSpectrum& truth, std::uint64_t seed) {
  return power_spectrum(testing::draw_realisation(truth, seed));
}

// Smoothing does not change a Gaussian without noise, since its logarithm has no third differences.
TEST(LogSpectrumSpline, GoesThroughASmoothSpectrum) {
  PowerSpectrum hill{64, 48, {}};
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const double u = std::cos(2.0 * 3.14159265358979 * x / 64);
      const double v = std::cos(2.0 * 3.14159265358979 * y / 48);
      hill.power.push_back(std::exp(1.5 * u + v));
    }
  }
  const LogSpectrumSpline spline(hill);
  const std::vector<double> g = spline.fit(2.0);
  for (std::size_t i = 0; i < g.size(); ++i) EXPECT_NEAR(g[i], std::log(hill.power[i]), 2e-3);
}

// At the minimum the score of the likelihood balances the penalty, whose sum over the grid is zero. The mean
// of I / S over the frequencies with data is therefore one.
TEST(LogSpectrumSpline, ExplainsThePowerOnAverage) {
  const PowerSpectrum data = draw_periodogram(testing::four_lobe_spectrum(), 4);
  const LogSpectrumSpline spline(data);
  for (const double w : {1.0, 3.0}) {
    const std::vector<double> g = spline.fit(w);
    double sum = 0.0;
    for (std::size_t i = 1; i < g.size(); ++i) sum += data.power[i] * std::exp(-g[i]);
    EXPECT_NEAR(sum / static_cast<double>(g.size() - 1), 1.0, 5e-3);
  }
}

TEST(LogSpectrumSpline, DoesNotDependOnTheStart) {
  const PowerSpectrum data = draw_periodogram(testing::ring_spectrum(), 5);
  const LogSpectrumSpline spline(data);
  const std::vector<double> a = spline.fit(2.0);
  const std::vector<double> b = spline.fit(2.0, spline.fit(1.0));
  double largest = 0.0;
  for (std::size_t i = 1; i < a.size(); ++i) {
    if (data.power[i] > 1e-9) largest = std::max(largest, std::abs(a[i] - b[i]));
  }
  EXPECT_LT(largest, 0.05);
}

// On white noise the scatter of g about the truth, zero, is as predicted.
TEST(LogSpectrumSpline, PredictsItsOwnVariance) {
  const PowerSpectrum white = testing::spectrum_from([](double, double) { return 1.0; });
  PowerSpectrum data = draw_periodogram(white, 6);
  for (int k = 0; k < 128; ++k) {  // the Nyquist row and column are empty by construction
    data.power[static_cast<std::size_t>(64 * 128 + k)] = data.power[static_cast<std::size_t>(63 * 128 + k)];
    data.power[static_cast<std::size_t>(k * 128 + 64)] = data.power[static_cast<std::size_t>(k * 128 + 63)];
  }
  const LogSpectrumSpline spline(data);
  const std::vector<double> g = spline.fit(3.0);
  double mean = 0.0;
  double square = 0.0;
  for (const double v : g) mean += v / static_cast<double>(g.size());
  for (const double v : g) square += (v - mean) * (v - mean) / static_cast<double>(g.size());
  EXPECT_NEAR(std::sqrt(square / spline.freedom(3.0).variance), 1.0, 0.25);
}

TEST(LogSpectrumSpline, SpendsFewerParametersTheWider) {
  const PowerSpectrum data = draw_periodogram(testing::ring_spectrum(), 7);
  const LogSpectrumSpline spline(data);
  double last = 1.0;
  for (const double w : {0.6, 1.2, 2.4, 4.8}) {
    const double spent = spline.freedom(w).parameters;
    EXPECT_LT(spent, last);
    EXPECT_GT(spent, 0.0);
    last = spent;
  }
}

}  // namespace
}  // namespace astrolith
