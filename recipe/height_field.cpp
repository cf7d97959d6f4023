#include "recipe/height_field.h"

#include <cmath>

namespace astrolith {
namespace {

struct HeightField {
  std::string_view name;
  double height;
};

// Most kinds of layers that state a height have one of two fields.
template <class Kind>
HeightField height_field_of(const Kind& layer) {
  if constexpr (requires { layer.amplitude; }) {
    return {"amplitude", layer.amplitude};
  } else {
    return {"height_rms", layer.height_rms};
  }
}
HeightField height_field_of(const ExemplarLayer& layer) {
  return layer.height_range != 0.0 ? HeightField{"height_range", layer.height_range}
                                   : HeightField{"height_rms", layer.height_rms};
}
HeightField height_field_of(const CraterLayer& layer) {
  return {layer.craters.empty() ? "population" : "craters", 0.0};
}
HeightField height_field_of(const BoulderLayer& layer) {
  return {layer.boulders.empty() ? "population" : "boulders", 0.0};
}

}  // namespace

std::string_view height_field(const Layer& layer) {
  const HeightField field = std::visit([](const auto& l) { return height_field_of(l); }, layer);
  const LayerUse* use = use_of(layer);
  const bool is_blend = use != nullptr && use->combination.kind == Combine::kBlend;
  return is_blend && use->combination.width > std::fabs(field.height) ? "combine.width" : field.name;
}

}  // namespace astrolith
