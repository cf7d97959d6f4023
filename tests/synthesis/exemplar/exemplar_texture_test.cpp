#include "synthesis/exemplar/exemplar_texture.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <utility>

#include "numerics/errors.h"
#include "tests/synthesis/exemplars.h"

namespace astrolith {
namespace {

using testing::exemplar_layer;

struct Tables {
  ArrayStore arrays;
  ExemplarTexture texture;

  explicit Tables(const ExemplarLayer& layer)
      : texture(make_exemplar_texture(layer, "r: layers[0]", arrays)) {}
  float value(float u, float v) const { return exemplar_value(texture, arrays.view()[texture.words], u, v); }
  float height(float z) const { return exemplar_height(arrays.view()[texture.heights], z); }
};

// At the middles of pixels the spline passes through the image's ranks: brighter pixels have larger values,
// and the table of heights gives the grey values back.
TEST(ExemplarTexture, GoesThroughThePixels) {
  ExemplarLayer layer = exemplar_layer(1.0, 0.0);
  layer.height_range = 1.0;
  const Tables tables(layer);
  const ExemplarImage& image = *layer.pixels;
  double mean = 0.0, error = 0.0;
  for (const std::uint16_t v : image.values) mean += v / 65535.0;
  mean /= static_cast<double>(image.values.size());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double grey = image.values[static_cast<std::size_t>(y * image.width + x)] / 65535.0 - mean;
      const float z = tables.value(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      error += std::pow(static_cast<double>(tables.height(z)) - grey, 2);
    }
  }
  EXPECT_LT(std::sqrt(error / static_cast<double>(image.values.size())), 0.05 * exemplar_height_rms(layer));
}

TEST(ExemplarTexture, HasTheMeanSquareOne) {
  for (const ExemplarBorder border : kExemplarBorders) {
    ExemplarLayer layer = exemplar_layer(1.0, 1.0);
    layer.border = border;
    const Tables tables(layer);
    double sum = 0.0, square = 0.0;
    const int steps = 4;
    int count = 0;
    for (int j = 0; j < steps * 80; ++j) {
      for (int i = 0; i < steps * 96; ++i, ++count) {
        const float v =
            tables.value((static_cast<float>(i) + 0.5f) / steps, (static_cast<float>(j) + 0.5f) / steps);
        sum += static_cast<double>(v);
        square += static_cast<double>(v) * static_cast<double>(v);
      }
    }
    EXPECT_NEAR(sum / count, 0.0, 0.01);
    EXPECT_NEAR(square / count, 1.0, 0.005);
  }
}

// Normal noise, pixel by pixel, has as much power at its widest waves as at its narrowest. Sampled between
// the pixels, too, the widest waves must be as high as those of the pixels.
TEST(ExemplarTexture, HasThePowerOfThePixelsInWideWaves) {
  constexpr int kSide = 64, kSteps = 4, kWaves = 6;
  ExemplarImage image{kSide, kSide, {}, {}};
  CounterRandom random(3);
  for (int i = 0; i < kSide * kSide; ++i)
    image.values.push_back(
        static_cast<std::uint16_t>(std::clamp(32768.0 + 7000.0 * random.normal(), 0.0, 65535.0)));
  const auto power = [&](int steps, const auto& value) {
    const int count = kSide * steps;
    double sum = 0.0;
    for (int ky = 0; ky < kWaves; ++ky) {
      for (int kx = 1; kx < kWaves; ++kx) {
        std::complex<double> wave = 0.0;
        for (int y = 0; y < count; ++y) {
          for (int x = 0; x < count; ++x) {
            const double turns = (kx * (x + 0.5) + ky * (y + 0.5)) / count;
            wave += std::polar(value((x + 0.5) / steps, (y + 0.5) / steps), 2.0 * std::numbers::pi * turns);
          }
        }
        sum += std::norm(wave / static_cast<double>(count * count));
      }
    }
    return sum;
  };
  const double pixel_power = power(1, [&](double x, double y) {
    return (image.values[static_cast<std::size_t>(static_cast<int>(y) * kSide + static_cast<int>(x))] -
            32768.0) /
           7000.0;
  });
  ExemplarLayer layer = exemplar_layer(1.0, 1.0);
  layer.pixels = std::make_shared<ExemplarImage>(std::move(image));
  const Tables tables(layer);
  const double spline_power = power(kSteps, [&](double x, double y) {
    return static_cast<double>(tables.value(static_cast<float>(x), static_cast<float>(y)));
  });
  EXPECT_NEAR(spline_power / pixel_power, 1.0, 0.05);
}

// Values and slopes agree on both sides of pixels' borders, also where the image begins anew.
TEST(ExemplarTexture, IsSmoothAcrossPixelsAndBorders) {
  for (const ExemplarBorder border : kExemplarBorders) {
    ExemplarLayer layer = exemplar_layer(1.0, 1.0);
    layer.border = border;
    const Tables tables(layer);
    const float h = 0x1p-6f;
    for (const float at : {0.0f, 96.0f, 192.0f, 17.0f, -96.0f}) {
      for (const float v : {0.3f, 40.0f, 79.99f, 80.0f}) {
        const float before = tables.value(at - h, v), here = tables.value(at, v),
                    after = tables.value(at + h, v);
        // The second difference of a C1 spline is proportional to h^2, of a kink to h.
        EXPECT_NEAR(before - 2.0f * here + after, 0.0f, 40.0f * h * h) << at << " " << v;
        EXPECT_NEAR(tables.value(v, at - h), tables.value(v, at + h), 16.0f * h);
      }
    }
  }
}

TEST(ExemplarTexture, RefusesOneGreyAndAbsentPixels) {
  ArrayStore arrays;
  ExemplarLayer layer = exemplar_layer(1.0, 1.0);
  layer.pixels =
      std::make_shared<ExemplarImage>(ExemplarImage{32, 32, std::vector<std::uint16_t>(1024, 77), {}});
  EXPECT_THROW(make_exemplar_texture(layer, "r", arrays), InputError);
  layer.pixels = nullptr;
  EXPECT_THROW(make_exemplar_texture(layer, "r", arrays), InputError);
}

}  // namespace
}  // namespace astrolith
