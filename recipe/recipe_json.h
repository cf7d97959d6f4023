// Recipes as JSON files: reader, writer and the check of every rule that recipe.h states. docs/recipe.md
// describes the fields, and recipe.schema.json states them for other tools.
//
// The functions report a wrong recipe by InputError with one line "file: field.path: what is wrong; what to
// do".
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "recipe/recipe.h"

namespace astrolith {

// Reads and validates the recipe in a file of at most 64 MB. Throws InputError.
Recipe read_recipe(const std::filesystem::path& file);

// Reads and validates the recipe in a text. `name` is the file's name in errors. Throws InputError.
Recipe parse_recipe(std::string_view text, const std::string& name);

// Throws InputError at the first field that breaks a rule of recipe.h.
void validate_recipe(const Recipe& recipe, const std::string& name);

// The recipe's JSON text with every field. Each sphere and each lobe has a line of its own. Numbers are the
// shortest decimals that read back to equal bits, so that parse_recipe(recipe_to_json(r)) equals r. Bytes of
// strings that are not UTF-8 become U+FFFD. Throws WorkError when the recipe breaks a rule, since nobody
// could read the file.
std::string recipe_to_json(const Recipe& recipe);

// Writes the file whole or not at all. Throws what recipe_to_json and OutputFile throw.
void write_recipe(const Recipe& recipe, const std::filesystem::path& file);

// x rounded to seven significant digits, about the precision of a float. Fits store rounded numbers, so that
// 200 spheres take about 12 kB. A fit must round before it measures the errors that the recipe states.
double round_to_seven_digits(double x);

}  // namespace astrolith
