#include <algorithm>
#include <cmath>
#include <span>

#include "recipe/expect_internal.h"
#include "recipe/noise_layers_internal.h"
#include "recipe/recipe.h"

namespace astrolith {
namespace {

bool has_name(const Layer& layer, const std::string& name) {
  return std::visit([&](const auto& l) { return l.name == name; }, layer);
}

// A recipe without a body is laid on one later.
void check(const Locality& locality, const std::optional<MetaballBody>& body, const Place& place) {
  expect_positive(locality.width, place.field("width"));
  if (body && body->find_group(locality.group) == nullptr) {
    place.field("group").fail("the body has no group " + quote_text(locality.group) +
                              "; name one of body.groups");
  }
}

void check(const LayerMask& mask, std::span<const Layer> before, const Place& place) {
  expect_number(mask.from, place.field("from"));
  expect_number(mask.to, place.field("to"));
  const double apart = std::fabs(mask.to - mask.from);
  if (apart < kMinPositive || apart < 1e-6 * std::max(std::fabs(mask.from), std::fabs(mask.to))) {
    place.field("to").fail("is too near to `from` for a border; move one of them");
  }
  const Place at = place.field("layer");
  if (mask.layer.empty()) at.fail("must be a name; give the masking layer one");
  const int masking = find_layer(before, mask.layer);
  if (masking < 0) at.fail("no layer before this one has the name " + quote_text(mask.layer) + "; name one");
  if (use_of(before[static_cast<std::size_t>(masking)]) == nullptr) {
    at.fail(quote_text(mask.layer) + " has no height of its own; name a layer of noise");
  }
}

bool displaces(const Layer& layer) {
  const LayerUse* use = use_of(layer);
  return use != nullptr && use->combination.kind == Combine::kWarp;
}

}  // namespace

void check_use(const Recipe& recipe, std::size_t index, const Place& place) {
  const Layer& layer = recipe.layers[index];
  const std::span<const Layer> before = std::span(recipe.layers).first(index);
  std::visit(
      [&](const auto& l) {
        if (l.seed) expect_integer(*l.seed, place.field("seed"), 0, kMaxLayerSeed);
      },
      layer);
  if (const LayerUse* use = use_of(layer)) {
    if (use->locality) check(*use->locality, recipe.body, place.field("locality"));
    if (use->mask) check(*use->mask, before, place.field("mask"));
    const Place combine = place.field("combine");
    expect_not_negative(use->combination.width, combine.field("width"));
    expect_vector(use->combination.direction, combine.field("direction"));
  }
  if (std::holds_alternative<GaborLayer>(layer) && std::any_of(before.begin(), before.end(), displaces)) {
    place.fail("a gabor layer is bound to the surface and cannot be warped; move it before the warp");
  }
}

int find_layer(std::span<const Layer> layers, const std::string& name) {
  for (int i = static_cast<int>(layers.size()) - 1; i >= 0; --i) {
    if (has_name(layers[static_cast<std::size_t>(i)], name)) return i;
  }
  return -1;
}

}  // namespace astrolith
