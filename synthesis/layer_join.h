// How a layer's heights join the elevation that the layers before it made (recipe's Combination), and with
// what weight (Locality and LayerMask).
#pragma once

#include <optional>

#include "recipe/recipe.h"
#include "synthesis/local_weight.h"
#include "synthesis/noise_octaves.h"

namespace astrolith {

// Where a layer counts, by the heights of another, as they were there.
struct HeightMask {
  int slot = 0;  // where the other's heights are kept
  float from = 0.0f, to = 1.0f;

  // weight[i] *= t^2 (3 - 2t), which lies in [0, 1].
  void multiply(int n, const float* height, float* weight) const;
  // The weight for all heights of an interval.
  Interval bound(const Interval& heights) const;
};

struct LayerJoin {
  Combination how;
  std::optional<LocalWeight> locality;
  std::optional<HeightMask> mask;
  int keeps = -1;             // the slot where its own heights are kept for masks; -1: they are not
  Vec3d displaced;            // its coordinates are at most so far from the points, by axis
  double change_bound = 0.0;  // of what it makes of an elevation
  double height_bound = 0.0;  // of its heights, times what they weigh

  bool changes_elevation() const { return how.kind != Combine::kWarp && how.kind != Combine::kMask; }
};

// The most |elevation| after a layer whose heights are at most `height`, where it was at most `before`.
double elevation_bound(const Combination& how, double before, double height);

// elevation[i] becomes what the layer makes of it; `weight` is null where it counts fully everywhere.
// `height` is used up. Expects a layer that changes elevations.
void join_elevation(const Combination& how, int n, const float* weight, float* height, float* elevation);

// The same for intervals.
Interval joined(const Combination& how, const Interval& weight, const Interval& before,
                const Interval& height);

}  // namespace astrolith
