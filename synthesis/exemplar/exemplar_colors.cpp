#include "synthesis/exemplar/exemplar_colors.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <utility>

#include "numerics/errors.h"
#include "numerics/jacobi_rotation.h"

namespace astrolith {
namespace {

constexpr double kFullScale = 65535.0;
constexpr double kLeastDeviation = 1e-4;

// Red, green and blue of every pixel.
std::vector<std::uint16_t> to_rgb(const ExemplarImage& image) {
  if (!image.rgb.empty()) return image.rgb;
  std::vector<std::uint16_t> rgb;
  rgb.reserve(3 * image.values.size());
  for (const std::uint16_t value : image.values) rgb.insert(rgb.end(), 3, value);
  return rgb;
}

struct ColorMoments {
  std::array<double, 3> mean{};  // full scale = 65535
  Matrix3 covariance{};
};

// The sums are whole numbers: 2^26 pixels of squares below 2^32 fit into 64 bits.
ColorMoments color_moments(const std::vector<std::uint16_t>& rgb) {
  std::array<std::uint64_t, 3> sum{};
  std::array<std::array<std::uint64_t, 3>, 3> products{};
  for (std::size_t i = 0; i < rgb.size(); i += 3) {
    for (std::size_t a = 0; a < 3; ++a) {
      sum[a] += rgb[i + a];
      for (std::size_t b = 0; b <= a; ++b) products[a][b] += std::uint64_t{rgb[i + a]} * rgb[i + b];
    }
  }
  const double pixels = static_cast<double>(rgb.size()) / 3.0;
  ColorMoments m;
  for (std::size_t a = 0; a < 3; ++a) m.mean[a] = static_cast<double>(sum[a]) / pixels;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      m.covariance[a][b] = static_cast<double>(products[a][b]) / pixels - m.mean[a] * m.mean[b];
      m.covariance[b][a] = m.covariance[a][b];
    }
  }
  return m;
}

struct PrincipalAxis {
  double variance;
  std::array<double, 3> axis;
};

// The eigenvectors of a covariance, the largest eigenvalue first. Each points towards brighter colours.
std::array<PrincipalAxis, 3> principal_axes(Matrix3 m) {
  constexpr int kSweeps = 16;  // the matrix is diagonal to the last bit after six or fewer
  constexpr std::pair<std::size_t, std::size_t> kPairs[] = {{0, 1}, {0, 2}, {1, 2}};
  Matrix3 axes = kIdentity3;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const auto& [p, q] : kPairs) {
      rotate_to_diagonal(m, axes, p, q);
      m[p][q] = m[q][p] = 0.0;
    }
  }
  std::array<PrincipalAxis, 3> result{};
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<double, 3> axis{axes[0][k], axes[1][k], axes[2][k]};
    if (axis[0] + axis[1] + axis[2] < 0.0) {
      for (double& part : axis) part = -part;
    }
    result[k] = {m[k][k], axis};
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const PrincipalAxis& a, const PrincipalAxis& b) { return a.variance > b.variance; });
  return result;
}

// The colours' values along an axis, less the mean, in 16 bits over their own range.
struct ChannelImage {
  ExemplarImage image;
  double range;  // of the values, full scale = 1
};
ChannelImage along_axis(const ExemplarImage& image, const std::vector<std::uint16_t>& rgb,
                        const std::array<double, 3>& mean, const std::array<double, 3>& axis) {
  std::vector<double> values(rgb.size() / 3);
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a)
      values[i] += axis[a] * (static_cast<double>(rgb[3 * i + a]) - mean[a]);
  }
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  const double low = *least, range = *greatest - low;
  ChannelImage channel{{image.width, image.height, {}, {}, {}}, range / kFullScale};
  channel.image.values.reserve(values.size());
  for (const double value : values) {
    channel.image.values.push_back(static_cast<std::uint16_t>(kFullScale * ((value - low) / range) + 0.5));
  }
  return channel;
}

}  // namespace

ExemplarColors exemplar_colors(const ExemplarLayer& layer, const std::string& place) {
  if (layer.pixels == nullptr) {
    throw InputError(place + ".image: was not loaded; read the recipe from its file, beside the image");
  }
  const std::vector<std::uint16_t> rgb = to_rgb(*layer.pixels);
  const ColorMoments moments = color_moments(rgb);
  ExemplarColors colors;
  colors.mean = {moments.mean[0] / kFullScale, moments.mean[1] / kFullScale, moments.mean[2] / kFullScale};
  for (const PrincipalAxis& axis : principal_axes(moments.covariance)) {
    const double least = kLeastDeviation * kFullScale;
    if (!(axis.variance > least * least)) break;
    ChannelImage image = along_axis(*layer.pixels, rgb, moments.mean, axis.axis);
    ColorChannel channel{layer, {axis.axis[0], axis.axis[1], axis.axis[2]}};
    channel.layer.height_rms = 0.0;
    channel.layer.height_range = image.range;
    channel.layer.pixels = std::make_shared<const ExemplarImage>(std::move(image.image));
    colors.channels.push_back(std::move(channel));
  }
  return colors;
}

LayerPaint make_exemplar_paint(const ExemplarLayer& layer, const std::string& place, ArrayStore& textures) {
  const ExemplarColors colors = exemplar_colors(layer, place);
  LayerPaint paint;
  paint.mean = to_float(colors.mean);
  for (const ColorChannel& channel : colors.channels) {
    paint.channels.push_back({make_exemplar_texture(channel.layer, place, textures), to_float(channel.axis)});
  }
  return paint;
}

}  // namespace astrolith
