#include "estimation/gabor/pursuit/gabor_dictionary.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// Two unit Gaussians a distance t apart correlate by exp(-t^2 / (4 deviation^2)).
int lattice_stride(double deviation_bins) {
  constexpr double kLargestCorrelation = 0.95;
  return std::max(
      1, static_cast<int>(std::ceil(2.0 * deviation_bins * std::sqrt(-std::log(kLargestCorrelation)))));
}

// Transform of a periodic Gaussian centred at bin 0: real, because the Gaussian is even.
std::vector<double> gaussian_transform(int n, double deviation) {
  const FourierTransform fourier(n, 1);
  const std::vector<double> gaussian = periodic_gaussian(n, 0.0, deviation);
  std::vector<std::complex<double>> half(fourier.half_size());
  fourier.forward(gaussian, half);
  std::vector<double> transform(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) transform[static_cast<std::size_t>(k)] = half[std::min(k, n - k)].real();
  return transform;
}

// The same for the squared periodic Gaussian.
std::vector<double> squared_gaussian_transform(int n, double deviation) {
  const FourierTransform fourier(n, 1);
  std::vector<double> squared = periodic_gaussian(n, 0.0, deviation);
  for (double& g : squared) g *= g;
  std::vector<std::complex<double>> half(fourier.half_size());
  fourier.forward(squared, half);
  std::vector<double> transform(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) transform[static_cast<std::size_t>(k)] = half[std::min(k, n - k)].real();
  return transform;
}

// sum over h of one parity of exp(-((m + h n/2) / deviation)^2): how a lobe and its mirror image, both
// periodic, overlap. The product g(f - m) g(f + m) is a sum over parities of such a factor in f and one in m.
double mirror_overlap(double m, int n, double deviation, int parity) {
  const int reach = static_cast<int>(std::ceil(2.0 * (6.5 * deviation + std::abs(m)) / n)) + 2;
  double sum = 0.0;
  for (int h = -reach; h <= reach; ++h) {
    if ((h & 1) != parity) continue;
    const double t = (m + 0.5 * h * n) / deviation;
    sum += std::exp(-t * t);
  }
  return sum;
}

}  // namespace

double lobe_deviation(int bandwidth) {
  return std::ldexp(1.0, -bandwidth) / (2.0 * std::sqrt(2.0 * std::numbers::ln2));
}

std::vector<double> periodic_gaussian(int n, double center, double deviation) {
  const int reach = static_cast<int>(std::ceil((9.0 * deviation + std::abs(center)) / n)) + 1;
  std::vector<double> gaussian(static_cast<std::size_t>(n), 0.0);
  for (int i = 0; i < n; ++i) {
    for (int k = -reach; k <= reach; ++k) {
      const double t = (i - center + static_cast<double>(k) * n) / deviation;
      gaussian[static_cast<std::size_t>(i)] += std::exp(-0.5 * t * t);
    }
  }
  return gaussian;
}

int narrowest_bandwidth(int width, int height) {
  return std::min(12, static_cast<int>(std::floor(std::log2(std::hypot(width, height)))));
}

GaborDictionary::GaborDictionary(int width, int height, int lowest_bandwidth, int highest_bandwidth,
                                 std::vector<double> weight)
    : fourier_(width, height),
      weight_(std::move(weight)),
      half_(fourier_.half_size()),
      grid_(fourier_.grid_size()) {
  if (weight_.size() != rows()) throw WorkError("Gabor dictionary: weights do not match the grid");
  for (int b = lowest_bandwidth; b <= highest_bandwidth; ++b) add_band(b);
  scale_.assign(atoms_.size(), 1.0);
  normalize_columns();
}

void GaborDictionary::add_band(int bandwidth) {
  const double deviation_x = lobe_deviation(bandwidth) * width();
  const double deviation_y = lobe_deviation(bandwidth) * height();
  const int stride_x = lattice_stride(deviation_x);
  const int stride_y = lattice_stride(deviation_y);
  Band band;
  band.bandwidth = bandwidth;
  band.begin = atoms_.size();
  // One of each pair +-m: the half plane ky > 0, and of the row ky = 0 the half kx >= 0.
  const int last_x = (width() - 1) / 2 / stride_x * stride_x;
  for (int ky = 0; 2 * ky < height(); ky += stride_y) {
    for (int kx = ky == 0 ? 0 : -last_x; kx <= last_x; kx += stride_x) {
      // The mean of an image hides frequency 0: a lobe narrower than a bin there would be all guess.
      if (kx == 0 && ky == 0 && std::min(deviation_x, deviation_y) < 1.0) continue;
      atoms_.push_back({bandwidth, kx, ky});
    }
  }
  band.end = atoms_.size();
  band.transform_x = gaussian_transform(width(), deviation_x);
  band.transform_y = gaussian_transform(height(), deviation_y);
  band.grid.resize(rows());
  band.half.resize(fourier_.half_size());
  bands_.push_back(std::move(band));
}

std::size_t GaborDictionary::row(int kx, int ky) const {
  return static_cast<std::size_t>(frequency_bin(ky, height())) * static_cast<std::size_t>(width()) +
         static_cast<std::size_t>(frequency_bin(kx, width()));
}

