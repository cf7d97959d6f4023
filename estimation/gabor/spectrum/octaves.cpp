#include "estimation/gabor/spectrum/octaves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "estimation/gabor/spectrum/fourier_transform.h"

namespace astrolith {
namespace {

// A quadratic B-spline with coefficients at 0, 1, 2 ...; the first and the last go on beyond their ends.
double spline_at(const std::vector<double>& coefficients, double at) {
  const double nearest = std::floor(at + 0.5), d = at - nearest;
  const auto coefficient = [&](int step) {
    return coefficients[static_cast<std::size_t>(
        std::clamp(nearest + step, 0.0, static_cast<double>(coefficients.size() - 1)))];
  };
  return 0.5 * (0.5 - d) * (0.5 - d) * coefficient(-1) + (0.75 - d * d) * coefficient(0) +
         0.5 * (0.5 + d) * (0.5 + d) * coefficient(1);
}

}  // namespace

std::vector<double> octave_positions(const PowerSpectrum& grid) {
  const double side = std::sqrt(static_cast<double>(grid.width) * grid.height);
  std::vector<double> positions;
  positions.reserve(grid.power.size());
  for (int y = 0; y < grid.height; ++y) {
    const double fy = static_cast<double>(signed_frequency(y, grid.height)) / grid.height;
    for (int x = 0; x < grid.width; ++x) {
      const double fx = static_cast<double>(signed_frequency(x, grid.width)) / grid.width;
      positions.push_back(std::log2(std::max(1.0, side * std::hypot(fx, fy))));
    }
  }
  return positions;
}

std::vector<double> power_by_octave(const PowerSpectrum& spectrum, const std::vector<double>& positions) {
  std::vector<double> octaves(
      1 + static_cast<std::size_t>(*std::max_element(positions.begin(), positions.end())));
  for (std::size_t i = 1; i < positions.size(); ++i) {
    octaves[static_cast<std::size_t>(positions[i])] += spectrum.power[i];
  }
  return octaves;
}

std::vector<double> octave_weights(const PowerSpectrum& spectrum) {
  constexpr double kExponent = -0.5, kLeastShare = 1e-6;
  const std::vector<double> positions = octave_positions(spectrum);
  const double total = spectrum.variance() * static_cast<double>(spectrum.power.size());
  std::vector<double> logarithms;
  for (const double power : power_by_octave(spectrum, positions)) {
    logarithms.push_back(kExponent * std::log(std::max(power / total, kLeastShare)));
  }
  std::vector<double> weights;
  weights.reserve(positions.size());
  double weighted = 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    weights.push_back(std::exp(spline_at(logarithms, positions[i] - 0.5)));
    if (i > 0) weighted += weights[i] * spectrum.power[i];
  }
  for (double& w : weights) w *= total / weighted;
  return weights;
}

}  // namespace astrolith
