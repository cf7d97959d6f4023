#include "synthesis/exemplar/exemplar_colors.h"

#include <array>
#include <cmath>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/exemplar/plane_exemplar.h"
#include "tests/synthesis/exemplars.h"

namespace astrolith {
namespace {

using testing::colored_layer;
using testing::exemplar_layer;

// The values of a channel's image along its axis, less their mean.
std::vector<double> channel_values(const ColorChannel& channel) {
  const ExemplarImage& image = *channel.layer.pixels;
  double mean = 0.0;
  for (const std::uint16_t v : image.values) mean += v / 65535.0 / static_cast<double>(image.values.size());
  std::vector<double> values;
  for (const std::uint16_t v : image.values) {
    values.push_back(channel.layer.height_range * (v / 65535.0 - mean));
  }
  return values;
}

struct Moments {
  std::array<double, 3> mean{};
  std::array<std::array<double, 3>, 3> covariance{};
};
template <class Values>
Moments find_moments(const Values& rgb, double full_scale) {
  Moments m;
  const auto n = static_cast<double>(rgb.size() / 3);
  for (std::size_t i = 0; i < rgb.size(); ++i) m.mean[i % 3] += static_cast<double>(rgb[i]) / full_scale / n;
  for (std::size_t i = 0; i < rgb.size(); i += 3) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        m.covariance[a][b] += (static_cast<double>(rgb[i + a]) / full_scale - m.mean[a]) *
                              (static_cast<double>(rgb[i + b]) / full_scale - m.mean[b]) / n;
      }
    }
  }
  return m;
}

TEST(ExemplarColors, ChannelsAddUpToTheColoursAndAreNotCorrelated) {
  const ExemplarLayer layer = colored_layer(1.0, 0.0);
  const ExemplarColors colors = exemplar_colors(layer, "r");
  ASSERT_EQ(colors.channels.size(), 3u);
  std::vector<std::vector<double>> values;
  for (const ColorChannel& channel : colors.channels) values.push_back(channel_values(channel));
  const std::vector<std::uint16_t>& rgb = layer.pixels->rgb;
  for (std::size_t i = 0; i < values[0].size(); ++i) {
    Vec3d color = colors.mean;
    for (std::size_t k = 0; k < 3; ++k) color += values[k][i] * colors.channels[k].axis;
    ASSERT_NEAR(color.x, rgb[3 * i] / 65535.0, 1e-4);
    ASSERT_NEAR(color.y, rgb[3 * i + 1] / 65535.0, 1e-4);
    ASSERT_NEAR(color.z, rgb[3 * i + 2] / 65535.0, 1e-4);
  }
  const auto product = [&](std::size_t a, std::size_t b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < values[a].size(); ++i) sum += values[a][i] * values[b][i];
    return sum;
  };
  for (std::size_t k = 1; k < 3; ++k) {
    EXPECT_LT(product(k, k), product(k - 1, k - 1));
    EXPECT_NEAR(product(k, k - 1), 0.0, 1e-3 * product(k, k));
  }
}

TEST(ExemplarColors, AGreyImageHasOneGreyChannel) {
  const ExemplarColors colors = exemplar_colors(exemplar_layer(1.0, 0.0), "r");
  ASSERT_EQ(colors.channels.size(), 1u);
  for (const double part :
       {colors.channels[0].axis.x, colors.channels[0].axis.y, colors.channels[0].axis.z}) {
    EXPECT_NEAR(part, std::sqrt(1.0 / 3.0), 1e-12);
  }
}

TEST(ExemplarColors, AnImageThatWasNotLoadedIsRefused) {
  ExemplarLayer layer = colored_layer(1.0, 0.0);
  layer.pixels = nullptr;
  EXPECT_THROW(exemplar_colors(layer, "r"), InputError);
}

// Colours of a large plane have the mean and the covariance of the image.
TEST(ExemplarColors, APlaneHasTheColoursOfTheImage) {
  const ExemplarLayer layer = colored_layer(1.0, 0.0);
  const Moments photo = find_moments(layer.pixels->rgb, 65535.0),
                plane = find_moments(synthesize_exemplar_colors(layer, "r", 1000, 800, {}), 1.0);
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_NEAR(plane.mean[a], photo.mean[a], 0.02);
    for (std::size_t b = 0; b < 3; ++b) {
      EXPECT_NEAR(plane.covariance[a][b], photo.covariance[a][b], 0.06 * photo.covariance[0][0]) << a << b;
    }
  }
}

// The grey colours of a grey image are its heights: both have the same places and weights.
TEST(ExemplarColors, ColoursFitTheHeights) {
  ExemplarLayer layer = exemplar_layer(1.0, 0.0);
  layer.height_range = 1.0;
  const PlaneExemplarOptions options{4, 2, true};
  const std::vector<float> heights = synthesize_exemplar(layer, "r", 300, 200, options),
                           rgb = synthesize_exemplar_colors(layer, "r", 300, 200, options);
  const auto mean = static_cast<float>(exemplar_colors(layer, "r").mean.x);
  for (std::size_t i = 0; i < heights.size(); ++i) {
    ASSERT_NEAR(static_cast<double>(rgb[3 * i]), static_cast<double>(mean + heights[i]), 2e-3);
    ASSERT_NEAR(static_cast<double>(rgb[3 * i + 2]), static_cast<double>(mean + heights[i]), 2e-3);
  }
}

TEST(ExemplarColors, APlaneHasTheSameBytesForOneThreadAndForMany) {
  const auto drawn = [&](int threads) {
    const ThreadLimit limit(threads);
    return synthesize_exemplar_colors(colored_layer(1.0, 1.0), "r", 300, 300, {3, 1, false});
  };
  EXPECT_EQ(drawn(1), drawn(2));
}

}  // namespace
}  // namespace astrolith