void GaborDictionary::filter(const std::vector<double>& transform_x, const std::vector<double>& transform_y,
                             std::span<std::complex<double>> half) const {
  std::size_t i = 0;
  for (int y = 0; y < height(); ++y) {
    const double factor_y = transform_y[static_cast<std::size_t>(y)];
    for (int x = 0; x < fourier_.half_width(); ++x, ++i) {
      half[i] *= factor_y * transform_x[static_cast<std::size_t>(x)];
    }
  }
}

// |W (g(f-m) + g(f+m))|^2 = (W^2 * g^2)(m) + (W^2 * g^2)(-m) + 2 sum_f W^2 g(f-m) g(f+m), and W is symmetric.
void GaborDictionary::normalize_columns() {
  for (std::size_t i = 0; i < rows(); ++i) grid_[i] = weight_[i] * weight_[i];
  const std::vector<double> squared_weight = grid_;
  fourier_.forward(grid_, half_);
  parallel_for(0, static_cast<std::int64_t>(bands_.size()), [&](std::int64_t b) {
    Band& band = bands_[static_cast<std::size_t>(b)];
    const double deviation_x = lobe_deviation(band.bandwidth) * width();
    const double deviation_y = lobe_deviation(band.bandwidth) * height();
    band.half = half_;
    filter(squared_gaussian_transform(width(), deviation_x),
           squared_gaussian_transform(height(), deviation_y), band.half);
    fourier_.inverse(band.half, band.grid);

    double overlap[2][2] = {};  // by parity along y, x: sum of W^2 times the factor in f
    std::vector<double> factor_x[2], factor_y[2];
    for (int parity = 0; parity < 2; ++parity) {
      for (int x = 0; x < width(); ++x) {
        factor_x[parity].push_back(
            mirror_overlap(signed_frequency(x, width()), width(), deviation_x, parity));
      }
      for (int y = 0; y < height(); ++y) {
        factor_y[parity].push_back(
            mirror_overlap(signed_frequency(y, height()), height(), deviation_y, parity));
      }
    }
    const auto at = [](const std::vector<double>& v, int i) { return v[static_cast<std::size_t>(i)]; };
    for (int py = 0; py < 2; ++py) {
      for (int px = 0; px < 2; ++px) {
        for (int y = 0; y < height(); ++y) {
          double sum = 0.0;
          for (int x = 0; x < width(); ++x) sum += squared_weight[row(x, y)] * at(factor_x[px], x);
          overlap[py][px] += sum * at(factor_y[py], y);
        }
      }
    }
    for (std::size_t j = band.begin; j < band.end; ++j) {
      const int x = frequency_bin(atoms_[j].kx, width());
      const int y = frequency_bin(atoms_[j].ky, height());
      double cross = 0.0;
      for (int py = 0; py < 2; ++py) {
        for (int px = 0; px < 2; ++px) cross += overlap[py][px] * at(factor_x[px], x) * at(factor_y[py], y);
      }
      const double squared_norm = band.grid[row(atoms_[j].kx, atoms_[j].ky)] +
                                  band.grid[row(-atoms_[j].kx, -atoms_[j].ky)] + 2.0 * cross;
      scale_[j] = squared_norm > 0.0 ? 1.0 / std::sqrt(squared_norm) : 0.0;
    }
  });
}

void GaborDictionary::synthesize(std::span<const double> x, std::span<double> out) const {
  parallel_for(0, static_cast<std::int64_t>(bands_.size()), [&](std::int64_t b) {
    Band& band = bands_[static_cast<std::size_t>(b)];
    std::fill(band.grid.begin(), band.grid.end(), 0.0);
    bool empty = true;
    for (std::size_t j = band.begin; j < band.end; ++j) {
      if (x[j] == 0.0) continue;
      empty = false;
      band.grid[row(atoms_[j].kx, atoms_[j].ky)] += scale_[j] * x[j];
      band.grid[row(-atoms_[j].kx, -atoms_[j].ky)] += scale_[j] * x[j];
    }
    if (empty) {
      std::fill(band.half.begin(), band.half.end(), 0.0);
      return;
    }
    fourier_.forward(band.grid, band.half);
    filter(band.transform_x, band.transform_y, band.half);
  });
  std::fill(half_.begin(), half_.end(), 0.0);
  for (const Band& band : bands_) {
    for (std::size_t i = 0; i < half_.size(); ++i) half_[i] += band.half[i];
  }
  fourier_.inverse(half_, grid_);
  for (std::size_t i = 0; i < rows(); ++i) out[i] = weight_[i] * grid_[i];
}

void GaborDictionary::analyze(std::span<const double> r, std::span<double> out) const {
  for (std::size_t i = 0; i < rows(); ++i) grid_[i] = weight_[i] * r[i];
  fourier_.forward(grid_, half_);
  parallel_for(0, static_cast<std::int64_t>(bands_.size()), [&](std::int64_t b) {
    Band& band = bands_[static_cast<std::size_t>(b)];
    band.half = half_;
    filter(band.transform_x, band.transform_y, band.half);
    fourier_.inverse(band.half, band.grid);
    for (std::size_t j = band.begin; j < band.end; ++j) {
      out[j] = scale_[j] *
               (band.grid[row(atoms_[j].kx, atoms_[j].ky)] + band.grid[row(-atoms_[j].kx, -atoms_[j].ky)]);
    }
  });
}

}  // namespace astrolith
