#include "tasks/estimation/exemplar_recipe.h"

#include <string>
#include <utility>

#include "numerics/files/sha256.h"
#include "numerics/length_unit.h"
#include "recipe/recipe_json.h"
#include "synthesis/picture/image_file.h"

namespace astrolith {
namespace fs = std::filesystem;

Recipe exemplar_recipe(ExemplarLayer layer, const PhotoRecipeOptions& options) {
  layer.name = options.layer_name;
  if (options.mm_per_px > 0.0) layer.pixel_size = options.mm_per_px / (1e3 * metres_of(options.unit));
  layer.height_rms =
      options.height_rms >= 0.0 ? options.height_rms : layer.height_rms * options.unit_per_value;
  Recipe recipe;
  recipe.length_unit = options.mm_per_px > 0.0 ? options.unit : "px";
  recipe.seed = options.seed;
  recipe.layers = {std::move(layer)};
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

}  // namespace astrolith
