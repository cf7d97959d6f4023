// Recipes as JSON files: reader, writer and the check of every rule stated in recipe.h. docs/recipe.md
// describes the fields; recipe.schema.json states them for other tools.
//
// Errors are InputError with one line "file: field.path: what is wrong; what to do".
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "recipe/recipe.h"

namespace astrolith {

// The recipe in a file of at most 64 MB; valid when returned.
Recipe read_recipe(const std::filesystem::path& file);

// The recipe in a text; `name` stands for the file in errors.
Recipe parse_recipe(std::string_view text, const std::string& name);

// Throws InputError at the first field that breaks a rule of recipe.h.
void validate_recipe(const Recipe& recipe, const std::string& name);

// Every field, one sphere or lobe a line, numbers as the shortest decimals that read back to the same bits:
// parse_recipe(recipe_to_json(r)) equals r. Bytes of strings that are not UTF-8 become U+FFFD. Throws
// WorkError when the recipe breaks a rule, since nobody could read the file.
std::string recipe_to_json(const Recipe& recipe);

// Writes the file whole or not at all. Throws what recipe_to_json and OutputFile throw.
void write_recipe(const Recipe& recipe, const std::filesystem::path& file);

// x to seven significant digits, about the precision of a float: what a fit stores, so that 200 spheres take
// about 12 kB. Round before measuring the errors that the recipe states.
double round_to_seven_digits(double x);

}  // namespace astrolith
