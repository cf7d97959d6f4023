#include "estimation/gabor/spectrum/spectrum_distance.h"

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"

namespace astrolith {
namespace {

void require_same_grid(const PowerSpectrum& a, const PowerSpectrum& b) {
  if (a.width != b.width || a.height != b.height) {
    throw WorkError("spectrum distance: the grids differ in size");
  }
}

template <typename Map>
double relative_distance(const PowerSpectrum& a, const PowerSpectrum& truth, const Map& map) {
  require_same_grid(a, truth);
  double difference = 0.0;
  double norm = 0.0;
  for (std::size_t i = 1; i < truth.power.size(); ++i) {
    const double t = map(truth.power[i]);
    const double d = map(a.power[i]) - t;
    difference += d * d;
    norm += t * t;
  }
  return norm > 0.0 ? std::sqrt(difference / norm) : 0.0;
}

}  // namespace

double optimal_transport_distance(const PowerSpectrum& a, const PowerSpectrum& truth) {
  return relative_distance(a, truth, [](double p) { return std::sqrt(std::max(0.0, p)); });
}

double relative_l2_distance(const PowerSpectrum& a, const PowerSpectrum& truth) {
  return relative_distance(a, truth, [](double p) { return p; });
}

double log_spectral_distance(const PowerSpectrum& a, const PowerSpectrum& truth) {
  require_same_grid(a, truth);
  const double mean = truth.variance();
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 1; i < truth.power.size(); ++i) {
    if (truth.power[i] < 1e-3 * mean || truth.power[i] <= 0.0) continue;
    const double ratio = std::log(std::max(a.power[i], 1e-6 * mean) / truth.power[i]);
    sum += ratio * ratio;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
}

}  // namespace astrolith
