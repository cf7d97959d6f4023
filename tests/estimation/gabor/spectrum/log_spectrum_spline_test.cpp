#include "estimation/gabor/spectrum/log_spectrum_spline.h"

#include <algorithm>
#include <cmath>

#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

PowerSpectrum periodogram_of(const PowerSpectrum& truth, std::uint64_t seed) {
  return power_spectrum(testing::realisation_of(truth, seed));
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
  const PowerSpectrum data = periodogram_of(testing::four_lobe_spectrum(), 4);
  const LogSpectrumSpline spline(data);
  for (const double w : {1.0, 3.0}) {
    const std::vector<double> g = spline.fit(w);
    double sum = 0.0;
    for (std::size_t i = 1; i < g.size(); ++i) sum += data.power[i] * std::exp(-g[i]);
    EXPECT_NEAR(sum / static_cast<double>(g.size() - 1), 1.0, 5e-3);
  }
}

TEST(LogSpectrumSpline, DoesNotDependOnTheStart) {
  const PowerSpectrum data = periodogram_of(testing::ring_spectrum(), 5);
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
  PowerSpectrum data = periodogram_of(white, 6);
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
  const PowerSpectrum data = periodogram_of(testing::ring_spectrum(), 7);
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
