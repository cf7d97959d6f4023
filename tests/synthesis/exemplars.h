// Exemplar layers that several tests of synthesis share.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "numerics/hash_random.h"
#include "recipe/recipe.h"

namespace astrolith::testing {

// A periodic image blurred by the filter [1, 2, 1] / 4 along rows and columns.
inline std::vector<double> blurred(const std::vector<double>& grey, int width, int height) {
  std::vector<double> result(grey.size(), 0.0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          result[static_cast<std::size_t>(y * width + x)] +=
              (2 - std::abs(dx)) * (2 - std::abs(dy)) / 16.0 *
              grey[static_cast<std::size_t>((y + dy + height) % height * width + (x + dx + width) % width)];
        }
      }
    }
  }
  return result;
}

// A periodic image of bright discs on a dark ground, like stones: far from Gaussian.
inline std::shared_ptr<const ExemplarImage> stones(int width, int height) {
  ExemplarImage image{width, height, {}, {}};
  std::vector<double> grey(static_cast<std::size_t>(width * height), 0.1);
  CounterRandom random(5);
  for (int stone = 0; stone < width * height / 40; ++stone) {
    const double x = random.uniform(0, width), y = random.uniform(0, height), radius = random.uniform(2, 6);
    const double top = random.uniform(0.4, 0.9);
    for (int dy = -6; dy <= 6; ++dy) {
      for (int dx = -6; dx <= 6; ++dx) {
        const int px = static_cast<int>(x) + dx, py = static_cast<int>(y) + dy;
        const double fall = 1.0 - (dx * dx + dy * dy) / (radius * radius);
        if (fall <= 0.0) continue;
        double& value = grey[static_cast<std::size_t>((py + height) % height * width + (px + width) % width)];
        value = std::max(value, top * std::sqrt(fall));
      }
    }
  }
  for (double& value : grey) value += 0.1 * random.uniform();
  grey = blurred(grey, width, height);
  for (const double value : grey) image.values.push_back(static_cast<std::uint16_t>(65535.0 * value));
  return std::make_shared<const ExemplarImage>(std::move(image));
}

inline ExemplarLayer exemplar_layer(double pixel_size, double height_rms) {
  static const std::shared_ptr<const ExemplarImage> image = stones(96, 80);
  ExemplarLayer layer;
  layer.image = "stones.png";
  layer.image_sha256 = std::string(64, '0');
  layer.pixels = image;
  layer.pixel_size = pixel_size;
  layer.height_rms = height_rms;
  return layer;
}

// The stones in colour: their grey values over a ground whose red and blue vary by themselves.
inline ExemplarLayer colored_layer(double pixel_size, double height_rms) {
  static const std::shared_ptr<const ExemplarImage> image = [] {
    ExemplarImage colored = *stones(96, 80);
    const std::shared_ptr<const ExemplarImage> tints = stones(80, 96);
    for (std::size_t i = 0; i < colored.values.size(); ++i) {
      const int grey = colored.values[i], tint = tints->values[i],
                shade = tints->values[(7 * i + 13) % tints->values.size()];
      colored.rgb.push_back(static_cast<std::uint16_t>((6 * grey + 4 * tint) / 10));
      colored.rgb.push_back(static_cast<std::uint16_t>(grey));
      colored.rgb.push_back(static_cast<std::uint16_t>((6 * grey + 2 * shade) / 10));
    }
    return std::make_shared<const ExemplarImage>(std::move(colored));
  }();
  ExemplarLayer layer = exemplar_layer(pixel_size, height_rms);
  layer.pixels = image;
  layer.color = true;
  return layer;
}

}  // namespace astrolith::testing
