#include "synthesis/exemplar/exemplar_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "numerics/errors.h"
#include "numerics/portable_double.h"

namespace astrolith {
namespace {

constexpr int kGreyValues = 65536;

// The z below which the share p of a normal distribution lies, for p in (0, 1): Acklam's rational
// approximation, whose relative error is below 1.2e-9.
double normal_quantile(double p) {
  constexpr std::array<double, 6> kA{-3.969683028665376e+01, 2.209460984245205e+02,  -2.759285104469687e+02,
                                     1.383577518672690e+02,  -3.066479806614716e+01, 2.506628277459239e+00};
  constexpr std::array<double, 5> kB{-5.447609879822406e+01, 1.615858368580409e+02, -1.556989798598866e+02,
                                     6.680131188771972e+01, -1.328068155288572e+01};
  constexpr std::array<double, 6> kC{-7.784894002430293e-03, -3.223964580411365e-01, -2.400758277161838e+00,
                                     -2.549732539343734e+00, 4.374664141464968e+00,  2.938163982698783e+00};
  constexpr std::array<double, 4> kD{7.784695709041462e-03, 3.224671290700398e-01, 2.445134137142996e+00,
                                     3.754408661907416e+00};
  const auto tail = [&](double share) {
    const double q = std::sqrt(-2.0 * portable::log(share));
    return (((((kC[0] * q + kC[1]) * q + kC[2]) * q + kC[3]) * q + kC[4]) * q + kC[5]) /
           ((((kD[0] * q + kD[1]) * q + kD[2]) * q + kD[3]) * q + 1.0);
  };
  constexpr double kTail = 0.02425;
  if (p < kTail) return tail(p);
  if (p > 1.0 - kTail) return -tail(1.0 - p);
  const double q = p - 0.5, r = q * q;
  return (((((kA[0] * r + kA[1]) * r + kA[2]) * r + kA[3]) * r + kA[4]) * r + kA[5]) * q /
         (((((kB[0] * r + kB[1]) * r + kB[2]) * r + kB[3]) * r + kB[4]) * r + 1.0);
}

// The share of a normal distribution below z, for |z| <= 6: the sum of its series 1/2 + density(z) (z + z^3 /
// 3 + z^5 / (3 5) + ...), whose terms have one sign.
double normal_share(double z) {
  double term = z, sum = z;
  for (int k = 3; k < 200 && std::fabs(term) > 1e-17 * std::fabs(sum); k += 2) {
    term *= z * z / k;
    sum += term;
  }
  constexpr double kDensity = 0.39894228040143267794;  // 1 / sqrt(2 pi)
  return 0.5 + kDensity * portable::exp(-0.5 * z * z) * sum;
}

// A grey value that pixels have, and the normal deviate of the middle of its ranks.
struct GreyLevel {
  double value;  // full scale = 1
  double deviate;
  std::size_t pixels;
};

// The grey values of an image in ascending order.
std::vector<GreyLevel> grey_levels(const ExemplarImage& image) {
  std::vector<std::size_t> counts(kGreyValues);
  for (const std::uint16_t value : image.values) ++counts[value];
  std::vector<GreyLevel> levels;
  const auto pixels = static_cast<double>(image.values.size());
  std::size_t below = 0;
  for (std::size_t value = 0; value < counts.size(); ++value) {
    if (counts[value] == 0) continue;
    const double rank = static_cast<double>(below) + 0.5 * static_cast<double>(counts[value]);
    levels.push_back(
        {static_cast<double>(value) / (kGreyValues - 1), normal_quantile(rank / pixels), counts[value]});
    below += counts[value];
  }
  return levels;
}

// Mean and standard deviation of the grey values, full scale = 1.
struct GreyMoments {
  double mean = 0.0, deviation = 0.0;
};
GreyMoments grey_moments(const std::vector<GreyLevel>& levels, std::size_t pixels) {
  double mean = 0.0, square = 0.0;
  for (const GreyLevel& level : levels) mean += static_cast<double>(level.pixels) * level.value;
  mean /= static_cast<double>(pixels);
  for (const GreyLevel& level : levels) {
    square += static_cast<double>(level.pixels) * (level.value - mean) * (level.value - mean);
  }
  return {mean, std::sqrt(square / static_cast<double>(pixels))};
}

// The place of pixel `i` of a line that goes on beyond its border; i from -side to 2 side - 1.
int pixel_beyond(int i, int side, bool mirror) {
  if (i >= 0 && i < side) return i;
  if (!mirror) return i < 0 ? i + side : i - side;
  return i < 0 ? -1 - i : 2 * side - 1 - i;
}

// An image of doubles whose lines can be visited along rows and along columns.
struct Plane {
  int width, height;
  bool mirror;
  std::vector<double> values;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  // filter(line) for each row and then for each column, where a line is a vector of doubles.
  template <class Filter>
  void filter_lines(const Filter& filter) {
    std::vector<double> line(static_cast<std::size_t>(width));
    for (int y = 0; y < height; ++y) {
      const auto row = values.begin() + static_cast<std::ptrdiff_t>(index(0, y));
      std::copy(row, row + width, line.begin());
      filter(line);
      std::copy(line.begin(), line.end(), row);
    }
    line.resize(static_cast<std::size_t>(height));
    for (int x = 0; x < width; ++x) {
      for (int y = 0; y < height; ++y) line[static_cast<std::size_t>(y)] = values[index(x, y)];
      filter(line);
      for (int y = 0; y < height; ++y) values[index(x, y)] = line[static_cast<std::size_t>(y)];
    }
  }
};

// The taps of a symmetric filter, from the middle one on.
constexpr std::size_t kTaps = 16;
using Taps = std::array<double, kTaps>;

// The filter 1 / sqrt(a) with a(t) = (66 + 52 cos t + 2 cos 2 t) / 120, the spectrum of the products of the
// spline with itself. Its taps are Fourier coefficients and fall by .43 from one to the next; sums over
// kAngles angles have them to the last digits.
Taps equal_power_taps() {
  constexpr int kAngles = 128;
  Taps taps{};
  for (int j = 0; j < kAngles; ++j) {
    const double angle = 2.0 * std::numbers::pi * j / kAngles;
    const double correlation =
        (66.0 + 52.0 * portable::cos(angle) + 2.0 * portable::cos(2.0 * angle)) / 120.0;
    for (std::size_t k = 0; k < kTaps; ++k)
      taps[k] += portable::cos(static_cast<double>(k) * angle) / std::sqrt(correlation) / kAngles;
  }
  return taps;
}

// Turns the samples of a line into coefficients of a quadratic B-spline that has, over all points of a pixel,
// the power of the samples at each frequency: the orthonormal spline (Unser, "Splines: a perfect fit for
// signal and image processing", 1999). A spline through the samples is smoother between them than at them, so
// that a gain which restores the variance makes wide features too high.
void filter_to_coefficients(std::vector<double>& line, const Taps& taps, bool mirror) {
  const std::vector<double> samples = line;
  const int side = static_cast<int>(line.size());
  const auto at = [&](int i) { return samples[static_cast<std::size_t>(pixel_beyond(i, side, mirror))]; };
  for (int i = 0; i < side; ++i) {
    double sum = taps[0] * at(i);
    for (int k = 1; k < static_cast<int>(kTaps); ++k)
      sum += taps[static_cast<std::size_t>(k)] * (at(i - k) + at(i + k));
    line[static_cast<std::size_t>(i)] = sum;
  }
}

// Correlates a line with the products of the spline with itself, [1, 26, 66, 26, 1] / 120.
void correlate_spline(std::vector<double>& line, bool mirror) {
  const std::vector<double> c = line;
  const int side = static_cast<int>(line.size());
  const auto at = [&](int i) { return c[static_cast<std::size_t>(pixel_beyond(i, side, mirror))]; };
  for (int i = 0; i < side; ++i) {
    line[static_cast<std::size_t>(i)] =
        (66.0 * at(i) + 26.0 * (at(i - 1) + at(i + 1)) + (at(i - 2) + at(i + 2))) / 120.0;
  }
}

// The mean square of the spline over the whole image.
double mean_square(const Plane& coefficients) {
  Plane correlated = coefficients;
  correlated.filter_lines([&](std::vector<double>& line) { correlate_spline(line, coefficients.mirror); });
  double sum = 0.0;
  for (std::size_t i = 0; i < correlated.values.size(); ++i) {
    sum += correlated.values[i] * coefficients.values[i];
  }
  return sum / static_cast<double>(correlated.values.size());
}

void scale_to_unit_mean_square(Plane& plane) {
  const double gain = 1.0 / std::sqrt(mean_square(plane));
  for (double& value : plane.values) value *= gain;
}

// The spline coefficients of the Gaussianised image, of mean square 1.
Plane gaussianised(const ExemplarImage& image, const std::vector<GreyLevel>& levels, bool mirror) {
  std::vector<double> deviates(kGreyValues);
  double mean = 0.0;
  for (const GreyLevel& level : levels) mean += static_cast<double>(level.pixels) * level.deviate;
  mean /= static_cast<double>(image.values.size());
  for (const GreyLevel& level : levels) {
    deviates[static_cast<std::size_t>(std::lround(level.value * (kGreyValues - 1)))] = level.deviate - mean;
  }
  Plane plane{image.width, image.height, mirror, {}};
  plane.values.reserve(image.values.size());
  for (const std::uint16_t value : image.values) plane.values.push_back(deviates[value]);
  const Taps taps = equal_power_taps();
  plane.filter_lines([&](std::vector<double>& line) { filter_to_coefficients(line, taps, mirror); });
  scale_to_unit_mean_square(plane);
  return plane;
}

// The coefficients as codes, three neighbours in a word.
std::vector<std::uint32_t> packed(const Plane& plane, double unit) {
  const auto code = [&](int x, int y) {
    const double value = plane.values[plane.index(pixel_beyond(x, plane.width, plane.mirror),
                                                  pixel_beyond(y, plane.height, plane.mirror))];
    return static_cast<std::uint32_t>(std::floor(value / unit + 0.5) + double{kExemplarZeroCode});
  };
  std::vector<std::uint32_t> words;
  words.reserve(static_cast<std::size_t>(plane.width) * static_cast<std::size_t>(plane.height + 2));
  for (int y = -1; y <= plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      words.push_back(code(x - 1, y) | code(x, y) << kExemplarCodeBits |
                      code(x + 1, y) << (2 * kExemplarCodeBits));
    }
  }
  return words;
}

// A point of the image's distribution function: the share of its pixels below a grey value.
struct GreyShare {
  double value, share;
};

// The distribution function as a polygon. The pixels of a grey value are spread evenly up to the middles
// between it and its neighbours, since they were rounded to it.
std::vector<GreyShare> grey_distribution(const std::vector<GreyLevel>& levels, std::size_t pixels) {
  std::vector<GreyShare> polygon{{levels.front().value, 0.0}};
  std::size_t below = 0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    below += levels[i].pixels;
    const double next = i + 1 < levels.size() ? levels[i + 1].value : levels[i].value;
    polygon.push_back(
        {0.5 * (levels[i].value + next), static_cast<double>(below) / static_cast<double>(pixels)});
  }
  return polygon;
}

