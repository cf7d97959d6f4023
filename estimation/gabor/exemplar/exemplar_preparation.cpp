#include "estimation/gabor/exemplar/exemplar_preparation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "estimation/gabor/exemplar/exemplar_pixels.h"
#include "estimation/gabor/spectrum/periodic_component.h"
#include "numerics/errors.h"
#include "numerics/progress_stretch.h"
#include "numerics/sample_statistics.h"
#include "recipe/recipe_json.h"
#include "synthesis/exemplar/plane_exemplar.h"

namespace astrolith {
namespace {

void heed_exemplar(const Progress& progress, double fraction) {
  if (!report(progress, fraction, "exemplar")) throw WorkError("stopped before the exemplar was prepared");
}

// The image whose ranks are those of `ranks` and whose values are those of `values`.
GreyImage with_ranks_of(const GreyImage& ranks, const GreyImage& values, const Progress& progress) {
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
  return with_ranks_of(periodic, photo, stretch(progress, 0.2, 1.0));
}

// The height has the deviation of the image, not of the photo: where its periodic component lacks light from
// one side, its grains are no higher for that.
ExemplarLayer layer_of_variant(const std::vector<GreyImage>& planes, ExemplarVariant variant,
                               const Progress& progress) {
  std::vector<GreyImage> image;
  for (const GreyImage& plane : planes) {
    const double from = static_cast<double>(image.size()), all = static_cast<double>(planes.size()) + 1.0;
    image.push_back(continued(plane, variant, stretch(progress, from / all, (from + 1.0) / all)));
  }
  heed_exemplar(progress, 0.8);
  const bool color = planes.size() == 3;
  const GreyImage luma = color ? luma_of(image) : image.front();
  ExemplarLayer layer;
  layer.pixels = std::make_shared<const ExemplarImage>(color ? colors_in_16_bits(image) : in_16_bits(luma));
  layer.border = variant == ExemplarVariant::kMirrored ? ExemplarBorder::kMirror : ExemplarBorder::kRepeat;
  layer.height_rms = round_to_seven_digits(std::sqrt(variance_of(luma.values)));
  layer.color = color;
  return layer;
}

// The scores are those of the middle of a larger photo.
constexpr int kMostJudgedSide = 1024;

// `photo` is the grey photo, or the luma of the planes.
PreparedExemplar nearest_variant(const std::vector<GreyImage>& planes, const GreyImage& photo,
                                 const std::string& name, std::uint64_t seed, const Progress& progress) {
  require_exemplar(photo, name);
  const GreyImage judged = photo.middle(kMostJudgedSide);
  PreparedExemplar best;
  for (const ExemplarVariant variant : kExemplarVariants) {
    const int number = static_cast<int>(variant);
    const Progress part = stretch(progress, number / 3.0, (number + 1) / 3.0);
    ExemplarLayer layer = layer_of_variant(planes, variant, stretch(part, 0.0, 0.6));
    heed_exemplar(part, 0.6);
    const GreyImage texture = exemplar_texture_like(layer, judged, seed);
    heed_exemplar(part, 0.8);
    best.scores[number] = texture_score(texture, judged);
    if (number > 0 && best.scores[number].sum() >= best.scores[static_cast<int>(best.variant)].sum())
      continue;
    best.variant = variant;
    best.layer = std::move(layer);
  }
  report(progress, 1.0, "exemplar");
  return best;
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
  require_colors(planes, name);
  return nearest_variant(planes, luma_of(planes), name, seed, progress);
}

}  // namespace astrolith
