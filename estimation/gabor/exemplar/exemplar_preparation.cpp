#include "estimation/gabor/exemplar/exemplar_preparation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "estimation/gabor/spectrum/periodic_component.h"
#include "numerics/errors.h"
#include "numerics/sample_statistics.h"
#include "numerics/srgb.h"
#include "recipe/recipe_json.h"
#include "synthesis/exemplar/plane_exemplar.h"

namespace astrolith {
namespace {

void check_photo(const GreyImage& photo, const std::string& name) {
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

// The image whose ranks are those of `ranks` and whose values are those of `values`.
GreyImage with_ranks_of(const GreyImage& ranks, const GreyImage& values) {
  std::vector<std::size_t> order(ranks.values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return ranks.values[a] < ranks.values[b]; });
  std::vector<double> ascending = values.values;
  std::sort(ascending.begin(), ascending.end());
  GreyImage result = ranks;
  for (std::size_t i = 0; i < order.size(); ++i) result.values[order[i]] = ascending[i];
  return result;
}

// The image in 16 bits: the darkest pixel becomes 0, the brightest 65535.
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

GreyImage continued(const GreyImage& photo, ExemplarVariant variant) {
  if (variant == ExemplarVariant::kMirrored) return photo;
  GreyImage periodic = decompose_periodic(photo).periodic;
  return variant == ExemplarVariant::kMatched ? with_ranks_of(periodic, photo) : periodic;
}

// The colours in 16 bits of full scale, with their luma.
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

// The image of a variant: of a grey photo, which is one plane, or of red, green and blue.
ExemplarImage image_of_variant(const std::vector<GreyImage>& planes, ExemplarVariant variant) {
  if (planes.size() == 1) return in_16_bits(continued(planes.front(), variant));
  std::vector<GreyImage> colors;
  for (const GreyImage& plane : planes) colors.push_back(continued(plane, variant));
  return colors_in_16_bits(colors);
}

ExemplarLayer layer_of_variant(const std::vector<GreyImage>& planes, const GreyImage& photo,
                               ExemplarVariant variant) {
  ExemplarLayer layer;
  layer.pixels = std::make_shared<const ExemplarImage>(image_of_variant(planes, variant));
  layer.border = variant == ExemplarVariant::kMirrored ? ExemplarBorder::kMirror : ExemplarBorder::kRepeat;
  layer.height_rms = round_to_seven_digits(std::sqrt(variance_of(photo.values)));
  layer.color = planes.size() == 3;
  return layer;
}

// `photo` is the grey photo, or the luma of the planes.
PreparedExemplar nearest_variant(const std::vector<GreyImage>& planes, const GreyImage& photo,
                                 const std::string& name, std::uint64_t seed, const Progress& progress) {
  check_photo(photo, name);
  PreparedExemplar best;
  for (const ExemplarVariant variant : kExemplarVariants) {
    const int number = static_cast<int>(variant);
    if (!report(progress, number / 3.0, "exemplar"))
      throw WorkError("stopped before the exemplar was prepared");
    ExemplarLayer layer = layer_of_variant(planes, photo, variant);
    best.scores[number] = texture_score(exemplar_texture_like(layer, photo, seed), photo);
    if (number > 0 && best.scores[number].sum() >= best.scores[static_cast<int>(best.variant)].sum())
      continue;
    best.variant = variant;
    best.layer = std::move(layer);
  }
  report(progress, 1.0, "exemplar");
  return best;
}

void check_colors(const std::vector<GreyImage>& planes, const std::string& name) {
  for (const GreyImage& plane : planes) {
    const auto [least, greatest] = std::minmax_element(plane.values.begin(), plane.values.end());
    if (*least >= -1.0 && *greatest <= 2.0) continue;
    throw InputError(fmt::format(
        "{}: has values of {:g} to {:g}, and colours are 0 to 1; scale them, or fit the luminance", name,
        *least, *greatest));
  }
}

}  // namespace

std::string_view variant_word(ExemplarVariant variant) {
  constexpr std::string_view kWords[] = {"periodic", "matched", "mirrored"};
  return kWords[static_cast<int>(variant)];
}

GreyImage exemplar_texture_like(const ExemplarLayer& layer, const GreyImage& photo, std::uint64_t seed) {
  const std::vector<float> heights =
      synthesize_exemplar(layer, "exemplar", photo.width, photo.height, {seed, 0, false});
  const double mean = mean_of(photo.values);
  GreyImage texture{photo.width, photo.height, {}};
  for (const float height : heights) texture.values.push_back(mean + double{height});
  return texture;
}

PreparedExemplar prepare_exemplar(const GreyImage& photo, const std::string& name, std::uint64_t seed,
                                  const Progress& progress) {
  return nearest_variant({photo}, photo, name, seed, progress);
}

PreparedExemplar prepare_exemplar(const std::vector<GreyImage>& planes, const std::string& name,
                                  std::uint64_t seed, const Progress& progress) {
  check_colors(planes, name);
  return nearest_variant(planes, luma_of(planes), name, seed, progress);
}

GreyImage luma_of(const std::vector<GreyImage>& planes) {
  GreyImage luma{planes[0].width, planes[0].height, {}};
  luma.values.reserve(planes[0].values.size());
  for (std::size_t i = 0; i < planes[0].values.size(); ++i) {
    luma.values.push_back(0.2126 * planes[0].values[i] + 0.7152 * planes[1].values[i] +
                          0.0722 * planes[2].values[i]);
  }
  return luma;
}

}  // namespace astrolith
