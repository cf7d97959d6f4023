// How each layer of noise joins the layers before it: masks, localities, warps and bounds of elevations.
#pragma once

#include <map>

#include "synthesis/field/stack_state_internal.h"

namespace astrolith {

class LayerJoins {
 public:
  explicit LayerJoins(StackState& stack);

  // Where the next layer of noise in space is evaluated: the body's supports, widened by the warps of the
  // body and of the layers so far.
  const Box& domain() const { return domain_; }
  // A bound of the displacement of the next layer along each axis, length units.
  const Vec3d& displaced() const { return displaced_; }

  // The join of the layer that the stack adds, whose |height| is at most `height`, length units. Updates the
  // model's bound of elevations, and the domain if the layer warps. `has_height` is false for a layer that
  // only paints. Throws InputError where the layer's mask or locality has no meaning.
  LayerJoin join(const LayerUse& use, double height, bool has_height);

 private:
  void set_mask(const LayerMask& mask, LayerJoin& join) const;
  void keep_heights(LayerJoin& join);
  void bound_change(LayerJoin& join);
  void displace_later(const Vec3d& direction, double height);

  StackState& stack_;
  Box domain_;
  Vec3d displaced_;
  MaskSlots mask_slots_;
  std::map<int, int> slots_;  // slot of the kept heights of each masking layer
};

// Sets the heights over which a mask rises from 0 to 1.
void set_mask_range(const LayerMask& mask, LayerJoin& join);

// Refuses a mask by a layer that only paints; `place` names the layer or the population with the mask.
[[noreturn]] void fail_without_height(const LayerMask& mask, const std::string& place);

}  // namespace astrolith