// The grey value below which a share of the pixels lies.
double grey_at(const std::vector<GreyShare>& polygon, double share) {
  const auto above = std::upper_bound(polygon.begin(), polygon.end(), share,
                                      [](double at, const GreyShare& point) { return at < point.share; });
  if (above == polygon.begin()) return polygon.front().value;
  if (above == polygon.end()) return polygon.back().value;
  const GreyShare& below = *(above - 1);
  return below.value + (share - below.share) / (above->share - below.share) * (above->value - below.value);
}

// The table of heights: gain * (grey value - mean).
std::vector<float> height_table(const std::vector<GreyShare>& distribution, double mean, double gain) {
  std::vector<float> heights;
  for (int i = -1; i <= kExemplarHeights + 1; ++i) {
    const double z = (2.0 * i / kExemplarHeights - 1.0) * double{kLargestExemplarDeviation};
    heights.push_back(static_cast<float>(gain * (grey_at(distribution, normal_share(z)) - mean)));
  }
  return heights;
}

ExemplarTexture make_texture(const Plane& plane, const std::vector<float>& heights, ArrayStore& arrays) {
  double largest = 0.0;
  for (const double value : plane.values) largest = std::max(largest, std::fabs(value));
  const double unit = largest / (double{kExemplarZeroCode} - 1.0);
  const auto [least, greatest] = std::minmax_element(heights.begin(), heights.end());
  const int periods = plane.mirror ? 2 : 1;
  const double period_x = periods * plane.width, period_y = periods * plane.height;
  return {static_cast<float>(plane.width),
          static_cast<float>(plane.height),
          static_cast<float>(period_x),
          static_cast<float>(period_y),
          static_cast<float>(1.0 / period_x),
          static_cast<float>(1.0 / period_y),
          plane.width,
          static_cast<float>(unit),
          arrays.add(packed(plane, unit)),
          arrays.add(heights),
          double{*least},
          double{*greatest}};
}

}  // namespace

double exemplar_height_rms(const ExemplarLayer& layer) {
  if (layer.height_range == 0.0) return layer.height_rms;
  const ExemplarImage& image = *layer.pixels;
  return std::fabs(layer.height_range) * grey_moments(grey_levels(image), image.values.size()).deviation;
}

ExemplarTexture make_exemplar_texture(const ExemplarLayer& layer, const std::string& place,
                                      ArrayStore& arrays) {
  if (layer.pixels == nullptr) {
    throw InputError(place + ".image: was not loaded; read the recipe from its file, beside the image");
  }
  const ExemplarImage& image = *layer.pixels;
  const std::vector<GreyLevel> levels = grey_levels(image);
  if (levels.size() < 2) {
    throw InputError(place + ".image: \"" + layer.image + "\" has one grey value only; use another image");
  }
  const GreyMoments moments = grey_moments(levels, image.values.size());
  const Plane plane = gaussianised(image, levels, layer.border == ExemplarBorder::kMirror);
  const double gain = layer.height_range != 0.0 ? layer.height_range : layer.height_rms / moments.deviation;
  const std::vector<float> heights =
      height_table(grey_distribution(levels, image.values.size()), moments.mean, gain);
  return make_texture(plane, heights, arrays);
}

}  // namespace astrolith
