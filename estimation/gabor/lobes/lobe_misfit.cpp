#include "estimation/gabor/lobes/lobe_misfit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimation/gabor/pursuit/gabor_dictionary.h"
#include "numerics/parallel_for.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

// One axis of a lobe at the bins where it is not negligible, and its derivative by the centre in deviations.
struct AxisProfile {
  std::vector<std::size_t> bins;
  std::vector<double> values;
  std::vector<double> slopes;
};

AxisProfile axis_profile(int n, double center, double deviation) {
  constexpr double kReach = 5.0;  // deviations; beyond, the Gaussian is below 4e-6 of its peak
  AxisProfile profile;
  const auto first = static_cast<int>(std::ceil(center - kReach * deviation));
  const auto last = static_cast<int>(std::floor(center + kReach * deviation));
  if (last - first + 1 >= n) {  // the Gaussian covers every bin, and its periodic images add up
    profile.values.assign(static_cast<std::size_t>(n), 0.0);
    profile.slopes = profile.values;
    for (int i = 0; i < n; ++i) profile.bins.push_back(static_cast<std::size_t>(i));
  }
  for (int i = first; i <= last; ++i) {
    const double t = (i - center) / deviation;
    const double g = std::exp(-0.5 * t * t);
    const auto bin = static_cast<std::size_t>(((i % n) + n) % n);
    if (last - first + 1 >= n) {
      profile.values[bin] += g;
      profile.slopes[bin] += t * g;
    } else {
      profile.bins.push_back(bin);
      profile.values.push_back(g);
      profile.slopes.push_back(t * g);
    }
  }
  return profile;
}

struct LobeOnGrid {
  AxisProfile x, y;
  double height = 0.0;
};

LobeOnGrid on_grid(const SpectralLobe& lobe, int width, int height) {
  const double deviation = lobe_deviation(lobe.bandwidth);
  return {axis_profile(width, lobe.x * width, deviation * width),
          axis_profile(height, lobe.y * height, deviation * height), lobe.height};
}

// The sum over the lobes of their Gaussians at +c. Those at -c are mirror images.
std::vector<double> sum_of_halves(const std::vector<LobeOnGrid>& lobes, int width, int height) {
  std::vector<std::vector<std::pair<const LobeOnGrid*, double>>> by_row(static_cast<std::size_t>(height));
  for (const LobeOnGrid& lobe : lobes) {
    for (std::size_t k = 0; k < lobe.y.bins.size(); ++k) {
      by_row[lobe.y.bins[k]].emplace_back(&lobe, lobe.height * lobe.y.values[k]);
    }
  }
  std::vector<double> grid(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0);
  parallel_for(0, height, [&](std::int64_t y) {
    double* row = grid.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    for (const auto& [lobe, factor] : by_row[static_cast<std::size_t>(y)]) {
      for (std::size_t k = 0; k < lobe->x.bins.size(); ++k)
        row[lobe->x.bins[k]] += factor * lobe->x.values[k];
    }
  });
  return grid;
}

// The sums over the grid of weight times a lobe's Gaussian at +c, and times its derivatives.
struct LobeSums {
  double value = 0.0, slope_x = 0.0, slope_y = 0.0;
};

LobeSums sums_over(const LobeOnGrid& lobe, const std::vector<double>& weight, int width) {
  LobeSums sums;
  for (std::size_t ky = 0; ky < lobe.y.bins.size(); ++ky) {
    const double* row = weight.data() + lobe.y.bins[ky] * static_cast<std::size_t>(width);
    double value = 0.0;
    double slope = 0.0;
    for (std::size_t kx = 0; kx < lobe.x.bins.size(); ++kx) {
      value += row[lobe.x.bins[kx]] * lobe.x.values[kx];
      slope += row[lobe.x.bins[kx]] * lobe.x.slopes[kx];
    }
    sums.value += value * lobe.y.values[ky];
    sums.slope_x += slope * lobe.y.values[ky];
    sums.slope_y += value * lobe.y.slopes[ky];
  }
  return sums;
}

double wrapped(double frequency) { return frequency - std::floor(frequency + 0.5); }

}  // namespace

LobeMisfit::LobeMisfit(std::vector<SpectralLobe> start, const PowerSpectrum& target,
                       const std::vector<double>& weights)
    : start_(std::move(start)),
      width_(target.width),
      height_(target.height),
      total_(sum_of_products(weights, target.power)),
      weights_(weights) {
  offset_ = 1e-6 * total_ / static_cast<double>(target.power.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    target_roots_.push_back(std::sqrt(weights[i] * target.power[i] + offset_));
  }
}

std::vector<SpectralLobe> LobeMisfit::lobes_at(std::span<const double> parameters) const {
  std::vector<SpectralLobe> lobes = start_;
  for (std::size_t j = 0; j < lobes.size(); ++j) {
    const double deviation = lobe_deviation(lobes[j].bandwidth);
    lobes[j].x = wrapped(lobes[j].x + deviation * parameters[3 * j]);
    lobes[j].y = wrapped(lobes[j].y + deviation * parameters[3 * j + 1]);
    lobes[j].height *= std::exp(parameters[3 * j + 2]);
  }
  return lobes;
}

double LobeMisfit::operator()(std::span<const double> parameters, std::span<double> gradient) const {
  std::vector<LobeOnGrid> lobes;
  for (const SpectralLobe& lobe : lobes_at(parameters)) {
    if (!std::isfinite(lobe.x + lobe.y + lobe.height)) return std::numeric_limits<double>::infinity();
    lobes.push_back(on_grid(lobe, width_, height_));
  }
  const std::vector<double> halves = sum_of_halves(lobes, width_, height_);
  std::vector<double> weight(halves.size(), 0.0);  // derivative of the misfit by S
  double misfit = 0.0;
  const auto w = static_cast<std::size_t>(width_);
  const auto h = static_cast<std::size_t>(height_);
  for (std::size_t i = 1; i < halves.size(); ++i) {
    const std::size_t mirror = (h - i / w) % h * w + (w - i % w) % w;
    const double root = std::sqrt(weights_[i] * (halves[i] + halves[mirror]) + offset_);
    const double difference = root - target_roots_[i];
    misfit += difference * difference;
    weight[i] = weights_[i] * difference / root;
  }
  if (!gradient.empty()) {
    parallel_for(0, static_cast<std::int64_t>(lobes.size()), [&](std::int64_t i) {
      const auto j = static_cast<std::size_t>(i);
      const LobeSums sums = sums_over(lobes[j], weight, width_);
      const double both = 2.0 * lobes[j].height / total_;  // both halves give the same
      gradient[3 * j] = both * sums.slope_x;
      gradient[3 * j + 1] = both * sums.slope_y;
      gradient[3 * j + 2] = both * sums.value;
    });
  }
  return misfit / total_;
}

}  // namespace astrolith
