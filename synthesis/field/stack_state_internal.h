// A recipe's layers while they are added to a field model, as all parts of the work see them.
#pragma once

#include <map>
#include <string>

#include "recipe/recipe.h"
#include "synthesis/body/layer_site.h"
#include "synthesis/field/field_model_internal.h"
#include "synthesis/field/mask_plan.h"

namespace astrolith {

struct StackState {
  const Recipe& recipe;
  const std::string& name;  // name of the recipe, for errors
  FieldModel& model;
  MaskPlan masks;
  Box supports;                             // of the body's kernels; no surface lies outside
  int index = 0;                            // place in the recipe of the layer that is added
  std::map<int, std::size_t> numbers = {};  // number in the model of each layer with heights, by its place

  StackState(const Recipe& of_layers, const std::string& recipe_name, FieldModel& of_body);

  const Layer& layer() const { return recipe.layers[static_cast<std::size_t>(index)]; }
  int masking() const { return masks.masking[static_cast<std::size_t>(index)]; }
  std::string place() const { return place_of(index); }
  std::string place_of(int layer) const { return name + ": layers[" + std::to_string(layer) + "]"; }

  // A layer's site in a frame, with the first `below` layers of the model below it. It is valid until the
  // model changes.
  LayerSite site(const NoiseFrame& frame, std::size_t below) const;

  // Finds for each layer by how much it and all layers after it may change an elevation, and updates the
  // model's tables.
  void update_model();

  void report_left_out(int layer, const NoiseDetail& detail);
};

}  // namespace astrolith
