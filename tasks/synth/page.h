// The page that makes a recipe's body in a browser (web/).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "recipe/recipe.h"

namespace astrolith {

// The files that write_page() writes into a folder.
std::vector<std::filesystem::path> page_files(const std::string& folder);

// The prefix of this program: /usr for /usr/bin/synth.
std::filesystem::path program_prefix();

// Throws InputError where the page is not installed (share/astrolith/page.html in one of the prefixes, or the
// file that the environment's ASTROLITH_PAGE names), and for a recipe whose layers name files other than a
// relief's, which a page cannot read. `file` is the recipe's.
void check_page(const Recipe& recipe, const std::filesystem::path& file,
                const std::vector<std::filesystem::path>& prefixes);

// Writes the page with the recipe in it, after check_page(). Throws as OutputFile does.
void write_page(const Recipe& recipe, const std::filesystem::path& file, const std::filesystem::path& folder,
                const std::vector<std::filesystem::path>& prefixes);

}  // namespace astrolith
