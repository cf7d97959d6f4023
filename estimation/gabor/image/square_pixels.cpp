#include "estimation/gabor/image/square_pixels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "numerics/portable_angles.h"

namespace astrolith {
namespace {

constexpr int kLobes = 3;

double lanczos(double x) {
  const double angle = std::numbers::pi * x;
  if (std::abs(x) < 1e-8) return 1.0;
  if (std::abs(x) >= kLobes) return 0.0;
  return kLobes * portable::sin(angle) * portable::sin(angle / kLobes) / (angle * angle);
}

// The weights of old pixels in one new pixel, from the first that counts; their sum is 1.
struct Taps {
  int first = 0;
  std::vector<double> weights;
};

// For each new pixel along an axis of `count` old ones, of which `ratio` make one new pixel.
std::vector<Taps> make_taps(int count, double ratio) {
  std::vector<Taps> taps(static_cast<std::size_t>(std::max(1.0, std::floor(count / ratio))));
  for (std::size_t i = 0; i < taps.size(); ++i) {
    const double middle = (static_cast<double>(i) + 0.5) * ratio - 0.5;
    const int first = std::max(0, static_cast<int>(std::ceil(middle - kLobes * ratio)));
    const int last = std::min(count - 1, static_cast<int>(std::floor(middle + kLobes * ratio)));
    double sum = 0.0;
    taps[i].first = first;
    for (int k = first; k <= last; ++k) sum += taps[i].weights.emplace_back(lanczos((k - middle) / ratio));
    for (double& weight : taps[i].weights) weight /= sum;
  }
  return taps;
}

GreyImage with_axes_exchanged(const GreyImage& image) {
  GreyImage turned{image.height, image.width, {}};
  for (int x = 0; x < image.width; ++x) {
    for (int y = 0; y < image.height; ++y) {
      turned.values.push_back(image.at(x, y));
      if (image.missing.empty()) continue;
      turned.missing.push_back(
          image.missing[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(x)]);
    }
  }
  return turned;
}

// Fewer columns: `ratio` old ones make a new one. Missing pixels count with the values that continue the
// others.
GreyImage with_wider_pixels(const GreyImage& image, double ratio) {
  const std::vector<Taps> taps = make_taps(image.width, ratio);
  GreyImage result{static_cast<int>(taps.size()), image.height, {}};
  for (int y = 0; y < image.height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
    for (const Taps& tap : taps) {
      const std::size_t first = row + static_cast<std::size_t>(tap.first);
      double value = 0.0, missing = 0.0;
      for (std::size_t k = 0; k < tap.weights.size(); ++k) {
        value += tap.weights[k] * image.values[first + k];
        if (!image.missing.empty() && image.missing[first + k]) missing += tap.weights[k];
      }
      result.values.push_back(value);
      if (!image.missing.empty()) result.missing.push_back(missing > 0.5);
    }
  }
  return result;
}

}  // namespace

GreyImage with_square_pixels(const GreyImage& image, double pixel_width, double pixel_height) {
  if (pixel_width < pixel_height) return with_wider_pixels(image, pixel_height / pixel_width);
  return with_axes_exchanged(with_wider_pixels(with_axes_exchanged(image), pixel_width / pixel_height));
}

}  // namespace astrolith
