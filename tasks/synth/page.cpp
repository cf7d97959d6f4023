#include "tasks/synth/page.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>

#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "recipe/base64.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

// The element of the page that holds the recipe, as the build of the page leaves it.
constexpr std::string_view kRecipeElement = "<script type=\"application/json\" id=\"recipe\">";
constexpr std::string_view kNoRecipe = "null";

// The page of the first prefix that has one; without any, where the first prefix should have it.
fs::path installed_page(const std::vector<fs::path>& prefixes) {
  if (const char* const stated = std::getenv("ASTROLITH_PAGE")) return stated;
  const auto page = [](const fs::path& prefix) { return prefix / "share/astrolith/page.html"; };
  const auto has_page = [&](const fs::path& prefix) {
    std::error_code none;
    return fs::is_regular_file(page(prefix), none);
  };
  const auto found = std::find_if(prefixes.begin(), prefixes.end(), has_page);
  return page(found == prefixes.end() ? prefixes.front() : *found);
}

std::string page_text(const std::vector<fs::path>& prefixes) {
  const fs::path file = installed_page(prefixes);
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::size_t at = text.find(kRecipeElement);
  if (at == std::string::npos || text.compare(at + kRecipeElement.size(), kNoRecipe.size(), kNoRecipe) != 0) {
    throw InputError("--page: " + file.string() +
                     " is missing or is not the page; run scripts/web.sh install, or name it by the "
                     "environment's ASTROLITH_PAGE");
  }
  return text;
}

// The recipe with the heights of its reliefs in it.
Recipe without_files(Recipe recipe) {
  for (Layer& layer : recipe.layers) {
    auto* const relief = std::get_if<ReliefLayer>(&layer);
    if (relief != nullptr && relief->pixels != nullptr) relief->image.clear(), relief->image_sha256.clear();
  }
  return recipe;
}

}  // namespace

std::vector<fs::path> page_files(const std::string& folder) { return {fs::path(folder) / "index.html"}; }

fs::path program_prefix() {
  std::error_code none;
  return fs::read_symlink("/proc/self/exe", none).parent_path().parent_path();
}

void check_page(const Recipe& recipe, const fs::path& file, const std::vector<fs::path>& prefixes) {
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    const Layer& layer = recipe.layers[i];
    if (find_image(layer) == nullptr || std::holds_alternative<ReliefLayer>(layer)) continue;
    throw InputError(file.string() + ": layers[" + std::to_string(i) +
                     "].image: is a file, which a page cannot read; leave out --page, or this layer");
  }
  page_text(prefixes);
}

void write_page(const Recipe& recipe, const fs::path& file, const fs::path& folder,
                const std::vector<fs::path>& prefixes) {
  const std::string name = file.stem().string() + ".astro";
  const nlohmann::ordered_json held = {{"name", name},
                                       {"bytes", base64_text(recipe_to_compact(without_files(recipe)))}};
  std::string element = held.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
  for (std::size_t at = 0; (at = element.find('<', at)) != std::string::npos;)
    element.replace(at, 1, "\\u003c");
  std::string text = page_text(prefixes);
  text.replace(text.find(kRecipeElement) + kRecipeElement.size(), kNoRecipe.size(), element);
  make_output_folder(folder);
  write_file(page_files(folder.string()).front(), text);
}

}  // namespace astrolith
