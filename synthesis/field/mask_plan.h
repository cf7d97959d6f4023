// Which layers of a recipe mask later ones, and how long their heights must be kept for that.
#pragma once

#include <span>
#include <vector>

#include "recipe/recipe.h"

namespace astrolith {

struct MaskPlan {
  std::vector<int> masking;  // (layers) the layer whose heights mask layer i; -1: none
  // (layers) the last layer of noise that layer i masks; -1: it masks none. Populations of landforms evaluate
  // the masking layer by themselves.
  std::vector<int> last_use;
};

// A mask names the last layer of its name before its own.
MaskPlan plan_masks(std::span<const Layer> layers);

// The slots in which heights are kept. A slot is free again after the last layer that reads it, so that there
// are as many as masks overlap.
class MaskSlots {
 public:
  // A slot for the heights of layer `index`, which must be kept up to layer `last_use`. Calls come in the
  // order of the layers.
  int take(int index, int last_use);
  int count() const { return static_cast<int>(last_use_.size()); }

 private:
  std::vector<int> last_use_;  // (slots) the last layer that reads the slot
};

}  // namespace astrolith
