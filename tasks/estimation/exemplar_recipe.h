// The recipe of an exemplar layer that was made of a photo, and the PNG that the layer names.
#pragma once

#include <filesystem>

#include "recipe/recipe.h"
#include "tasks/estimation/photo_recipe.h"

namespace astrolith {

// The recipe with the layer in its physical scale, not yet with its image.
Recipe exemplar_recipe(ExemplarLayer layer, const PhotoRecipeOptions& options);

// The PNG beside a recipe: "rock.json" has "rock_exemplar.png".
std::filesystem::path exemplar_image_of(const std::filesystem::path& recipe);

// Writes the PNG of the recipe's only layer, an exemplar, and then the recipe that names it.
void write_exemplar_recipe(Recipe recipe, const std::filesystem::path& file);

}  // namespace astrolith
