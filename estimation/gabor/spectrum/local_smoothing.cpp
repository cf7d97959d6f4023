#include "estimation/gabor/spectrum/local_smoothing.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

#include "estimation/gabor/spectrum/fourier_transform.h"

namespace astrolith {
namespace {

constexpr double kAveragingBins = 2.0;  // deviation of the averages, bins of 1 / sqrt(width * height)
constexpr double kLeastGain = 3.0;      // of the criterion

// Convolves grids of frequencies with a Gaussian.
class GridBlur {
 public:
  GridBlur(int width, int height) : fourier_(width, height), half_(fourier_.half_size()) {}

  void blur(std::vector<double>& grid, double deviation) {
    fourier_.forward(grid, half_);
    const double scale = -2.0 * std::numbers::pi * std::numbers::pi * deviation * deviation /
                         static_cast<double>(fourier_.grid_size());
    std::size_t i = 0;
    for (int y = 0; y < fourier_.height(); ++y) {
      const double ky = signed_frequency(y, fourier_.height());
      for (int x = 0; x < fourier_.half_width(); ++x, ++i) half_[i] *= std::exp(scale * (ky * ky + x * x));
    }
    fourier_.inverse(half_, grid);
  }

 private:
  FourierTransform fourier_;
  std::vector<std::complex<double>> half_;
};

// The mean criterion of a spline about each bin. Frequency 0 holds no data.
class LocalCriterion {
 public:
  explicit LocalCriterion(const PowerSpectrum& data)
      : data_(data), blur_(data.width, data.height), weight_(data.power.size(), 1.0) {
    weight_[0] = 0.0;
    blur_.blur(weight_, kAveragingBins);
  }

  std::vector<double> operator()(const SplineChoice& spline) {
    std::vector<double> mean(weight_.size(), 0.0);
    for (std::size_t i = 1; i < mean.size(); ++i) {
      mean[i] = data_.averages * (spline.g[i] + data_.power[i] * std::exp(-spline.g[i]));
    }
    blur_.blur(mean, kAveragingBins);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = mean[i] / weight_[i] + spline.parameters;
    return mean;
  }
  void blur(std::vector<double>& grid, double deviation) { blur_.blur(grid, deviation); }

 private:
  const PowerSpectrum& data_;
  GridBlur blur_;
  std::vector<double> weight_;
};

// The bin of -f for the bin of f.
std::size_t mirror_image(std::size_t bin, const PowerSpectrum& grid) {
  const auto w = static_cast<std::size_t>(grid.width), h = static_cast<std::size_t>(grid.height);
  return (h - bin / w) % h * w + (w - bin % w) % w;
}

}  // namespace

std::vector<double> locally_chosen_splines(const PowerSpectrum& data,
                                           const std::vector<SplineChoice>& splines,
                                           std::vector<double> by_octave) {
  LocalCriterion criterion(data);
  std::vector<double> given(by_octave.size()), least;  // the criteria of by_octave, and of the best spline
  std::vector<std::size_t> best(by_octave.size(), 0);
  for (std::size_t k = 0; k < splines.size(); ++k) {
    std::vector<double> mean = criterion(splines[k]);
    for (std::size_t i = 0; i < mean.size(); ++i) {
      if (static_cast<std::size_t>(std::lround(by_octave[i])) == k) given[i] = mean[i];
      if (k > 0 && mean[i] < least[i]) best[i] = k;
    }
    if (k == 0)
      least = std::move(mean);
    else
      std::transform(least.begin(), least.end(), mean.begin(), least.begin(),
                     [](double a, double b) { return std::min(a, b); });
  }
  // A bin and its mirror image hold the same data, so that half of the bins count.
  constexpr double kBins = 0.5 * 4.0 * std::numbers::pi * kAveragingBins * kAveragingBins;
  for (std::size_t i = 0; i < best.size(); ++i) {
    // Rounding must not part a bin from its mirror image.
    const std::size_t first = std::min(i, mirror_image(i, data));
    if (first < i) {
      by_octave[i] = by_octave[first];
    } else if ((given[i] - least[i]) * kBins > kLeastGain) {
      by_octave[i] = static_cast<double>(best[i]);
    }
  }
  criterion.blur(by_octave, 0.5 * kAveragingBins);
  const double last = static_cast<double>(splines.size() - 1);
  for (double& index : by_octave) index = std::clamp(index, 0.0, last);
  return by_octave;
}

}  // namespace astrolith
