#include "estimation/gabor/spectrum/border_taper.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace astrolith {
namespace {

constexpr double kFadedShare = 0.1;  // share of a side that is faded at each end

double squared_bend(double before, double here, double after) {
  const double bend = before - 2.0 * here + after;
  return bend * bend;
}

// The sum over column x of the squared second differences along x of the periodic image.
double column_bend(const GreyImage& image, int x) {
  const int w = image.width;
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y) {
    sum += squared_bend(image.at((x + w - 1) % w, y), image.at(x, y), image.at((x + 1) % w, y));
  }
  return sum;
}

double row_bend(const GreyImage& image, int y) {
  const int h = image.height;
  double sum = 0.0;
  for (int x = 0; x < image.width; ++x) {
    sum += squared_bend(image.at(x, (y + h - 1) % h), image.at(x, y), image.at(x, (y + 1) % h));
  }
  return sum;
}

template <typename Bend>
bool continues(int n, const Bend& bend) {
  double largest = 0.0;
  for (int i = 1; i + 1 < n; ++i) largest = std::max(largest, bend(i));
  return std::max(bend(0), bend(n - 1)) <= largest;
}

std::vector<double> fading(int n, bool tiles) {
  std::vector<double> taper(static_cast<std::size_t>(n), 1.0);
  const int faded = tiles ? 0 : static_cast<int>(kFadedShare * n);
  for (int i = 0; i < faded; ++i) {
    const double s = std::sin(0.5 * std::numbers::pi * (i + 0.5) / faded);
    taper[static_cast<std::size_t>(i)] = taper[static_cast<std::size_t>(n - 1 - i)] = s * s;
  }
  return taper;
}

// The share of independent frequencies, (sum w^2)^2 / (n sum w^4). A taper w correlates neighbouring
// frequencies.
double independent_share(const std::vector<double>& taper) {
  double square = 0.0;
  double fourth = 0.0;
  for (const double w : taper) {
    square += w * w;
    fourth += w * w * w * w;
  }
  return square * square / (static_cast<double>(taper.size()) * fourth);
}

double weighted_sum(const GreyImage& image, const std::vector<double>& wx, const std::vector<double>& wy) {
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y) {
    double row = 0.0;
    for (int x = 0; x < image.width; ++x) row += wx[static_cast<std::size_t>(x)] * image.at(x, y);
    sum += wy[static_cast<std::size_t>(y)] * row;
  }
  return sum;
}

double variance_of(const GreyImage& image) {
  const auto n = static_cast<double>(image.values.size());
  double mean = 0.0;
  for (const double v : image.values) mean += v / n;
  double sum = 0.0;
  for (const double v : image.values) sum += (v - mean) * (v - mean);
  return sum / n;
}

}  // namespace

bool tiles_along_x(const GreyImage& image) {
  return continues(image.width, [&](int x) { return column_bend(image, x); });
}

bool tiles_along_y(const GreyImage& image) {
  return continues(image.height, [&](int y) { return row_bend(image, y); });
}

TaperedImage taper_borders(const GreyImage& image) {
  const std::vector<double> wx = fading(image.width, tiles_along_x(image));
  const std::vector<double> wy = fading(image.height, tiles_along_y(image));
  double total_x = 0.0;
  double total_y = 0.0;
  for (const double w : wx) total_x += w;
  for (const double w : wy) total_y += w;
  const double mean = weighted_sum(image, wx, wy) / (total_x * total_y);
  TaperedImage result{image, independent_share(wx) * independent_share(wy)};
  double power = 0.0;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    const auto width = static_cast<std::size_t>(image.width);
    double& v = result.image.values[i];
    v = wx[i % width] * wy[i / width] * (v - mean);
    power += v * v;
  }
  const double tapered_variance = power / static_cast<double>(image.values.size());
  const double gain = tapered_variance > 0.0 ? std::sqrt(variance_of(image) / tapered_variance) : 0.0;
  for (double& v : result.image.values) v *= gain;
  return result;
}

}  // namespace astrolith
