#include "estimation/gabor/pursuit/gabor_dictionary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// The distance of neighbouring centres in bins. Two unit Gaussians at a distance t have the correlation
// exp(-t^2 / (4 deviation^2)).
int lattice_stride(double deviation_bins) {
  constexpr double kLargestCorrelation = 0.95;
  return std::max(
      1, static_cast<int>(std::ceil(2.0 * deviation_bins * std::sqrt(-std::log(kLargestCorrelation)))));
}

// The Fourier transform of an even function on n bins, which is real.
std::vector<double> even_transform(const std::vector<double>& values) {
  const auto n = static_cast<int>(values.size());
  const FourierTransform fourier(n, 1);
  std::vector<std::complex<double>> half(fourier.half_size());
  fourier.forward(values, half);
  std::vector<double> transform(values.size());
  for (int k = 0; k < n; ++k) transform[static_cast<std::size_t>(k)] = half[std::min(k, n - k)].real();
  return transform;
}

std::vector<double> gaussian_transform(int n, double deviation) {
  return even_transform(periodic_gaussian(n, 0.0, deviation));
}

std::vector<double> squared_gaussian_transform(int n, double deviation) {
  std::vector<double> squared = periodic_gaussian(n, 0.0, deviation);
  for (double& g : squared) g *= g;
  return even_transform(squared);
}

// F_p(m) = sum over the integers h of parity p of exp(-((m + h n/2) / deviation)^2), along one axis of n
// bins.
double parity_factor(double m, int n, double deviation, int parity) {
  const int reach = static_cast<int>(std::ceil(2.0 * (6.5 * deviation + std::abs(m)) / n)) + 2;
  double sum = 0.0;
  for (int h = -reach; h <= reach; ++h) {
    if ((h & 1) != parity) continue;
    const double t = (m + 0.5 * h * n) / deviation;
    sum += std::exp(-t * t);
  }
  return sum;
}

// F_0 and F_1 at every bin of an axis.
using ParityFactors = std::array<std::vector<double>, 2>;

ParityFactors parity_factors(int n, double deviation) {
  ParityFactors factors;
  for (int parity = 0; parity < 2; ++parity) {
    for (int bin = 0; bin < n; ++bin) {
      factors[static_cast<std::size_t>(parity)].push_back(
          parity_factor(signed_frequency(bin, n), n, deviation, parity));
    }
  }
  return factors;
}

// A grid's bins and a lobe's deviations along both axes.
struct LobeGrid {
  int width, height;
  double deviation_x, deviation_y;  // bins
};

// The overlap of a lobe's Gaussian with its mirror image, sum_f W^2(f) g(f - m) g(f + m), for every centre m.
// Along each axis the product of the two periodic Gaussians is separable by parity,
//   g(f - m) g(f + m) = F_0(f) F_0(m) + F_1(f) F_1(m),
// so that four sums over the grid serve all centres.
class MirrorOverlap {
 public:
  MirrorOverlap(const LobeGrid& grid, const std::vector<double>& squared_weight)
      : x_(parity_factors(grid.width, grid.deviation_x)), y_(parity_factors(grid.height, grid.deviation_y)) {
    for (std::size_t py = 0; py < 2; ++py) {
      for (std::size_t px = 0; px < 2; ++px) sums_[py][px] = weighted_sum(squared_weight, x_[px], y_[py]);
    }
  }

  // The overlap for the centre at bins (x, y).
  double at(std::size_t x, std::size_t y) const {
    double sum = 0.0;
    for (std::size_t py = 0; py < 2; ++py) {
      for (std::size_t px = 0; px < 2; ++px) sum += sums_[py][px] * x_[px][x] * y_[py][y];
    }
    return sum;
  }

