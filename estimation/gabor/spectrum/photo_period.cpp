#include "estimation/gabor/spectrum/photo_period.h"

#include <algorithm>
#include <bit>
#include <complex>
#include <cstddef>
#include <utility>

#include "estimation/gabor/spectrum/border_taper.h"
#include "estimation/gabor/spectrum/fourier_transform.h"
#include "numerics/errors.h"
#include "numerics/progress.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

constexpr double kAlike = 0.02;
// Alike pixels differ by less than neighbouring ones, within what chance adds to noise; where a period is
// there just twice, by much less: two hills of nearly one form differ by a fifth.
constexpr double kMostDifference = 1.1, kMostDifferenceOnce = 0.125;  // of neighbouring pixels
constexpr double kRounding = 1e-9;  // of the mean square: what the transforms leave

// What all rows have together: the sums over the pixels of the products of values a distance apart, and of
// squares by column.
struct RowSums {
  std::vector<double> products, squares;
};

// Rows are padded with zeros, so that no products wrap around.
RowSums row_sums(const std::vector<GreyImage>& planes, const Progress& progress) {
  const int n = planes.front().width;
  const FourierTransform fourier(static_cast<int>(std::bit_ceil(2u * static_cast<unsigned>(n))), 1);
  RowSums sums{std::vector<double>(fourier.grid_size()), std::vector<double>(static_cast<std::size_t>(n))};
  std::vector<double> row(fourier.grid_size());
  std::vector<std::complex<double>> half(fourier.half_size()), power(fourier.half_size());
  std::size_t rows = 0;
  for (const GreyImage& plane : planes) {
    const double mean = sample_mean(plane.values);
    for (int y = 0; y < plane.height; ++y) {
      const double done = static_cast<double>(rows++) / static_cast<double>(planes.size()) / plane.height;
      if (!report(progress, done, "looking for a period")) throw WorkError("stopped; nothing is written");
      for (int x = 0; x < n; ++x) {
        const auto i = static_cast<std::size_t>(x);
        row[i] = plane.at(x, y) - mean;
        sums.squares[i] += row[i] * row[i];
      }
      fourier.forward(row, half);
      for (std::size_t k = 0; k < half.size(); ++k) power[k] += std::norm(half[k]);
    }
  }
  fourier.inverse(power, sums.products);
  return sums;
}

// The mean square of the differences of pixels at every distance up to 3 n / 4.
std::vector<double> differences(const RowSums& sums, int height) {
  const std::size_t n = sums.squares.size();
  double squares = 0.0;
  for (const double s : sums.squares) squares += 2.0 * s;
  const double rounding = kRounding * squares;
  std::vector<double> differences;
  for (std::size_t p = 0; p <= 3 * n / 4; ++p) {
    const double difference = squares - 2.0 * sums.products[p];
    differences.push_back((difference > rounding ? difference : 0.0) / static_cast<double>((n - p) * height));
    squares -= sums.squares[p] + sums.squares[n - 1 - p];
  }
  return differences;
}

int least_period(const std::vector<double>& differences, std::size_t n) {
  double largest = 0.0;
  for (std::size_t p = 2; p <= n / 2; ++p) {
    largest = std::max(largest, differences[p - 1]);
    if (!(largest > 0.0) || differences[p] > differences[p - 1] || differences[p] > differences[p + 1])
      continue;
    const bool once = 2 * p >= differences.size();
    const double most =
        std::min(kAlike * largest, (once ? kMostDifferenceOnce : kMostDifference) * differences[1]);
    bool alike = true;
    for (std::size_t k = p; alike && k < differences.size(); k += p) alike = differences[k] <= most;
    if (alike) return static_cast<int>(p);
  }
  return 0;
}

GreyImage transposed(const GreyImage& image) {
  GreyImage turned{image.height, image.width, {}};
  turned.values.reserve(image.values.size());
  for (int x = 0; x < image.width; ++x) {
    for (int y = 0; y < image.height; ++y) turned.values.push_back(image.at(x, y));
  }
  return turned;
}

int period_along_rows(const std::vector<GreyImage>& planes, const Progress& progress) {
  const int n = planes.front().width;
  if (n < 4) return 0;
  return least_period(differences(row_sums(planes, progress), planes.front().height),
                      static_cast<std::size_t>(n));
}

std::vector<GreyImage> all_transposed(const std::vector<GreyImage>& planes) {
  std::vector<GreyImage> turned;
  for (const GreyImage& plane : planes) turned.push_back(transposed(plane));
  return turned;
}

// Where a part of `length` columns begins, such that its border bends least: a border through a bright grain
// would look like a cut.
int calmest_start(const std::vector<GreyImage>& planes, int period, int length) {
  const auto bend = [&](int x) {
    double sum = 0.0;
    for (const GreyImage& plane : planes) sum += column_bend(plane, x == 0 ? period : x);
    return sum;
  };
  int best = 0;
  double least = bend(0) + bend(period - 1);
  for (int start = 1; start < period && start + length <= planes.front().width; ++start) {
    const double border = bend(start) + bend(start - 1);
    if (border < least) best = start, least = border;
  }
  return best;
}

std::vector<GreyImage> cut_along_rows(std::vector<GreyImage> planes, int period, int least) {
  if (period == 0) return planes;
  const int width = planes.front().width, times = std::max(1, (least + period - 1) / period),
            length = std::min(times, width / period) * period;
  const int start = calmest_start(planes, period, length);
  for (GreyImage& plane : planes) plane = plane.part(start, 0, length, plane.height);
  return planes;
}

}  // namespace

PhotoPeriod find_period(const std::vector<GreyImage>& planes, const Progress& progress) {
  PhotoPeriod period;
  period.x = period_along_rows(planes, stretch(progress, 0.0, 0.5));
  period.y = period_along_rows(all_transposed(planes), stretch(progress, 0.5, 1.0));
  return period;
}

std::vector<GreyImage> one_period(std::vector<GreyImage> planes, const PhotoPeriod& period, int least) {
  planes = cut_along_rows(std::move(planes), period.x, least);
  if (period.y == 0) return planes;
  return all_transposed(cut_along_rows(all_transposed(planes), period.y, least));
}

}  // namespace astrolith
