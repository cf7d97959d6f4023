// Recipes with the images that their layers name.
#pragma once

#include <filesystem>

#include "recipe/recipe.h"

namespace astrolith {

// Reads a recipe's file and decodes the images of its layers. Throws InputError as read_recipe()
// does, and for an image that is missing, that has changed since the recipe was written, or that
// decode_grey_png() refuses.
Recipe load_recipe(const std::filesystem::path& file);

// Decodes the images of a recipe's layers, whose paths are relative to `folder`. `name` is the name
// of the recipe in messages. Throws as load_recipe() does.
void load_images(Recipe& recipe, const std::filesystem::path& folder, const std::string& name);

// Writes a recipe. The paths of its decoded images become relative to the folder of `file`. The pixels of a
// relief that no file holds are written beside it, as FILE.relief.png, or into a compact recipe. Throws as
// write_recipe() does.
void write_loaded_recipe(Recipe recipe, const std::filesystem::path& file);

}  // namespace astrolith
