// Recipes with the images that their layers name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "recipe/recipe.h"

namespace astrolith {

// Reads the recipe of a file or of a body of the library (find_body()) and decodes the images of its layers.
// Throws InputError as read_recipe() does, and for an image that is missing, that has changed since the
// recipe was written, or that decode_grey_png() refuses.
Recipe load_recipe(const std::filesystem::path& file);

// Decodes the images of a recipe's layers, whose paths are relative to `folder`. `name` is the name
// of the recipe in messages. Throws as load_recipe() does.
void load_images(Recipe& recipe, const std::filesystem::path& folder, const std::string& name);

// Writes a recipe. The paths of its decoded images become relative to the folder of `file`. The pixels of a
// relief that no file holds are written beside it, as FILE.relief.png, or into a compact recipe. Throws as
// write_recipe() does.
void write_loaded_recipe(Recipe recipe, const std::filesystem::path& file);

// The recipe files of these names with all images that their layers name. What cannot be read names none.
std::vector<std::filesystem::path> recipe_and_images(const std::vector<std::string>& names);

// The files that write_loaded_recipe() writes for these names, where the recipe has one new relief.
std::vector<std::filesystem::path> recipe_and_relief(const std::vector<std::string>& names);

}  // namespace astrolith
