#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "recipe/body_internal.h"
#include "recipe/expect_internal.h"
#include "recipe/landforms_internal.h"
#include "recipe/noise_layers_internal.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

void check(const Erosion& erosion, const Place& place) {
  expect_range(erosion.talus_angle, place.field("talus_angle"), 1.0, 85.0);
  expect_integer(erosion.iterations, place.field("iterations"), 1, 100000);
  expect_range(erosion.density, place.field("density"), 1.0, 30000.0);
  if (erosion.rotation_period != 0.0) {
    expect_range(erosion.rotation_period, place.field("rotation_period"), 0.01, 1e6);
  }
}

template <typename T>
void expect_sorted(const std::vector<std::pair<std::string, T>>& named, const Place& place) {
  for (std::size_t i = 1; i < named.size(); ++i) {
    if (!(named[i - 1].first < named[i].first)) {
      place.fail("must be sorted by name, each name once: " + quote_text(named[i].first) + " is not");
    }
  }
}

void check(const Provenance& provenance, const Place& place) {
  if (provenance.input_name.find('/') != std::string::npos) {
    place.field("input_name")
        .fail("must be a file name without folders, is " + quote_text(provenance.input_name));
  }
  const std::string& hash = provenance.input_sha256;
  const bool digits = std::all_of(hash.begin(), hash.end(), [](unsigned char c) { return std::isxdigit(c); });
  if (!hash.empty() && (hash.size() != 64 || !digits)) {
    place.field("input_sha256").fail("must be 64 hexadecimal digits or empty, is " + quote_text(hash));
  }
  expect_sorted(provenance.options, place.field("options"));
  const Place achieved = place.field("achieved");
  expect_sorted(provenance.achieved, achieved);
  for (const auto& [name, value] : provenance.achieved) {
    if (!std::isfinite(value)) achieved.field(name).fail(fmt::format("must be finite, is {}", value));
  }
}

}  // namespace

void validate_recipe(const Recipe& recipe, const std::string& name) {
  const Place place(name);
  if (recipe.format_version != kRecipeFormatVersion) {
    place.field("format_version")
        .fail(fmt::format("must be {}, is {}", kRecipeFormatVersion, recipe.format_version));
  }
  const std::string& unit = recipe.length_unit;
  if (unit != "m" && unit != "km" && unit != "px") {
    place.field("length_unit").fail("must be \"m\", \"km\" or \"px\", is " + quote_text(unit));
  }
  if (recipe.seed >= std::uint64_t{1} << 53) {
    place.field("seed").fail(fmt::format("must be below 2^53, is {}", recipe.seed));
  }
  check(recipe.provenance, place.field("provenance"));
  if (!recipe.body && recipe.layers.empty()) place.fail("has neither a body nor layers; add one of them");
  if (recipe.body) check(*recipe.body, place.field("body"));
  const Place layers = place.field("layers");
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    const Place at = layers.element(i);
    std::visit([&](const auto& layer) { check(layer, at); }, recipe.layers[i]);
    check_use(recipe, i, at);
  }
  if (!recipe.erosion) return;
  check(*recipe.erosion, place.field("erosion"));
  if (!recipe.body) place.field("erosion").fail("needs a body; add one, or leave it out");
}

}  // namespace astrolith
