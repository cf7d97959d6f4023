#include "estimation/gabor/spectrum/tapered_periodogram.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "estimation/gabor/spectrum/border_taper.h"
#include "estimation/gabor/spectrum/fourier_transform.h"
#include "estimation/gabor/spectrum/octaves.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

// The differences between neighbours along x or y. Those across a border are left out where it does not
// continue: the taper is next to nothing there.
GreyImage differences(const GreyImage& image, int step_x, int step_y, bool tiles) {
  GreyImage result{image.width, image.height, {}};
  result.values.reserve(image.values.size());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int x1 = x + step_x, y1 = y + step_y;
      const bool across = x1 == image.width || y1 == image.height;
      const double next = across && !tiles ? image.at(x, y) : image.at(x1 % image.width, y1 % image.height);
      result.values.push_back(next - image.at(x, y));
    }
  }
  return result;
}

double squared_sine(int bin, int n) {
  const double s = 2.0 * std::sin(std::numbers::pi * bin / n);
  return s * s;
}

PowerSpectrum slope_power(const GreyImage& image, const BorderTaper& taper) {
  PowerSpectrum sum = power_spectrum(faded(differences(image, 1, 0, taper.tiles_x), taper));
  const PowerSpectrum down = power_spectrum(faded(differences(image, 0, 1, taper.tiles_y), taper));
  std::size_t i = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x, ++i) {
      if (i > 0)
        sum.power[i] =
            (sum.power[i] + down.power[i]) / (squared_sine(x, image.width) + squared_sine(y, image.height));
    }
  }
  return sum;
}

// Where both agree so well, the values are taken, whose periodogram scatters less.
constexpr double kNegligibleLeakage = 0.02;

void add_power(PowerSpectrum& sum, const PowerSpectrum& other) {
  for (std::size_t i = 0; i < sum.power.size(); ++i) sum.power[i] += other.power[i];
}

// Brings the variance to that of the pixels. A difference that chance explains, and a surplus, is spread over
// all frequencies. Chance moves the sum of the power by some root of the sum of its squares.
void scale_to_pixels(PowerSpectrum& spectrum, double variance) {
  const double lacking = variance - spectrum.variance();
  double squares = 0.0;
  for (const double p : spectrum.power) squares += p * p;
  if (lacking > std::sqrt(squares) / static_cast<double>(spectrum.power.size())) {
    add_to_lowest_octave(spectrum, lacking);
    spectrum.wider_variance = lacking;
    return;
  }
  const double gain = spectrum.variance() > 0.0 ? variance / spectrum.variance() : 0.0;
  for (double& p : spectrum.power) p *= gain;
}

}  // namespace

void TaperedPower::add(const TaperedPower& other) {
  if (values.power.empty()) {
    *this = other;
    return;
  }
  add_power(values, other.values);
  add_power(slopes, other.slopes);
  variance += other.variance;
}

void TaperedPower::divide(double count) {
  for (double& p : values.power) p /= count;
  for (double& p : slopes.power) p /= count;
  variance /= count;
}

TaperedPower tapered_power(const GreyImage& image) {
  const BorderTaper taper = taper_of(image);
  TaperedPower result{power_spectrum(faded(image, taper)), slope_power(image, taper),
                      variance_of(image.values)};
  result.values.averages = result.slopes.averages = taper.looks();
  return result;
}

PowerSpectrum least_leaky(const TaperedPower& power) {
  const std::vector<double> positions = octave_positions(power.values);
  const std::vector<double> values = power_by_octave(power.values, positions),
                            slopes = power_by_octave(power.slopes, positions);
  PowerSpectrum best = power.values;
  for (std::size_t i = 1; i < positions.size(); ++i) {
    const auto octave = static_cast<std::size_t>(positions[i]);
    if (slopes[octave] < (1.0 - kNegligibleLeakage) * values[octave]) best.power[i] = power.slopes.power[i];
  }
  scale_to_pixels(best, power.variance);
  return best;
}

}  // namespace astrolith
