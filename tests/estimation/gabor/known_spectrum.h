// Known spectra, and realisations of them.
#pragma once

#include <cmath>
#include <complex>
#include <functional>
#include <string>
#include <vector>

#include "estimation/gabor/image/grey_image.h"
#include "estimation/gabor/lobes/lobe_selection.h"
#include "estimation/gabor/spectrum/fourier_transform.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "numerics/hash_random.h"

namespace astrolith::testing {

// The spectrum of lobes on a grid of width x height.
inline PowerSpectrum lobe_sum(const std::vector<SpectralLobe>& lobes, int width, int height) {
  std::vector<GaborLobe> layer;
  for (const SpectralLobe& lobe : lobes) {
    layer.push_back({lobe.bandwidth, lobe.x, lobe.y, lobe_variance(lobe, width, height)});
  }
  return layer_spectrum(layer, width, height);
}

// weight times a symmetric pair of Gaussians at +-(cx, cy) with deviations sx and sy along axes turned by
// angle.
inline double gaussian_pair(double fx, double fy, double cx, double cy, double sx, double sy, double angle,
                            double weight) {
  double sum = 0.0;
  for (const double sign : {1.0, -1.0}) {
    const double dx = fx - sign * cx;
    const double dy = fy - sign * cy;
    const double u = (dx * std::cos(angle) + dy * std::sin(angle)) / sx;
    const double v = (-dx * std::sin(angle) + dy * std::cos(angle)) / sy;
    sum += std::exp(-0.5 * (u * u + v * v));
  }
  return weight * sum;
}

// The spectrum of unit variance that a function of integer frequencies gives on a 128 x 128 grid. It is zero
// at frequency 0 and in the Nyquist row and column.
inline PowerSpectrum spectrum_from(const std::function<double(double fx, double fy)>& power) {
  constexpr int n = 128;
  PowerSpectrum s{n, n, {}};
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const bool empty = (x == 0 && y == 0) || x == n / 2 || y == n / 2;
      s.power.push_back(empty ? 0.0 : power(signed_frequency(x, n), signed_frequency(y, n)));
    }
  }
  const double variance = s.variance();
  for (double& p : s.power) p /= variance;
  return s;
}

// Three oblique lobes and a broad floor.
inline PowerSpectrum four_lobe_spectrum() {
  return spectrum_from([](double fx, double fy) {
    return gaussian_pair(fx, fy, 12, 5, 2, 5, 0.4, 1.0) + gaussian_pair(fx, fy, 0, 25, 4, 3, 0.0, 0.35) +
           gaussian_pair(fx, fy, 30, -10, 8, 4, -0.6, 0.08) + 0.02 * std::exp(-(fx * fx + fy * fy) / 1250.0);
  });
}

// The spectrum of grains of one size without a preferred direction.
inline double ring_power(double fx, double fy) {
  const double r = std::hypot(fx, fy);
  return std::exp(-(r - 20) * (r - 20) / 18) + 0.02 * std::exp(-r * r / 1250.0);
}
inline PowerSpectrum ring_spectrum() { return spectrum_from(ring_power); }

// The spectrum of a height map: it falls as 1 / f^3 beyond two cycles per image.
inline PowerSpectrum steep_spectrum() {
  return spectrum_from([](double fx, double fy) { return std::pow(1.0 + (fx * fx + fy * fy) / 4.0, -1.5); });
}

// The spectrum of a smooth height map: nine tenths of its power lie below three cycles per image.
inline PowerSpectrum smooth_spectrum() {
  return spectrum_from([](double fx, double fy) { return std::pow(1.0 + fx * fx + fy * fy, -2.0); });
}

// Two long and narrow ridges, as fibres or layers have.
inline PowerSpectrum line_spectrum() {
  return spectrum_from([](double fx, double fy) {
    return gaussian_pair(fx, fy, 18, 6, 1.2, 12, 0.3, 1.0) +
           gaussian_pair(fx, fy, -10, 22, 10, 1.2, 0.3, 0.5) + 0.01 * std::exp(-(fx * fx + fy * fy) / 1800.0);
  });
}

