#include "estimation/gabor/exemplar/exemplar_preparation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "estimation/gabor/spectrum/border_taper.h"
#include "numerics/errors.h"
#include "numerics/progress.h"
#include "numerics/sample_statistics.h"
#include "numerics/srgb.h"
#include "recipe/recipe_json.h"
#include "synthesis/exemplar/plane_exemplar.h"

namespace astrolith {
namespace {

void heed_exemplar(const Progress& progress, double fraction) {
  if (!report(progress, fraction, "exemplar")) throw WorkError("stopped before the exemplar was prepared");
}

// The image whose ranks are those of `ranks` and whose values are those of `values`.
GreyImage reordered(const GreyImage& ranks, const GreyImage& values, const Progress& progress) {
  std::vector<std::size_t> order(ranks.values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return ranks.values[a] < ranks.values[b]; });
  heed_exemplar(progress, 0.6);
  std::vector<double> ascending = values.values;
  std::sort(ascending.begin(), ascending.end());
  GreyImage result = ranks;
  for (std::size_t i = 0; i < order.size(); ++i) result.values[order[i]] = ascending[i];
  return result;
}

GreyImage continued(const GreyImage& photo, ExemplarVariant variant, const Progress& progress) {
  heed_exemplar(progress, 0.0);
  if (variant == ExemplarVariant::kMirrored) return photo;
  GreyImage periodic = decompose_periodic(photo).periodic;
  if (variant != ExemplarVariant::kMatched) return periodic;
  heed_exemplar(progress, 0.2);
  return reordered(periodic, photo, stretch(progress, 0.2, 1.0));
}

// The height has the deviation of the image, not of the photo: where its periodic component lacks light from
// one side, its grains are no higher for that.
struct VariantImage {
  ExemplarLayer layer;
  GreyImage luma;
};
VariantImage make_variant(const std::vector<GreyImage>& planes, ExemplarVariant variant,
                          const Progress& progress) {
  std::vector<GreyImage> image;
  for (const GreyImage& plane : planes) {
    const double from = static_cast<double>(image.size()), all = static_cast<double>(planes.size()) + 1.0;
    image.push_back(continued(plane, variant, stretch(progress, from / all, (from + 1.0) / all)));
  }
  heed_exemplar(progress, 0.8);
  const bool color = planes.size() == 3;
  GreyImage luma = color ? luma_image(image) : image.front();
  ExemplarLayer layer;
  layer.pixels = std::make_shared<const ExemplarImage>(color ? colors_in_16_bits(image) : in_16_bits(luma));
  layer.border = variant == ExemplarVariant::kMirrored ? ExemplarBorder::kMirror : ExemplarBorder::kRepeat;
  layer.height_rms = round_to_seven_digits(std::sqrt(sample_variance(luma.values)));
  layer.color = color;
  return {std::move(layer), std::move(luma)};
}

// The image beside its mirror image.
GreyImage with_mirror_image(const GreyImage& image) {
  GreyImage both{2 * image.width, image.height, {}};
  both.values.reserve(2 * image.values.size());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) both.values.push_back(image.at(x, y));
    for (int x = image.width; x-- > 0;) both.values.push_back(image.at(x, y));
  }
  return both;
}

// The scores are those of the middle of a larger photo.
constexpr int kMostJudgedSide = 1024;

// `photo` is the grey photo, or the luma of the planes.
PreparedExemplar nearest_variant(const std::vector<GreyImage>& planes, const GreyImage& photo,
                                 const std::string& name, std::uint64_t seed, const Progress& progress,
                                 std::optional<ExemplarVariant> only) {
  require_exemplar(photo, name);
  const GreyImage judged = photo.middle(kMostJudgedSide);
  const int side = std::min(judged.width, judged.height);
  const OrientedSlopes direction(judged, side);
  PreparedExemplar best;
  for (const ExemplarVariant variant : kExemplarVariants) {
    if (only && variant != *only) continue;
    const int number = static_cast<int>(variant);
    const Progress part = stretch(progress, number / 3.0, (number + 1) / 3.0);
    auto [layer, luma] = make_variant(planes, variant, stretch(part, 0.0, 0.6));
    heed_exemplar(part, 0.6);
    const GreyImage texture = exemplar_texture_like(layer, judged, seed);
    heed_exemplar(part, 0.8);
    best.scores[number] = texture_score(texture, judged);
    // A texture takes its pieces from all over the continued image, whose slopes are its own in the mean.
    // The slopes of a single texture would scatter.
    const GreyImage middle = luma.middle(kMostJudgedSide);
    const bool mirrors = variant == ExemplarVariant::kMirrored;
    best.scores[number]->direction =
        OrientedSlopes(mirrors ? with_mirror_image(middle) : middle, side).difference_from(direction);
    if (best.layer.pixels && best.scores[number]->sum() >= best.score().sum()) continue;
    best.variant = variant;
    best.layer = std::move(layer);
  }
  report(progress, 1.0, "exemplar");
  return best;
}

}  // namespace

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
    result.values.push_back(rgb_luma(pixel[0], pixel[1], pixel[2]));
  }
  return result;
}

GreyImage luma_image(const std::vector<GreyImage>& planes) {
  GreyImage luma{planes[0].width, planes[0].height, {}, planes[0].missing};
  luma.values.reserve(planes[0].values.size());
  for (std::size_t i = 0; i < planes[0].values.size(); ++i) {
    luma.values.push_back(0.2126 * planes[0].values[i] + 0.7152 * planes[1].values[i] +
                          0.0722 * planes[2].values[i]);
  }
  return luma;
}

std::string_view variant_word(ExemplarVariant variant) {
  constexpr std::string_view kWords[] = {"periodic", "matched", "mirrored"};
  return kWords[static_cast<int>(variant)];
}

std::optional<ExemplarVariant> variant_named(std::string_view word) {
  for (const ExemplarVariant variant : kExemplarVariants) {
    if (word == variant_word(variant)) return variant;
  }
  return {};
}

GreyImage exemplar_texture_like(const ExemplarLayer& layer, const GreyImage& photo, std::uint64_t seed) {
  const std::vector<float> heights =
      synthesize_exemplar(layer, "exemplar", photo.width, photo.height, {seed, 0, false});
  const double mean = sample_mean(photo.values);
  GreyImage texture{photo.width, photo.height, {}};
  for (const float height : heights) texture.values.push_back(mean + double{height});
  return texture;
}

PreparedExemplar prepare_exemplar(const GreyImage& photo, const std::string& name, std::uint64_t seed,
                                  const Progress& progress, std::optional<ExemplarVariant> only) {
  return nearest_variant({photo}, photo, name, seed, progress, only);
}

PreparedExemplar prepare_exemplar(const std::vector<GreyImage>& planes, const std::string& name,
                                  std::uint64_t seed, const Progress& progress,
                                  std::optional<ExemplarVariant> only) {
  require_colors(planes, name);
  return nearest_variant(planes, luma_image(planes), name, seed, progress, only);
}

}  // namespace astrolith
