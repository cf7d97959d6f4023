#include "estimation/gabor/exemplar/exemplar_preparation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "estimation/gabor/spectrum/periodic_component.h"
#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "synthesis/exemplar/plane_exemplar.h"

namespace astrolith {
namespace {

void check_photo(const GreyImage& photo, const std::string& name) {
  const auto [least, most] = std::minmax(photo.width, photo.height);
  if (least < kLeastTextureSide || most > kMostExemplarSide) {
    throw InputError(fmt::format("{}: is {} x {} pixels; cut out or scale it to sides of {} to {}", name,
                                 photo.width, photo.height, kLeastTextureSide, kMostExemplarSide));
  }
  const auto [darkest, brightest] = std::minmax_element(photo.values.begin(), photo.values.end());
  if (!(*brightest - *darkest > 1e-6 * std::max(std::fabs(*darkest), std::fabs(*brightest)))) {
    throw InputError(name + ": has one grey value only; use another image");
  }
}

struct PhotoMoments {
  double mean, deviation;
};
PhotoMoments photo_moments(const GreyImage& photo) {
  const auto n = static_cast<double>(photo.values.size());
  double mean = 0.0, square = 0.0;
  for (const double v : photo.values) mean += v;
  mean /= n;
  for (const double v : photo.values) square += (v - mean) * (v - mean);
  return {mean, std::sqrt(square / n)};
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

ExemplarLayer layer_of_variant(const GreyImage& photo, ExemplarVariant variant) {
  ExemplarLayer layer;
  layer.pixels = std::make_shared<const ExemplarImage>(in_16_bits(continued(photo, variant)));
  layer.border = variant == ExemplarVariant::kMirrored ? ExemplarBorder::kMirror : ExemplarBorder::kRepeat;
  layer.height_rms = round_to_seven_digits(photo_moments(photo).deviation);
  return layer;
}

}  // namespace

std::string_view variant_word(ExemplarVariant variant) {
  constexpr std::string_view kWords[] = {"periodic", "matched", "mirrored"};
  return kWords[static_cast<int>(variant)];
}

GreyImage exemplar_texture_like(const ExemplarLayer& layer, const GreyImage& photo, std::uint64_t seed) {
  const std::vector<float> heights =
      synthesize_exemplar(layer, "exemplar", photo.width, photo.height, {seed, 0, false});
  const double mean = photo_moments(photo).mean;
  GreyImage texture{photo.width, photo.height, {}};
  for (const float height : heights) texture.values.push_back(mean + double{height});
  return texture;
}

PreparedExemplar prepare_exemplar(const GreyImage& photo, const std::string& name, std::uint64_t seed,
                                  const Progress& progress) {
  check_photo(photo, name);
  PreparedExemplar best;
  for (const ExemplarVariant variant : kExemplarVariants) {
    const int number = static_cast<int>(variant);
    if (!report(progress, number / 3.0, "exemplar"))
      throw WorkError("stopped before the exemplar was prepared");
    ExemplarLayer layer = layer_of_variant(photo, variant);
    best.scores[number] = texture_score(exemplar_texture_like(layer, photo, seed), photo);
    if (number > 0 && best.scores[number].sum() >= best.scores[static_cast<int>(best.variant)].sum())
      continue;
    best.variant = variant;
    best.layer = std::move(layer);
  }
  report(progress, 1.0, "exemplar");
  return best;
}

}  // namespace astrolith
