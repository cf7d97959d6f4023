#include "tasks/estimation/exemplar_recipe.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "numerics/files/sha256.h"
#include "numerics/length_unit.h"
#include "recipe/recipe_json.h"
#include "synthesis/picture/image_file.h"

namespace astrolith {
namespace fs = std::filesystem;

void flatten_exemplar_photo(GreyImage& photo, int degree, TrendModel trend, const std::string& name) {
  if (degree > 0 && std::min(photo.width, photo.height) >= kLeastTextureSide) {
    remove_trend(photo, degree, trend, name);
  }
}

ColorImageFile read_exemplar_photo(const std::string& file, bool colors, int degree, TrendModel trend) {
  ColorImageFile read = read_image(file, colors);
  for (GreyImage& plane : read.planes) flatten_exemplar_photo(plane, degree, trend, file);
  return read;
}

PreparedExemplar prepare_photo(const std::vector<GreyImage>& planes, const std::string& name,
                               std::uint64_t seed, const Progress& progress) {
  return planes.size() == 1 ? prepare_exemplar(planes.front(), name, seed, progress)
                            : prepare_exemplar(planes, name, seed, progress);
}

Recipe exemplar_recipe(const PreparedExemplar& prepared, const PhotoRecipeOptions& options) {
  ExemplarLayer layer = prepared.layer;
  layer.name = options.layer_name;
  if (options.mm_per_px > 0.0) layer.pixel_size = options.mm_per_px / (1e3 * metres_of(options.unit));
  if (options.height_rms >= 0.0) layer.height_rms = options.height_rms;
  Recipe recipe;
  recipe.length_unit = options.mm_per_px > 0.0 ? options.unit : "px";
  recipe.seed = options.seed;
  recipe.layers = {layer};
  const TextureScore& score = prepared.scores[static_cast<int>(prepared.variant)];
  recipe.provenance.achieved = {{"filter_distance", score.filters}, {"value_distance", score.values}};
  return recipe;
}

fs::path exemplar_image_of(const fs::path& recipe) {
  return fs::path(recipe).replace_filename(recipe.stem().string() + "_exemplar.png");
}

void write_exemplar_recipe(Recipe recipe, const fs::path& file) {
  const fs::path image = exemplar_image_of(file);
  auto& layer = std::get<ExemplarLayer>(recipe.layers.front());
  const ExemplarImage& pixels = *layer.pixels;
  if (layer.color) {
    write_png16_rgb(pixels.rgb, pixels.width, pixels.height, image);
  } else {
    write_png16_grey(pixels.values, pixels.width, pixels.height, image);
  }
  layer.image = image.filename().string();
  layer.image_sha256 = sha256_of_file(image);
  write_recipe(recipe, file);
}

nlohmann::ordered_json exemplar_figures(const PreparedExemplar& prepared) {
  auto scores = nlohmann::ordered_json::object();
  for (const ExemplarVariant variant : kExemplarVariants) {
    const TextureScore& score = prepared.scores[static_cast<int>(variant)];
    scores[std::string(variant_word(variant))] = {{"values", score.values}, {"filters", score.filters}};
  }
  return {{"variant", std::string(variant_word(prepared.variant))}, {"variants", std::move(scores)}};
}

TextureScore score_of_lobes(const PhotoFit& photo, const std::vector<float>& synthesis) {
  const FittedChannel& channel = photo.channels.front();
  const double deviation = std::sqrt(channel.variance());
  GreyImage texture{channel.exemplar.width, channel.exemplar.height, {}};
  texture.values.reserve(synthesis.size());
  for (const float v : synthesis) {
    texture.values.push_back(channel.fit.exemplar_mean + deviation * static_cast<double>(v));
  }
  return texture_score(texture, channel.exemplar);
}

}  // namespace astrolith
