#include "synthesis/body/compact_kernel.h"

#include <algorithm>
#include <cmath>

#include "numerics/portable_double.h"

namespace astrolith {

CompactKernel<double> scaled_kernel(Kernel kernel, double tension, double surface, double& cutoff_squared) {
  const bool ends = kernel != Kernel::kCauchy;
  const auto unit = [kernel](double x) { return kernel_value<double>({kernel, 1.0, 0.0, 1.0}, x).value; };
  const auto low_at = [&](double scale) {
    return ends && scale * cutoff_squared >= 1.0 ? 0.0 : unit(scale * cutoff_squared);
  };
  // K at the surface over K at the centre. The ratio falls as the scale grows.
  const auto ratio = [&](double scale) {
    const double low = low_at(scale);
    return (unit(scale * surface) - low) / (1.0 - low);
  };
  const double wanted = portable::exp(-tension);
  double flat = 1e-6 / cutoff_squared, steep = (ends ? 1.0 : 2.0 * portable::exp(tension)) / surface;
  for (int i = 0; i < 100; ++i) {
    const double middle = std::sqrt(flat * steep);
    (ratio(middle) > wanted ? flat : steep) = middle;
  }
  const double low = low_at(flat);
  if (ends) cutoff_squared = std::min(cutoff_squared, 1.0 / flat);
  return {kernel, flat, low, portable::exp(tension) / (1.0 - low)};
}

}  // namespace astrolith
