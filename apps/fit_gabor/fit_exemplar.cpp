#include "apps/fit_gabor/fit_exemplar.h"

#include <fmt/format.h>

#include "estimation/gabor/image/image_reader.h"
#include "recipe/recipe_json.h"
#include "recipe/sha256.h"
#include "synthesis/picture/image_file.h"

namespace astrolith {
namespace fs = std::filesystem;

GreyImage read_exemplar_photo(Program& program, const std::string& file, int degree, TrendModel trend) {
  ImageFile read = read_grey_image(file);
  for (const std::string& remark : read.remarks) program.say(file + ": " + remark);
  if (degree > 0 && std::min(read.image.width, read.image.height) >= kLeastTextureSide) {
    remove_trend(read.image, degree, trend, file);
  }
  return std::move(read.image);
}

ExemplarLayer scaled_exemplar(const PreparedExemplar& prepared, const PhotoRecipeOptions& options) {
  ExemplarLayer layer = prepared.layer;
  layer.name = options.layer_name;
  if (options.mm_per_px > 0.0) layer.pixel_size = options.mm_per_px / (options.unit == "km" ? 1e6 : 1e3);
  if (options.height_rms >= 0.0) layer.height_rms = options.height_rms;
  return layer;
}

fs::path exemplar_image_of(const fs::path& recipe) {
  return fs::path(recipe).replace_filename(recipe.stem().string() + "_exemplar.png");
}

void write_exemplar_recipe(Recipe recipe, const ExemplarLayer& layer, const fs::path& file) {
  const fs::path image = exemplar_image_of(file);
  write_png16_grey(layer.pixels->values, layer.pixels->width, layer.pixels->height, image);
  ExemplarLayer named = layer;
  named.image = image.filename().string();
  named.image_sha256 = sha256_of_file(image);
  recipe.layers = {named};
  write_recipe(recipe, file);
}

void report_exemplar(Program& program, const PreparedExemplar& prepared) {
  auto scores = nlohmann::ordered_json::object();
  for (const ExemplarVariant variant : kExemplarVariants) {
    const TextureScore& score = prepared.scores[static_cast<int>(variant)];
    scores[std::string(variant_word(variant))] = {{"values", score.values}, {"filters", score.filters}};
  }
  const TextureScore& best = prepared.scores[static_cast<int>(prepared.variant)];
  program.summary["variant"] = std::string(variant_word(prepared.variant));
  program.summary["variants"] = std::move(scores);
  program.say(fmt::format(
      "exemplar: {}; a texture of it differs from the photo by {:.3f} in values and {:.3f} in filters",
      variant_word(prepared.variant), best.values, best.filters));
}

}  // namespace astrolith