 private:
  // sum over the grid of weight(x, y) a(x) b(y)
  static double weighted_sum(const std::vector<double>& weight, const std::vector<double>& a,
                             const std::vector<double>& b) {
    double total = 0.0;
    for (std::size_t y = 0; y < b.size(); ++y) {
      double sum = 0.0;
      for (std::size_t x = 0; x < a.size(); ++x) sum += weight[y * a.size() + x] * a[x];
      total += sum * b[y];
    }
    return total;
  }

  ParityFactors x_, y_;
  std::array<std::array<double, 2>, 2> sums_{};  // sum_f W^2 F_px(f_x) F_py(f_y), by py and px
};

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
  // One centre of each pair +-m: the half plane ky > 0, and the half row kx >= 0 where ky = 0.
  const int last_x = (width() - 1) / 2 / stride_x * stride_x;
  for (int ky = 0; 2 * ky < height(); ky += stride_y) {
    for (int kx = ky == 0 ? 0 : -last_x; kx <= last_x; kx += stride_x) {
      // The mean of an image hides frequency 0, so the data cannot determine a lobe there that is narrower
      // than a bin.
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

template <typename Work>
void GaborDictionary::for_each_band(const Work& work) const {
  parallel_for(0, static_cast<std::int64_t>(bands_.size()),
               [&](std::int64_t b) { work(bands_[static_cast<std::size_t>(b)]); });
}

void GaborDictionary::normalize_columns() {
  for (std::size_t i = 0; i < rows(); ++i) grid_[i] = weight_[i] * weight_[i];
  const std::vector<double> squared_weight = grid_;
  fourier_.forward(grid_, half_);
  for_each_band([&](Band& band) { normalize_band(band, squared_weight); });
}

// |W (g(f-m) + g(f+m))|^2 = (W^2 * g^2)(m) + (W^2 * g^2)(-m) + 2 sum_f W^2 g(f-m) g(f+m), and W is symmetric.
void GaborDictionary::normalize_band(Band& band, const std::vector<double>& squared_weight) {
  const LobeGrid grid{width(), height(), lobe_deviation(band.bandwidth) * width(),
                      lobe_deviation(band.bandwidth) * height()};
  band.half = half_;  // the transform of W^2
  filter(squared_gaussian_transform(grid.width, grid.deviation_x),
         squared_gaussian_transform(grid.height, grid.deviation_y), band.half);
  fourier_.inverse(band.half, band.grid);  // W^2 * g^2
  const MirrorOverlap mirror_overlap(grid, squared_weight);
  for (std::size_t j = band.begin; j < band.end; ++j) {
    const auto x = static_cast<std::size_t>(frequency_bin(atoms_[j].kx, width()));
    const auto y = static_cast<std::size_t>(frequency_bin(atoms_[j].ky, height()));
    const double squared_norm =
        band.grid[center(atoms_[j])] + band.grid[mirrored_center(atoms_[j])] + 2.0 * mirror_overlap.at(x, y);
    scale_[j] = squared_norm > 0.0 ? 1.0 / std::sqrt(squared_norm) : 0.0;
  }
}

bool GaborDictionary::put_impulses(std::span<const double> x, Band& band) const {
  std::fill(band.grid.begin(), band.grid.end(), 0.0);
  bool any = false;
  for (std::size_t j = band.begin; j < band.end; ++j) {
    if (x[j] == 0.0) continue;
    any = true;
    band.grid[center(atoms_[j])] += scale_[j] * x[j];
    band.grid[mirrored_center(atoms_[j])] += scale_[j] * x[j];
  }
  return any;
}

void GaborDictionary::synthesize(std::span<const double> x, std::span<double> out) const {
  for_each_band([&](Band& band) {
    if (!put_impulses(x, band)) {
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
  for_each_band([&](Band& band) {
    band.half = half_;
    filter(band.transform_x, band.transform_y, band.half);
    fourier_.inverse(band.half, band.grid);
    for (std::size_t j = band.begin; j < band.end; ++j) {
      out[j] = scale_[j] * (band.grid[center(atoms_[j])] + band.grid[mirrored_center(atoms_[j])]);
    }
  });
}

}  // namespace astrolith
