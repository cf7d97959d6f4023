// Recipes as files: reader, writer and the check of every rule that recipe.h states. A file is JSON text or a
// compact recipe, which holds the same document in few bytes. docs/recipe.md describes the fields and both
// forms, and recipe.schema.json states the fields for other tools.
//
// The functions report a wrong recipe by InputError with one line "file: field.path: what is wrong; what to
// do".
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "recipe/recipe.h"

namespace astrolith {

// Reads and validates the recipe in a file of at most 64 MB, in either form. Throws InputError.
Recipe read_recipe(const std::filesystem::path& file);

// Reads and validates the recipe in the bytes of a file, in either form. `name` is the file's name in errors.
// Throws InputError.
Recipe parse_recipe(std::string_view text, const std::string& name);

// The names of images that the layers of a recipe's file state, whatever else is right or wrong in it;
// heights are not decoded. Throws InputError for a file that is not JSON and no compact recipe.
std::vector<std::string> named_images(const std::filesystem::path& file);

// Throws InputError at the first field that breaks a rule of recipe.h.
void validate_recipe(const Recipe& recipe, const std::string& name);

// The recipe's JSON text with every field. Each sphere and each lobe has a line of its own. Numbers are the
// shortest decimals that read back to equal bits, so that parse_recipe(recipe_to_json(r)) equals r. Bytes of
// strings that are not UTF-8 become U+FFFD. Throws WorkError when the recipe breaks a rule, since nobody
// could read the file.
std::string recipe_to_json(const Recipe& recipe);

// The compact recipe, which reads back to an equal recipe. Throws WorkError as recipe_to_json does, and for a
// recipe with more than 16 MB of text beside its lists of numbers.
std::string recipe_to_compact(const Recipe& recipe);

// Whether write_recipe() writes a compact recipe to a file of this name.
inline constexpr std::string_view kCompactExtension = ".astro";
bool is_compact_name(const std::filesystem::path& file);

// Whether a file of this name holds a recipe in either form (.json or .astro) and no mesh.
bool is_recipe_name(const std::filesystem::path& file);

// Writes the file whole or not at all, compact if its name ends in .astro. Throws what recipe_to_json,
// recipe_to_compact and OutputFile throw.
void write_recipe(const Recipe& recipe, const std::filesystem::path& file);

// x rounded to seven significant digits, about the precision of a float. Fits store rounded numbers, so that
// 200 spheres take about 12 kB. A fit must round before it measures the errors that the recipe states.
double round_to_seven_digits(double x);

}  // namespace astrolith
