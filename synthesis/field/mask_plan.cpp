#include "synthesis/field/mask_plan.h"

#include <algorithm>
#include <map>
#include <string>

namespace astrolith {

MaskPlan plan_masks(std::span<const Layer> layers) {
  MaskPlan plan{std::vector<int>(layers.size(), -1), std::vector<int>(layers.size(), -1)};
  std::map<std::string, int> latest;  // the last layer so far of each name
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const LayerMask* mask = find_mask(layers[i]);
    const auto masking = mask != nullptr ? latest.find(mask->layer) : latest.end();
    if (masking != latest.end()) {
      plan.masking[i] = masking->second;
      const bool reads_kept_heights = find_use(layers[i]) != nullptr;
      if (reads_kept_heights) plan.last_use[static_cast<std::size_t>(masking->second)] = static_cast<int>(i);
    }
    const std::string& name =
        std::visit([](const auto& layer) -> const std::string& { return layer.name; }, layers[i]);
    if (!name.empty()) latest[name] = static_cast<int>(i);
  }
  return plan;
}

int MaskSlots::take(int index, int last_use) {
  const auto free = std::find_if(last_use_.begin(), last_use_.end(), [&](int last) { return last < index; });
  if (free == last_use_.end()) {
    last_use_.push_back(last_use);
    return count() - 1;
  }
  *free = last_use;
  return static_cast<int>(free - last_use_.begin());
}

}  // namespace astrolith
