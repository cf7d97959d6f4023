#include "estimation/gabor/spectrum/spectrum_distance.h"

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"

namespace astrolith {

double optimal_transport_distance(const PowerSpectrum& a, const PowerSpectrum& truth) {
  if (a.width != truth.width || a.height != truth.height) {
    throw WorkError("spectrum distance: the grids differ in size");
  }
  double difference = 0.0;
  double norm = 0.0;
  for (std::size_t i = 1; i < truth.power.size(); ++i) {
    const double t = std::sqrt(std::max(0.0, truth.power[i]));
    const double d = std::sqrt(std::max(0.0, a.power[i])) - t;
    difference += d * d;
    norm += t * t;
  }
  return norm > 0.0 ? std::sqrt(difference / norm) : 0.0;
}

}  // namespace astrolith
