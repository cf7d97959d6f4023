#include "estimation/gabor/exemplar/exemplar_pixels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/errors.h"
#include "numerics/srgb.h"

namespace astrolith {

void require_exemplar(const GreyImage& photo, const std::string& name) {
  const auto [least, most] = std::minmax(photo.width, photo.height);
  if (least < kLeastTextureSide || most > kMostTextureSide) {
    throw InputError(fmt::format("{}: is {} x {} pixels; cut out or scale it to sides of {} to {}", name,
                                 photo.width, photo.height, kLeastTextureSide, kMostTextureSide));
  }
  const auto [darkest, brightest] = std::minmax_element(photo.values.begin(), photo.values.end());
  if (!(*brightest - *darkest > 1e-6 * std::max(std::fabs(*darkest), std::fabs(*brightest)))) {
    throw InputError(name + ": has one grey value only; use another image");
  }
}

void require_colors(const std::vector<GreyImage>& planes, const std::string& name) {
  for (const GreyImage& plane : planes) {
    const auto [least, greatest] = std::minmax_element(plane.values.begin(), plane.values.end());
    if (*least >= -1.0 && *greatest <= 2.0) continue;
    throw InputError(fmt::format(
        "{}: has values of {:g} to {:g}, and colours are 0 to 1; scale them, or fit the luminance", name,
        *least, *greatest));
  }
}

ExemplarImage in_16_bits(const GreyImage& image) {
  const auto [darkest, brightest] = std::minmax_element(image.values.begin(), image.values.end());
  const double low = *darkest, scale = 65535.0 / (*brightest - low);
  ExemplarImage result{image.width, image.height, {}, {}};
  result.values.reserve(image.values.size());
  for (const double v : image.values) {
    result.values.push_back(static_cast<std::uint16_t>(std::lround(scale * (v - low))));
  }
  return result;
}

ExemplarImage colors_in_16_bits(const std::vector<GreyImage>& planes) {
  ExemplarImage result{planes[0].width, planes[0].height, {}, {}, {}};
  for (std::size_t i = 0; i < planes[0].values.size(); ++i) {
    std::array<std::uint16_t, 3> pixel{};
    for (std::size_t k = 0; k < 3; ++k) {
      pixel[k] = static_cast<std::uint16_t>(std::lround(65535.0 * std::clamp(planes[k].values[i], 0.0, 1.0)));
    }
    result.rgb.insert(result.rgb.end(), pixel.begin(), pixel.end());
    result.values.push_back(luma_of(pixel[0], pixel[1], pixel[2]));
  }
  return result;
}

GreyImage luma_of(const std::vector<GreyImage>& planes) {
  GreyImage luma{planes[0].width, planes[0].height, {}, planes[0].missing};
  luma.values.reserve(planes[0].values.size());
  for (std::size_t i = 0; i < planes[0].values.size(); ++i) {
    luma.values.push_back(0.2126 * planes[0].values[i] + 0.7152 * planes[1].values[i] +
                          0.0722 * planes[2].values[i]);
  }
  return luma;
}

}  // namespace astrolith
