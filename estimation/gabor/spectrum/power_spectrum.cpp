#include "estimation/gabor/spectrum/power_spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "estimation/gabor/spectrum/border_taper.h"
#include "estimation/gabor/spectrum/fourier_transform.h"
#include "estimation/gabor/spectrum/tapered_periodogram.h"
#include "numerics/errors.h"

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

// The first pixels of half-overlapping segments that are evenly spread over 0 .. extent-1.
std::vector<int> segment_starts(int extent, int segment) {
  const int steps = segment >= extent ? 0 : (2 * (extent - segment) + segment - 1) / segment;
  std::vector<int> starts{0};
  for (int i = 1; i <= steps; ++i) {
    starts.push_back(static_cast<int>(static_cast<std::int64_t>(extent - segment) * i / steps));
  }
  return starts;
}

// The variance of the mean of the periodograms of segments along one axis, over that of one periodogram.
// Segments that overlap share pixels, so their periodograms have the correlation |sum w w'|^2 / (sum w^2)^2,
// where w' are the weights w of the other segment (Welch 1967).
double scatter_along(const std::vector<int>& starts, int segment) {
  const auto n = static_cast<std::size_t>(segment);
  const std::vector<double> weight = border_fading(segment);
  double energy = 0.0;
  for (const double w : weight) energy += w * w;
  double sum = 0.0;
  for (const int a : starts) {
    for (const int b : starts) {
      double shared = 0.0;
      for (std::size_t i = static_cast<std::size_t>(std::abs(a - b)), j = 0; i < n; ++i, ++j)
        shared += weight[i] * weight[j];
      sum += shared * shared / (energy * energy);
    }
  }
  return sum / static_cast<double>(starts.size() * starts.size());
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

double PowerSpectrum::variance() const {
  double sum = 0.0;
  for (const double p : power) sum += p;
  return sum / static_cast<double>(power.size());
}

PowerSpectrum power_spectrum(const GreyImage& image) {
  const FourierTransform fourier(image.width, image.height);
  std::vector<std::complex<double>> half(fourier.half_size());
  fourier.forward(image.values, half);
  half[0] = 0.0;
  PowerSpectrum spectrum{image.width, image.height, std::vector<double>(image.values.size())};
  const double scale = 1.0 / static_cast<double>(image.values.size());
  std::size_t i = 0;
  for (int ky = 0; ky < image.height; ++ky) {
    for (int kx = 0; kx < image.width; ++kx, ++i) {
      const bool kept = kx < fourier.half_width();
      const int hx = kept ? kx : image.width - kx;
      const int hy = kept ? ky : (image.height - ky) % image.height;
      spectrum.power[i] =
          scale *
          std::norm(half[static_cast<std::size_t>(hy) * static_cast<std::size_t>(fourier.half_width()) +
                         static_cast<std::size_t>(hx)]);
    }
  }
  return spectrum;
}

PowerSpectrum exemplar_periodogram(const GreyImage& image, int largest_side, const Progress& progress) {
  const int segment_width = std::min(image.width, largest_side);
  const int segment_height = std::min(image.height, largest_side);
  const std::vector<int> xs = segment_starts(image.width, segment_width);
  const std::vector<int> ys = segment_starts(image.height, segment_height);
  TaperedPower sum;
  std::size_t taken = 0;
  for (const int y : ys) {
    for (const int x : xs) {
      const double done = static_cast<double>(taken++) / static_cast<double>(xs.size() * ys.size());
      if (!report(progress, done, "spectrum of the photo")) {
        throw WorkError("stopped before the spectrum was known; nothing is written");
      }
      sum.add(tapered_power(image.part(x, y, segment_width, segment_height), segment_width, segment_height));
    }
  }
  const std::size_t segments = xs.size() * ys.size();
  sum.divide(static_cast<double>(segments));
  PowerSpectrum mean = least_leaky(sum);
  if (segments == 1) return mean;
  // Segments that overlap share pixels, so the number of independent looks is that of segments side by side.
  mean.averages = static_cast<double>(image.values.size()) / static_cast<double>(mean.power.size());
  mean.scatter = scatter_along(xs, segment_width) * scatter_along(ys, segment_height);
  return mean;
}

}  // namespace astrolith
