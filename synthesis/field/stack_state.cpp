#include <algorithm>

#include "synthesis/field/bare_body.h"
#include "synthesis/field/layers_below_internal.h"
#include "synthesis/field/stack_state_internal.h"

namespace astrolith {

StackState::StackState(const Recipe& of_layers, const std::string& recipe_name, FieldModel& of_body)
    : recipe(of_layers),
      name(recipe_name),
      model(of_body),
      masks(plan_masks(of_layers.layers)),
      supports(of_body.body.supports) {}

LayerSite StackState::site(const NoiseFrame& frame, std::size_t below) const {
  model.update();
  const Vec3d e = supports.extent();
  return {frame,
          model.body,
          model.arrays,
          model.metaballs.lists(),
          std::max({e.x, e.y, e.z}),
          field_below(model, below, frame),
          model.height_bound,
          [&of_layers = recipe] { return bare_body(of_layers).bounds; }};
}

void StackState::update_model() {
  double bound = 0.0;
  for (std::size_t i = model.layers.size(); i-- > 0;) {
    bound += model.layers[i].join.change_bound;
    model.layers[i].join.remaining_change = static_cast<float>(bound * (1.0 + 1e-5));
  }
  model.update();
}

void StackState::report_left_out(int layer, const NoiseDetail& detail) {
  if (detail.left_out > 0.0) model.left_out.push_back({layer, detail.left_out, detail.finest});
}

}  // namespace astrolith
