#include "recipe/height_field.h"

#include <cmath>

namespace astrolith {
namespace {

template <class Kind>
StatedHeight stated_height_of(const Kind& layer) {
  if constexpr (requires { layer.stated_height(); }) {
    return layer.stated_height();
  } else if constexpr (requires { layer.amplitude; }) {
    return {"amplitude", layer.amplitude};
  } else {
    return {"height_rms", layer.height_rms};
  }
}
StatedHeight stated_height_of(const CraterLayer& layer) {
  return {layer.craters.empty() ? "population" : "craters", 0.0};
}
StatedHeight stated_height_of(const BoulderLayer& layer) {
  return {layer.boulders.empty() ? "population" : "boulders", 0.0};
}

}  // namespace

std::string_view height_field(const Layer& layer) {
  const StatedHeight field = std::visit([](const auto& l) { return stated_height_of(l); }, layer);
  const LayerUse* use = use_of(layer);
  const bool is_blend = use != nullptr && use->combination.kind == Combine::kBlend;
  return is_blend && use->combination.width > std::fabs(field.height) ? "combine.width" : field.name;
}

}  // namespace astrolith
