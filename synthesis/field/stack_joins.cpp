#include <cmath>

#include "numerics/errors.h"
#include "synthesis/field/layer_stack_internal.h"

namespace astrolith {

StackJoins::StackJoins(StackState& stack) : stack_(stack), domain_(stack.supports) {
  const BodyLeaf& first = stack.model.tables.leaf(0);
  if (stack.model.body.plain() && first.warped) domain_ = widened(domain_, first.warp.bound);
}

LayerJoin StackJoins::join(const LayerUse& use, double height, bool has_height) {
  LayerJoin join;
  join.how = use.combination;
  if (!has_height) join.how.kind = Combine::kMask;
  join.height_bound = height;
  join.displaced = displaced_;
  if (use.locality) {
    join.local = true;
    join.locality =
        make_local_weight(*use.locality, *stack_.recipe.body, stack_.place(), stack_.model.arrays);
  }
  if (use.mask) set_mask(*use.mask, join);
  if (has_height) keep_heights(join);
  bound_change(join);
  if (join.how.kind == Combine::kWarp) displace_later(join.how.direction, height);
  return join;
}

void StackJoins::set_mask(const LayerMask& mask, LayerJoin& join) const {
  const auto slot = slots_.find(stack_.masking());
  if (slot == slots_.end()) fail_without_height(mask, stack_.place());
  join.mask = slot->second;
  set_mask_range(mask, join);
}

// Finds a slot for the heights if later layers of noise read them.
void StackJoins::keep_heights(LayerJoin& join) {
  const int last_use = stack_.masks.last_use[static_cast<std::size_t>(stack_.index)];
  if (last_use < 0) return;
  slots_[stack_.index] = join.keeps = mask_slots_.take(stack_.index, last_use);
  stack_.model.num_kept_heights = static_cast<std::uint32_t>(mask_slots_.count());
}

void StackJoins::bound_change(LayerJoin& join) {
  double& bound = stack_.model.height_bound;
  const double before = bound;
  bound = elevation_bound(join.how, before, join.height_bound);
  if (!join.changes_elevation()) return;
  join.change_bound = join.how.kind == Combine::kAdd ? join.height_bound : before + bound;
}

// Widens the domain of the later layers, whose coordinates a warp displaces by up to |direction| * height.
void StackJoins::displace_later(const Vec3d& direction, double height) {
  const Vec3d d{std::fabs(direction.x) * height, std::fabs(direction.y) * height,
                std::fabs(direction.z) * height};
  displaced_ += d;
  domain_.min -= d;
  domain_.max += d;
}

void set_mask_range(const LayerMask& mask, LayerJoin& join) {
  join.mask_from = static_cast<float>(mask.from);
  join.mask_to = static_cast<float>(mask.to);
  join.mask_inverse_range = 1.0f / (join.mask_to - join.mask_from);
}

void fail_without_height(const LayerMask& mask, const std::string& place) {
  throw InputError(place + ".mask.layer: \"" + mask.layer +
                   "\" has no height; give that layer one, or name another");
}

}  // namespace astrolith
