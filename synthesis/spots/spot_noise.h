// A spot layer of the recipe (thesis eq. 5.3 to 5.6): its heights at one point, over many points, and over
// boxes.
//
// Impulses are hashes of their cells: whoever needs some points' heights draws the impulses whose spots reach
// them, in the order of cells, and a spot adds exactly nothing beyond its support. The bits of a height do
// not depend on what else was drawn.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "numerics/arrays.h"
#include "numerics/interval.h"
#include "recipe/recipe.h"
#include "synthesis/spots/spot_bounds.h"
#include "synthesis/spots/spot_kernel.h"
#include "synthesis/spots/spot_lattice.h"

namespace astrolith {

struct SpotNoise {
  Vec3f low, high;  // points outside are moved to the border
  ArrayRange<SpotKind> kinds;
  ArrayRange<std::uint32_t> thresholds;  // the kinds' lattices point into them
  double height_bound = 0.0;             // |n(p)| never exceeds it, length units
};

// `layer_index` is the layer's number in the recipe: layers of one seed are independent. Points outside
// `domain`, where no surface is, are moved to its border. Sizes so fine that float coordinates within it
// could not tell neighbouring cells apart (above 2^20 cells from the origin) are left out.
SpotNoise make_noise(const SpotLayer& layer, std::uint64_t seed, int layer_index, const Box& domain,
                     ArrayStore& arrays);

// Drawn impulses, by kind.
using SpotImpulses = std::vector<std::vector<SpotImpulse>>;

// The impulses that reach a box, chosen from those of a larger box where these are given; null where there
// are too many to be drawn at once.
std::shared_ptr<const SpotImpulses> gather_spots(const SpotNoise& noise, const ArrayView& arrays,
                                                 const Box& box, const SpotImpulses* larger_box_impulses);

// The impulses of one kind whose spots may reach the box, in the order of their cells (z, then y, then x).
std::vector<SpotImpulse> draw_spots(const SpotKind& kind, const std::uint32_t* thresholds, const Box& box);

// The cells that impulses are drawn from, for a box with sides so long.
double cells_of(const SpotNoise& noise, const ArrayView& arrays, double side);

// n(p), length units, from lists of the impulses that reach p: kind k has impulses[first[k]] to
// impulses[first[k + 1]
// - 1].
ASTROLITH_HD inline float height_at(const SpotNoise& n, const ArrayView& arrays, const SpotImpulse* impulses,
                                    const std::uint32_t* first, const Vec3f& at) {
  const Vec3f p = moved_into(at, n.low, n.high);
  const SpotKind* kinds = arrays[n.kinds];
  float height = 0.0f;
  for (std::uint32_t k = 0; k < n.kinds.count; ++k) {
    float sum = 0.0f;
    for (std::uint32_t j = first[k]; j < first[k + 1]; ++j) {
      sum += spot_height(kinds[k].kernel, impulses[j], p.x, p.y, p.z);
    }
    height += math::clamp(sum, -kinds[k].clip, kinds[k].clip);
  }
  return height;
}

// height[i] = n(p_i). `impulses`, unless null, must hold all that reach the points.
void evaluate_heights(const SpotNoise& n, const ArrayView& arrays, int count, const float* x, const float* y,
                      const float* z, float* height, const SpotImpulses* impulses = nullptr);

// n(p) at every float point of a box.
ASTROLITH_HD inline Interval bound_heights(const SpotNoise& n, const ArrayView& arrays, const Box& box) {
  const Box moved = moved_into(box, n.low, n.high);
  const double slack = 3.0 * kSpotSlack * n.height_bound;
  Interval sum{-slack, slack};
  for (std::uint32_t k = 0; k < n.kinds.count; ++k) {
    sum = plus(sum, bound_drawn_spots(arrays[n.kinds][k], arrays[n.thresholds], moved));
  }
  return sum;
}
// Finds the same bound from `impulses` that hold all spots which reach the box, and draws where they are
// null.
Interval bound_heights(const SpotNoise& n, const ArrayView& arrays, const Box& box,
                       const SpotImpulses* impulses);

}  // namespace astrolith
