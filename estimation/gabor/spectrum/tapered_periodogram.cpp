#include "estimation/gabor/spectrum/tapered_periodogram.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "estimation/gabor/spectrum/border_taper.h"
#include "estimation/gabor/spectrum/fourier_transform.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

// The differences between neighbours along x or y. Those across a border are left out where it does not
// continue: the taper is next to nothing there.
GreyImage differences(const GreyImage& image, int step_x, int step_y, bool repeats) {
  GreyImage result{image.width, image.height, {}};
  result.values.reserve(image.values.size());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int x1 = x + step_x, y1 = y + step_y;
      const bool across = x1 == image.width || y1 == image.height;
      const double next = across && !repeats ? image.at(x, y) : image.at(x1 % image.width, y1 % image.height);
      result.values.push_back(next - image.at(x, y));
    }
  }
  return result;
}

double squared_sine(int bin, int n) {
  const double s = 2.0 * std::sin(std::numbers::pi * bin / n);
  return s * s;
}

// The power of an image in the corner of an empty grid, per pixel of the image.
PowerSpectrum power_on_grid(const GreyImage& image, int width, int height) {
  GreyImage grid{width, height,
                 std::vector<double>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
  for (int y = 0; y < image.height; ++y) {
    const auto row = image.values.begin() + static_cast<std::ptrdiff_t>(y) * image.width;
    std::copy(row, row + image.width, grid.values.begin() + static_cast<std::ptrdiff_t>(y) * width);
  }
  PowerSpectrum spectrum = power_spectrum(grid);
  const double gain = static_cast<double>(grid.values.size()) / static_cast<double>(image.values.size());
  for (double& p : spectrum.power) p *= gain;
  return spectrum;
}

PowerSpectrum slope_power(const GreyImage& image, const BorderTaper& taper, int width, int height) {
  PowerSpectrum sum = power_on_grid(faded(differences(image, 1, 0, taper.repeats_x), taper), width, height);
  const PowerSpectrum down =
      power_on_grid(faded(differences(image, 0, 1, taper.repeats_y), taper), width, height);
  std::size_t i = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x, ++i) {
      if (i > 0)
        sum.power[i] = (sum.power[i] + down.power[i]) / (squared_sine(x, width) + squared_sine(y, height));
    }
  }
  return sum;
}

// Where both agree so well, the values are taken, whose periodogram scatters less.
constexpr double kNegligibleLeakage = 0.02;

void add_power(PowerSpectrum& sum, const PowerSpectrum& other) {
  for (std::size_t i = 0; i < sum.power.size(); ++i) sum.power[i] += other.power[i];
}

// Takes a surplus of variance over the pixels' away, and what the spectrum lacks if chance explains it:
// chance moves the sum of the power by some root of the sum of its squares.
void scale_to_pixels(PowerSpectrum& spectrum, double variance) {
  double squares = 0.0;
  for (const double p : spectrum.power) squares += p * p;
  const double chance = std::sqrt(squares) / static_cast<double>(spectrum.power.size());
  const double has = spectrum.variance();
  if (variance - has > chance || !(has > 0.0)) return;
  for (double& p : spectrum.power) p *= variance / has;
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

TaperedPower tapered_power(const GreyImage& image, int width, int height) {
  BorderTaper taper = make_taper(image);
  if (width > image.width) taper.fade_columns();
  if (height > image.height) taper.fade_rows();
  TaperedPower result{power_on_grid(faded(image, taper), width, height),
                      slope_power(image, taper, width, height), sample_variance(image.values)};
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
