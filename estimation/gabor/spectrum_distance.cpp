#include "estimation/gabor/spectrum_distance.h"

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"

namespace astrolith {
namespace {

template <typename Map>
double relative_distance(const PowerSpectrum& a, const PowerSpectrum& truth, const Map& map) {
  if (a.width != truth.width || a.height != truth.height) {
    throw WorkError("spectrum distance: the grids differ in size");
  }
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

}  // namespace astrolith
