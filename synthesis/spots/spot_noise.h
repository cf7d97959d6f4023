// A spot layer of the recipe (thesis eq. 5.3 to 5.6): its heights at one point, over many points, and as
// bounds over boxes.
//
// The impulses of a cell are hashes of the cell. To evaluate points, the impulses whose spots reach them are
// drawn in the order of the cells. A spot contributes exactly 0 beyond its support. The bits of a height
// therefore do not depend on other impulses that were drawn.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "numerics/arrays.h"
#include "numerics/interval.h"
#include "recipe/recipe.h"
#include "synthesis/noise/noise_frame.h"
#include "synthesis/noise/noise_traits.h"
#include "synthesis/spots/spot_bounds.h"
#include "synthesis/spots/spot_draw.h"
#include "synthesis/spots/spot_kernel.h"

namespace astrolith {

struct SpotNoise {
  static constexpr NoiseTraits kTraits{.on_surface = false,
                                       .lifts = false,
                                       .has_heights = true,
                                       .bounded_by_box = true,
                                       .local_form = false,
                                       .lists = NoiseLists::kSpots};

  Vec3f low, high;  // points outside are moved to the border
  ArrayRange<SpotKind> kinds;
  ArrayRange<std::uint32_t> thresholds;  // shared by the lattices of all kinds
  double height_bound = 0.0;             // bound of |n(p)|, length units
  NoiseDetail detail;
};

// `layer_index` is the layer's number in the recipe; layers of one seed are independent. The domain of the
// frame holds the surface; points outside it are moved to its border. Sizes whose lattices reach beyond 2^20
// cells from the frame's origin are left out, since float coordinates could not tell neighbouring cells
// apart.
SpotNoise make_noise(const SpotLayer& layer, std::uint64_t seed, int layer_index, const NoiseFrame& frame,
                     ArrayStore& arrays);

// The drawn impulses of each kind.
using SpotImpulses = std::vector<std::vector<SpotImpulse>>;

// The impulses whose spots reach a box, for each kind. They are chosen from `larger_box_impulses`, which hold
// those of a larger box, or drawn if that is null. Returns null if there are too many to be drawn at once.
std::shared_ptr<const SpotImpulses> gather_spots(const SpotNoise& noise, const ArrayView& arrays,
                                                 const Box& box, const SpotImpulses* larger_box_impulses);

// The impulses of one kind whose spots may reach the box, in the order of their cells (z, then y, then x).
std::vector<SpotImpulse> draw_spots(const SpotKind& kind, const std::uint32_t* thresholds, const Box& box);

// The number of cells that impulses are drawn from for a cubic box; `side` is in length units.
double cells_of(const SpotNoise& noise, const ArrayView& arrays, double side);

// The number of cells and impulses that are drawn on average for a point by itself.
double draws_at_a_point(const SpotNoise& noise, const ArrayView& arrays);

// The height n(p), length units, from lists of the impulses that reach p: kind k has impulses[first[k]] to
// impulses[first[k + 1] - 1].
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

// Writes height[i] = n(p_i), length units. `impulses` must hold all impulses that reach the points, or be
// null.
void evaluate_heights(const SpotNoise& n, const ArrayView& arrays, int count, const float* x, const float* y,
                      const float* z, float* height, const SpotImpulses* impulses = nullptr);

// An interval that holds n(p) for every float point p of a box, length units.
ASTROLITH_HD inline Interval bound_heights(const SpotNoise& n, const ArrayView& arrays, const Box& box) {
  const Box moved = moved_into(box, n.low, n.high);
  const double slack = 3.0 * kSpotSlack * n.height_bound;
  Interval sum{-slack, slack};
  for (std::uint32_t k = 0; k < n.kinds.count; ++k) {
    sum = plus(sum, bound_drawn_spots(arrays[n.kinds][k], arrays[n.thresholds], moved));
  }
  return sum;
}
// Finds this interval from `impulses`, which must hold all impulses whose spots reach the box. If `impulses`
// is null, the impulses are drawn.
Interval bound_heights(const SpotNoise& n, const ArrayView& arrays, const Box& box,
                       const SpotImpulses* impulses);

}  // namespace astrolith
