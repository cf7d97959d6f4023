#include "estimation/gabor/lobes/lobe_quality.h"

#include <algorithm>
#include <cmath>

#include "estimation/gabor/spectrum/fourier_transform.h"
#include "estimation/gabor/spectrum/power_spectrum.h"

namespace astrolith {
namespace {

double squared(double x) { return x * x; }

// The standard deviation of the squared residual (s in the header).
double residual_scatter(const PowerSpectrum& fitted, const PowerSpectrum& periodogram, double c) {
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 1; i < fitted.power.size(); ++i) {
    sum += fitted.power[i];
    squares += squared(fitted.power[i]);
  }
  // The moments of a Gamma variate g of mean 1: E g^(3/2) = (1 + scatter / 2) c, E g^2 = 1 + scatter.
  const double v = (1.0 - c * c) / (c * c) + 0.25 * periodogram.scatter - 0.5 * periodogram.scatter;
  // A mean of m periodograms whose neighbours are correlated counts as fewer than m of independent values.
  const double correlation = std::max(1.0, 1.0 / (periodogram.scatter * periodogram.averages));
  return sum > 0.0 ? 2.0 * std::sqrt(2.0 * std::max(0.0, v) * correlation * squares) / sum : 0.0;
}

std::vector<BandVariance> octave_variances(const PowerSpectrum& fitted, const PowerSpectrum& photo) {
  const int longest = std::max(photo.width, photo.height);
  std::vector<BandVariance> bands;
  // The highest octave also holds the corners beyond 1/2 cycle per pixel.
  for (double top = 0.5; top > 0.5 / longest; top *= 0.5) bands.push_back({0.5 * top, top, 0.0, 0.0});
  const double unit = 1.0 / (photo.variance() * static_cast<double>(photo.power.size()));
  std::size_t i = 0;
  for (int y = 0; y < photo.height; ++y) {
    const double fy = static_cast<double>(signed_frequency(y, photo.height)) / photo.height;
    for (int x = 0; x < photo.width; ++x, ++i) {
      if (i == 0) continue;
      const double fx = static_cast<double>(signed_frequency(x, photo.width)) / photo.width;
      const double f2 = fx * fx + fy * fy;
      std::size_t band = 0;
      while (band + 1 < bands.size() && f2 < squared(bands[band].lowest)) ++band;
      bands[band].photo += unit * photo.power[i];
      bands[band].noise += unit * fitted.power[i];
    }
  }
  std::reverse(bands.begin(), bands.end());
  return bands;
}

}  // namespace

double mean_root(double scatter) {
  // Gamma(m + 1/2) / (Gamma(m) sqrt(m)) for m = 1 / scatter: eight steps of the recurrence Gamma(m + 1) = m
  // Gamma(m), then the asymptotic series.
  const double m = 1.0 / scatter;
  double factor = 1.0;
  for (int k = 0; k < 8; ++k) factor *= (m + k) / (m + k + 0.5);
  const double h = 1.0 / (m + 8.0);
  const double series =
      1.0 + h * (-1.0 / 8.0 +
                 h * (1.0 / 128.0 + h * (5.0 / 1024.0 + h * (-21.0 / 32768.0 - h * 399.0 / 262144.0))));
  return factor * std::sqrt((m + 8.0) / m) * series;
}

LobeQuality judge_lobes(const PowerSpectrum& fitted, const PowerSpectrum& periodogram,
                        double estimate_error) {
  LobeQuality quality;
  const double c = mean_root(periodogram.scatter);
  quality.periodogram_distance = optimal_transport_distance(fitted, periodogram);
  quality.perfect_distance = std::sqrt(std::max(0.0, 2.0 - 2.0 * c));
  const double sums = fitted.variance() / periodogram.variance() + 1.0;
  const double residual = sums - (sums - squared(quality.periodogram_distance)) / c;
  quality.residual = std::sqrt(std::max(0.0, residual));
  quality.weak_above = std::sqrt(squared(kVisibleResidual) + squared(estimate_error) +
                                 3.0 * residual_scatter(fitted, periodogram, c));
  quality.bands = octave_variances(fitted, periodogram);
  for (const BandVariance& band : quality.bands) quality.band_overlap += std::min(band.photo, band.noise);
  return quality;
}

}  // namespace astrolith
