// The recipe of a photo's Gabor layers or exemplar layer, the PNG that such a layer names, and the figures of
// the fit.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "estimation/gabor/photo_fit.h"
#include "recipe/recipe.h"

namespace astrolith {

struct PhotoRecipeOptions {
  std::string layer_name;    // of all layers
  double mm_per_px = 0.0;    // size of a pixel on the ground; 0: none, and lengths are pixels
  std::string unit = "m";    // "m" or "km", where mm_per_px is given
  double height_rms = -1.0;  // of the first layer, length units; negative: the exemplar's own contrast
  std::uint64_t seed = 1;
  double unit_per_value = 1.0;  // length units of a grey value of 1, for the exemplar's own contrast
};

// The recipe, whose provenance states what the fit achieved. Tool, input and options of the provenance are
// the caller's.
Recipe photo_recipe(const PhotoFit& photo, const PhotoRecipeOptions& options);

// The figures of the fit, for summaries.
nlohmann::ordered_json photo_figures(const PhotoFit& photo);
nlohmann::ordered_json gaussianity_figures(const Gaussianity& gaussianity);

// The recipe with the layer in its physical scale, not yet with its image.
Recipe exemplar_recipe(ExemplarLayer layer, const PhotoRecipeOptions& options);

// The PNG beside a recipe: "rock.json" has "rock_exemplar.png".
std::filesystem::path exemplar_image_path(const std::filesystem::path& recipe);

// Writes the PNG of the recipe's only layer, an exemplar, and then the recipe that names it.
void write_exemplar_recipe(Recipe recipe, const std::filesystem::path& file);

}  // namespace astrolith
