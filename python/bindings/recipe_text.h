// Recipes from the text that Python hands over.
#pragma once

#include <filesystem>
#include <string>

#include "recipe/recipe_json.h"
#include "tasks/job/load_recipe.h"

namespace astrolith::python {

// The recipe, ready to be evaluated. The paths of its images are relative to the current folder:
// Recipe.read() has made them so.
inline Recipe loaded_recipe(const std::string& json, const std::filesystem::path& name) {
  Recipe recipe = parse_recipe(json, name.string());
  load_images(recipe, {}, name.string());
  return recipe;
}

}  // namespace astrolith::python