// A broad oblique hill and a patch near the Nyquist corner.
inline PowerSpectrum broad_spectrum() {
  return spectrum_from([](double fx, double fy) {
    return gaussian_pair(fx, fy, 0, 0, 24, 8, 0.7, 0.5) + gaussian_pair(fx, fy, 45, 30, 4, 4, 0.0, 0.3) +
           0.003;
  });
}

// The lobes of the only spectrum here that Gabor lobes can match exactly.
inline std::vector<SpectralLobe> eight_lobes() {
  return {{5, 10.3 / 128, 4.2 / 128, 1.0},   {4, 9.1 / 128, 12.6 / 128, 0.5},
          {4, -20.4 / 128, 8.7 / 128, 0.3},  {6, 3.3 / 128, 1.2 / 128, 3.0},
          {3, 31.2 / 128, 25.1 / 128, 0.05}, {2, 0.0, 0.0, 0.03},
          {5, -7.7 / 128, 30.3 / 128, 0.4},  {4, 40.1 / 128, -2.2 / 128, 0.08}};
}
inline PowerSpectrum eight_lobe_spectrum() {
  return spectrum_from([](double fx, double fy) {
    double sum = 0.0;
    for (const SpectralLobe& lobe : eight_lobes()) {
      const double deviation = 128 * lobe_deviation(lobe.bandwidth);
      sum += gaussian_pair(fx, fy, 128 * lobe.x, 128 * lobe.y, deviation, deviation, 0.0, lobe.height);
    }
    return sum;
  });
}

struct NamedSpectrum {
  std::string name;
  PowerSpectrum spectrum;
};

// Spectra of different kinds, with most power in many bins.
inline std::vector<NamedSpectrum> known_spectra() {
  return {{"four lobes", four_lobe_spectrum()}, {"ring", ring_spectrum()},
          {"steep", steep_spectrum()},          {"lines", line_spectrum()},
          {"broad", broad_spectrum()},          {"eight Gabor lobes", eight_lobe_spectrum()}};
}

// White Gaussian noise filtered by the square root of the spectrum.
inline GreyImage draw_realisation(const PowerSpectrum& spectrum, std::uint64_t seed) {
  CounterRandom random(seed);
  GreyImage image{spectrum.width, spectrum.height, std::vector<double>(spectrum.power.size())};
  for (double& v : image.values) v = random.normal();
  const FourierTransform fourier(spectrum.width, spectrum.height);
  std::vector<std::complex<double>> half(fourier.half_size());
  fourier.forward(image.values, half);
  for (int y = 0; y < spectrum.height; ++y) {
    for (int x = 0; x < fourier.half_width(); ++x) {
      half[static_cast<std::size_t>(y * fourier.half_width() + x)] *=
          std::sqrt(spectrum.power[static_cast<std::size_t>(y * spectrum.width + x)]);
    }
  }
  fourier.inverse(half, image.values);
  return image;
}

// A 128 x 128 corner of a realisation four times as large, so that its borders do not match, and the true
// spectrum on the corner's grid.
struct CutTexture {
  GreyImage image;
  PowerSpectrum truth;
};
inline CutTexture unscaled_cut(const std::function<double(double fx, double fy)>& power, std::uint64_t seed) {
  constexpr int n = 128;
  constexpr int large = 4 * n;
  PowerSpectrum whole{large, large, {}};
  for (int y = 0; y < large; ++y) {
    for (int x = 0; x < large; ++x) {
      whole.power.push_back(
          x + y == 0 ? 0.0 : power(signed_frequency(x, large) / 4.0, signed_frequency(y, large) / 4.0));
    }
  }
  const GreyImage texture = draw_realisation(whole, seed);
  CutTexture cut{{n, n, {}}, {n, n, {}}};
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      cut.image.values.push_back(texture.at(x, y));
      cut.truth.power.push_back(x + y == 0 ? 0.0 : power(signed_frequency(x, n), signed_frequency(y, n)));
    }
  }
  return cut;
}

// A cut whose truth is scaled to the variance of the image, and 0 at half a cycle per pixel.
inline CutTexture cut_realisation(const std::function<double(double fx, double fy)>& power,
                                  std::uint64_t seed) {
  CutTexture cut = unscaled_cut(power, seed);
  cut.truth = spectrum_from(power);
  const double variance = power_spectrum(cut.image).variance();
  for (double& p : cut.truth.power) p *= variance;
  return cut;
}

}  // namespace astrolith::testing
