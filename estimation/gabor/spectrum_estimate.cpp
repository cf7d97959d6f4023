#include "estimation/gabor/spectrum_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimation/gabor/fourier_transform.h"
#include "estimation/gabor/gabor_dictionary.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// Kernel deviations tried, in bins, a factor of sqrt(2) apart.
constexpr double kDeviations[] = {0.5, 0.7071, 1.0, 1.4142, 2.0, 2.8284, 4.0, 5.6569, 8.0, 11.314};
constexpr std::size_t kKernels = std::size(kDeviations);

double bins_per_cycle(const PowerSpectrum& s) { return std::sqrt(static_cast<double>(s.width) * s.height); }

// |f| of every grid point in bins, row-major.
std::vector<double> radii(const PowerSpectrum& s) {
  std::vector<double> radius;
  radius.reserve(s.power.size());
  for (int y = 0; y < s.height; ++y) {
    const double fy = static_cast<double>(signed_frequency(y, s.height)) / s.height;
    for (int x = 0; x < s.width; ++x) {
      const double fx = static_cast<double>(signed_frequency(x, s.width)) / s.width;
      radius.push_back(std::hypot(fx, fy) * bins_per_cycle(s));
    }
  }
  return radius;
}

// A periodic Gaussian kernel with unit sum, and what smoothing with it gives.
struct SmoothedGrid {
  std::vector<double> kernel_x, kernel_y;
  std::vector<double> values;   // kernel * data / kernel * mask
  std::vector<double> support;  // kernel * mask: the share of the kernel that saw data
};

std::vector<double> unit_kernel(int n, double deviation) {
  std::vector<double> kernel = periodic_gaussian(n, 0.0, deviation);
  double sum = 0.0;
  for (const double k : kernel) sum += k;
  for (double& k : kernel) k /= sum;
  return kernel;
}

SmoothedGrid smooth(const PowerSpectrum& data, const FourierTransform& fourier, double deviation_bins) {
  SmoothedGrid result;
  const double deviation = deviation_bins / bins_per_cycle(data);
  result.kernel_x = unit_kernel(data.width, deviation * data.width);
  result.kernel_y = unit_kernel(data.height, deviation * data.height);
  std::vector<double> grid(data.power.size());
  const auto w = static_cast<std::size_t>(data.width);
  for (std::size_t i = 0; i < grid.size(); ++i) grid[i] = result.kernel_x[i % w] * result.kernel_y[i / w];
  std::vector<std::complex<double>> kernel(fourier.half_size());
  std::vector<std::complex<double>> half(fourier.half_size());
  fourier.forward(grid, kernel);
  grid = data.power;
  grid[0] = 0.0;
  fourier.forward(grid, half);
  for (std::size_t i = 0; i < half.size(); ++i) half[i] *= kernel[i];
  result.values.resize(grid.size());
  fourier.inverse(half, result.values);
  // The mask is one everywhere but at frequency 0, so its smoothing is known.
  result.support.resize(grid.size());
  for (std::size_t i = 0; i < grid.size(); ++i) {
    result.support[i] = 1.0 - result.kernel_x[i % w] * result.kernel_y[i / w];
    // Transforms round: a sum of non-negative numbers must stay so.
    result.values[i] = std::max(0.0, result.values[i]) / std::max(result.support[i], 1e-12);
  }
  return result;
}

// Whittle's score of every bin under the prediction from all bins but itself and its mirror image, which
// holds the same number, summed by octave of |f|.
std::vector<double> octave_scores(const PowerSpectrum& data, const SmoothedGrid& smoothed,
                                  const std::vector<double>& radius, double floor) {
  std::vector<double> scores;
  const auto w = static_cast<std::size_t>(data.width);
  const auto h = static_cast<std::size_t>(data.height);
  for (std::size_t i = 1; i < data.power.size(); ++i) {
    const std::size_t x = i % w;
    const std::size_t y = i / w;
    const bool own_mirror = (w - x) % w == x && (h - y) % h == y;
    const double self = smoothed.kernel_x[0] * smoothed.kernel_y[0] +
                        (own_mirror ? 0.0 : smoothed.kernel_x[2 * x % w] * smoothed.kernel_y[2 * y % h]);
    const double others = smoothed.support[i] - self;
    double predicted = std::numeric_limits<double>::infinity();
    if (others > 1e-9) {
      predicted = (smoothed.values[i] * smoothed.support[i] - self * data.power[i]) / others;
    }
    predicted = std::max(predicted, floor);
    const auto octave = static_cast<std::size_t>(std::max(0.0, std::floor(std::log2(radius[i]))));
    if (scores.size() <= octave) scores.resize(octave + 1, 0.0);
    scores[octave] += std::log(predicted) + data.power[i] / predicted;
  }
  return scores;
}

// Position of a radius among octave centres, for linear interpolation: octave o is centred at 2^(o + 1/2).
double octave_position(double radius, std::size_t octaves) {
  return std::clamp(std::log2(std::max(radius, 1e-9)) - 0.5, 0.0, static_cast<double>(octaves - 1));
}

}  // namespace

SpectrumEstimate estimate_spectrum(const PowerSpectrum& periodogram) {
  const FourierTransform fourier(periodogram.width, periodogram.height);
  const std::vector<double> radius = radii(periodogram);
  const double floor = 1e-12 * periodogram.variance();
  std::vector<SmoothedGrid> smoothed(kKernels);
  std::vector<std::vector<double>> scores(kKernels);
  parallel_for(0, static_cast<std::int64_t>(kKernels), [&](std::int64_t k) {
    const auto i = static_cast<std::size_t>(k);
    smoothed[i] = smooth(periodogram, fourier, kDeviations[i]);
    scores[i] = octave_scores(periodogram, smoothed[i], radius, floor);
  });

  SpectrumEstimate estimate{periodogram, {}};
  std::vector<double> choice;  // index into kDeviations by octave
  for (std::size_t octave = 0; octave < scores[0].size(); ++octave) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < kKernels; ++k) {
      if (scores[k][octave] < scores[best][octave]) best = k;
    }
    choice.push_back(static_cast<double>(best));
    estimate.smoothing.push_back(
        {std::exp2(static_cast<double>(octave) + 0.5) / bins_per_cycle(periodogram), kDeviations[best]});
  }
  for (std::size_t i = 1; i < periodogram.power.size(); ++i) {
    const double position = octave_position(radius[i], choice.size());
    const auto lower = static_cast<std::size_t>(position);
    const std::size_t upper = std::min(lower + 1, choice.size() - 1);
    const double kernel = std::lerp(choice[lower], choice[upper], position - static_cast<double>(lower));
    const auto narrow = static_cast<std::size_t>(kernel);
    const std::size_t wide = std::min(narrow + 1, kKernels - 1);
    estimate.spectrum.power[i] =
        std::max(floor, std::lerp(smoothed[narrow].values[i], smoothed[wide].values[i],
                                  kernel - static_cast<double>(narrow)));
  }
  estimate.spectrum.power[0] = 0.0;
  const double gain = periodogram.variance() / estimate.spectrum.variance();
  for (double& p : estimate.spectrum.power) p *= gain;
  return estimate;
}

}  // namespace astrolith
