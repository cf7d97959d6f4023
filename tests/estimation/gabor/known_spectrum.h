// A spectrum that is known, and realisations of it.
#pragma once

#include <cmath>
#include <complex>
#include <vector>

#include "estimation/gabor/fourier_transform.h"
#include "estimation/gabor/grey_image.h"
#include "estimation/gabor/power_spectrum.h"
#include "numerics/hash_random.h"

namespace astrolith::testing {

// weight times a symmetric pair of Gaussians at +-(cx, cy), deviations sx and sy along axes turned by angle.
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

// Three oblique lobes and a broad floor on a 128 x 128 grid, unit variance.
inline PowerSpectrum four_lobe_spectrum() {
  constexpr int n = 128;
  PowerSpectrum s{n, n, {}};
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const double fx = signed_frequency(x, n);
      const double fy = signed_frequency(y, n);
      const bool empty = (x == 0 && y == 0) || x == n / 2 || y == n / 2;
      s.power.push_back(empty ? 0.0
                              : gaussian_pair(fx, fy, 12, 5, 2, 5, 0.4, 1.0) +
                                    gaussian_pair(fx, fy, 0, 25, 4, 3, 0.0, 0.35) +
                                    gaussian_pair(fx, fy, 30, -10, 8, 4, -0.6, 0.08) +
                                    0.02 * std::exp(-(fx * fx + fy * fy) / 1250.0));
    }
  }
  const double variance = s.variance();
  for (double& p : s.power) p /= variance;
  return s;
}

// White Gaussian noise filtered by the square root of the spectrum.
inline GreyImage realisation_of(const PowerSpectrum& spectrum, std::uint64_t seed) {
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

}  // namespace astrolith::testing
