// Lists of fields that every noise layer can have, and rules for layers that refer to other layers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "recipe/fields_internal.h"

namespace astrolith {
namespace {

constexpr bool kIntersections[] = {false, true};
std::string_view blend_word(bool intersection) { return intersection ? "intersection" : "union"; }

bool has_name(const Layer& layer, const std::string& name) {
  return std::visit([&](const auto& l) { return l.name == name; }, layer);
}

bool displaces(const Layer& layer) {
  const LayerUse* use = find_use(layer);
  return use != nullptr && use->combination.kind == Combine::kWarp;
}

void check_border(const LayerMask& mask, const Place& place) {
  const double apart = std::fabs(mask.to - mask.from);
  if (apart < kMinPositive || apart < 1e-6 * std::max(std::fabs(mask.from), std::fabs(mask.to))) {
    place.field("to").fail("is too near to `from` for a border; move one of them");
  }
}

// A recipe without a body is laid on a body later, which must then have the group.
void check_group(const Locality& locality, const std::optional<MetaballBody>& body, const Place& place) {
  if (!body || body->find_group(locality.group) != nullptr) return;
  place.field("group").fail("the body has no group " + quote_text(locality.group) +
                            "; name one of body.groups");
}

void check_masking_layer(const LayerMask& mask, std::span<const Layer> before, const Place& place) {
  const Place at = place.field("layer");
  if (mask.layer.empty()) at.fail("must be a name; give the masking layer one");
  const int masking = find_layer(before, mask.layer);
  if (masking < 0) at.fail("no layer before this one has the name " + quote_text(mask.layer) + "; name one");
  if (find_use(before[static_cast<std::size_t>(masking)]) == nullptr) {
    at.fail(quote_text(mask.layer) + " has no height of its own; name a layer of noise");
  }
}

void check_layer_use(const Recipe& recipe, std::size_t index, const Place& place) {
  const Layer& layer = recipe.layers[index];
  const std::span<const Layer> before = std::span(recipe.layers).first(index);
  if (const LayerUse* use = find_use(layer)) {
    if (use->locality) check_group(*use->locality, recipe.body, place.field("locality"));
    if (use->mask) {
      check_masking_layer(*use->mask, before, place.field("mask"));
      if (use->mask->over) place.field("mask").field("over").fail("only a population has it; leave it out");
    }
  }
  if (const Population* drawn = find_population(layer)) {
    const Place at = place.field("population");
    if (drawn->locality) check_group(*drawn->locality, recipe.body, at.field("locality"));
    if (drawn->mask) check_masking_layer(*drawn->mask, before, at.field("mask"));
  }
  const LayerTraits traits = layer_traits(layer);
  if (traits.is_noise && traits.on_surface && std::any_of(before.begin(), before.end(), displaces)) {
    const std::string_view word = type_word(layer);
    const bool has_vowel = std::string_view("aeiou").find(word.front()) != std::string_view::npos;
    place.fail(
        fmt::format("{} {} layer is bound to the surface and cannot be warped; move it before the warp",
                    has_vowel ? "an" : "a", word));
  }
}

}  // namespace

void visit_fields(FieldVisitor& v, Locality& locality) {
  v.required("group", locality.group);
  v.required("width", locality.width, kPositive);
}

void visit_fields(FieldVisitor& v, LayerMask& mask) {
  v.required("layer", mask.layer);
  v.required("from", mask.from, kAnyNumber);
  v.required("to", mask.to, kAnyNumber);
  v.field("over", mask.over, kPositive);
  v.rule(check_border, mask);
}

void visit_fields(FieldVisitor& v, Combination& combination) {
  v.required_word("type", combination.kind, kCombines, combine_word);
  if (combination.kind == Combine::kBlend) {
    v.word("operator", combination.intersection, kIntersections, blend_word);
    v.field("width", combination.width, kNotNegative);
  } else if (combination.kind == Combine::kWarp) {
    v.required("direction", combination.direction, kAnyNumber);
  }
}

void visit_fields(FieldVisitor& v, LayerUse& use) {
  v.field("locality", use.locality);
  v.field("mask", use.mask);
  v.field_if(use.combination.kind != Combine::kAdd, "combine", use.combination);
  v.field("albedo", use.albedo);
}

void check_layer_uses(const Recipe& recipe, const Place& place) {
  const Place layers = place.field("layers");
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) check_layer_use(recipe, i, layers.element(i));
}

std::string_view height_field(const Layer& layer) {
  const StatedHeight field = std::visit(
      [](const auto& l) -> StatedHeight {
        if constexpr (requires { l.stated_height(); }) {
          return l.stated_height();
        } else if constexpr (requires { l.amplitude; }) {
          return {"amplitude", l.amplitude};
        } else {
          return {"height_rms", l.height_rms};
        }
      },
      layer);
  const LayerUse* use = find_use(layer);
  const bool is_blend = use != nullptr && use->combination.kind == Combine::kBlend;
  return is_blend && use->combination.width > std::fabs(field.height) ? "combine.width" : field.name;
}

int find_layer(std::span<const Layer> layers, const std::string& name) {
  for (int i = static_cast<int>(layers.size()) - 1; i >= 0; --i) {
    if (has_name(layers[static_cast<std::size_t>(i)], name)) return i;
  }
  return -1;
}

}  // namespace astrolith
