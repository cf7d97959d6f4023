#include "synthesis/gabor/gabor_tiling.h"

#include <cmath>
#include <numbers>

#include "numerics/portable_angles.h"
#include "synthesis/gabor/gabor_bands.h"
#include "synthesis/gabor/gabor_kernel.h"

namespace astrolith {
namespace {

// c(n, f) of the header. `frequency` is f / a, and `period` is n in units of 1/a.
double periodic_sum(double period, double frequency) {
  double sum = 1.0;
  for (int j = 1; j * period < 2.0 * static_cast<double>(kGaborReach); ++j) {
    const double tau = j * period;
    sum += 2.0 * gabor_profile_correlation(tau) * portable::cos(2.0 * std::numbers::pi * frequency * tau);
  }
  return sum;
}

}  // namespace

double gabor_profile_correlation(double tau) {
  constexpr int kSteps = 256;
  const double reach = static_cast<double>(kGaborReach);
  const double begin = tau - reach;  // both profiles are nonzero between begin and reach
  if (!(begin < reach)) return 0.0;
  const double step = (reach - begin) / kSteps;
  double sum = 0.0;  // trapezoidal rule; values and slopes are 0 at both ends
  for (int i = 1; i < kSteps; ++i) {
    const double u = begin + i * step;
    sum += static_cast<double>(gabor_profile(static_cast<float>(u))) *
           static_cast<double>(gabor_profile(static_cast<float>(u - tau)));
  }
  return sum * step / kGaborProfileEnergy;
}

double tiled_variance(const GaborLayer& layer, int width, int height) {
  double total = 0.0;
  for (const GaborBand& band : gabor_bands(layer)) {
    double before = 0.0;
    for (const GaborBand::Lobe& lobe : band.lobes) {
      const double share = band.variance_share * (static_cast<double>(lobe.cumulative) - before);
      before = static_cast<double>(lobe.cumulative);
      total += share * periodic_sum(band.a * width, static_cast<double>(lobe.frequency_x)) *
               periodic_sum(band.a * height, static_cast<double>(lobe.frequency_y));
    }
  }
  return total;
}

}  // namespace astrolith
