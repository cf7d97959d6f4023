// Lists of fields of a recipe's albedos, with their rules.
#include <cmath>

#include "recipe/fields_internal.h"

namespace astrolith {
namespace {

constexpr NumberLimits kNormal = range(1e-3, 1.0), kFactor = range(0.1, 10.0), kColor = range(0.0, 4.0);

void check_elevations(const AlbedoByElevation& by, const Place& place) {
  if (!(std::fabs(by.to - by.from) >= kMinPositive))
    place.field("to").fail("is too near to `from` for a border; move one of them");
}

const LayerAlbedo* noise_albedo(const Layer& layer) {
  const LayerUse* const use = find_use(layer);
  return use != nullptr && use->albedo ? &*use->albedo : nullptr;
}

}  // namespace

void visit_fields(FieldVisitor& v, AlbedoByElevation& by) {
  v.required("from", by.from, kAnyNumber);
  v.required("to", by.to, kAnyNumber);
  v.required("factor", by.factor, kFactor);
  v.rule(check_elevations, by);
}

void visit_fields(FieldVisitor& v, GroundAlbedo& albedo) {
  v.required("normal", albedo.normal, kNormal);
  v.field("color", albedo.color, kColor);
  v.field("steep", albedo.steep, kFactor);
  v.field("elevation", albedo.elevation);
}

void visit_fields(FieldVisitor& v, LayerAlbedo& albedo) {
  v.field("normal", albedo.normal, kNormal);
  v.field("color", albedo.color, kColor);
  v.field("contrast", albedo.contrast, range(-5.0, 5.0));
}

void visit_fields(FieldVisitor& v, CraterAlbedo& albedo) {
  v.field("fresh", albedo.fresh, kFactor);
  v.field("color", albedo.color, kFactor);
}

void visit_fields(FieldVisitor& v, BoulderAlbedo& albedo) {
  v.required("normal", albedo.normal, kNormal);
  v.field("spread", albedo.spread, range(0.0, 2.0));
  v.field("bright_share", albedo.bright_share, kShare);
  v.field("bright", albedo.bright, kFactor);
  v.field("color", albedo.color, kColor);
}

void check_albedos(const Recipe& recipe, const Place& place) {
  const Place layers = place.field("layers");
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    const LayerAlbedo* const albedo = noise_albedo(recipe.layers[i]);
    if (albedo == nullptr || albedo->contrast == 0.0 || has_height(recipe.layers[i])) continue;
    const Place layer = layers.element(i), at = layer.field("albedo");
    at.field("contrast").fail("needs heights, and the layer has none; give it some, or leave it out");
  }
}

}  // namespace astrolith
