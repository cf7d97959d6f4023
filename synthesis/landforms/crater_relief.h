// The craters of a layer: their places on a body, and the elevations after them at one point, over many
// points and as bounds over boxes.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "numerics/arrays.h"
#include "numerics/box_tree.h"
#include "numerics/interval.h"
#include "recipe/recipe.h"
#include "synthesis/landforms/bare_surface.h"
#include "synthesis/landforms/crater_bounds.h"
#include "synthesis/landforms/crater_profile.h"
#include "synthesis/landforms/population.h"
#include "synthesis/noise/noise_traits.h"

namespace astrolith {

// A crater as it lies on a body; lengths in the recipe's unit.
struct PlacedCrater {
  Vec3d position;  // on the bare surface
  double diameter = 0.0;
  double depth = 0.0;       // below the surroundings
  double rim_height = 0.0;  // above the surroundings
  double age = 0.0;
  bool complex = false;
};

struct LayerCraters {
  int layer = 0;  // number in the recipe
  std::vector<PlacedCrater> craters;
};

// The layer's listed craters and its drawn ones, from the oldest to the youngest. Throws InputError, naming
// `where` in the recipe, for a crater that has no place on the body or is wider than it, and for craters that
// would cover every place more than 2000 times. The result is empty for a body without a surface. `places`
// says where drawn craters may lie.
std::vector<PlacedCrater> place_craters(const CraterLayer& layer, const BareSurface& surface,
                                        std::uint64_t seed, int layer_index, const std::string& where,
                                        const DrawingPlaces& places = {});

// A bound of |elevation| after the layer's craters, over that before, if no crater is larger than its
// greatest listed or drawn diameter; length units.
double rise_of(const CraterLayer& layer);

// The craters of a layer, oldest first, with the constants that their evaluation needs.
struct CraterRelief {
  static constexpr NoiseTraits kTraits{.on_surface = true,
                                       .lifts = false,
                                       .has_heights = false,
                                       .bounded_by_box = true,
                                       .local_form = false,
                                       .lists = NoiseLists::kCraters};

  ArrayRange<CraterKernel> craters;
  // Bound of |elevation| after the layer, length units. Where many craters overlap, elevations are cut at the
  // bound before the layer plus twice the greatest depth or height of one crater.
  double elevation_bound = 0.0;
  std::uint32_t list = 0;  // number of the layer's list of craters in a block (field_tables.h)
};

// The relief of placed craters. `centers` are their centres on the bare surface as the relief is evaluated:
// on the metaballs' side of the body's warp. `elevations` are the elevations at the centres before the layer,
// in length units, with |elevation| <= bound_before. All three spans have one size.
CraterRelief make_crater_relief(const CraterLayer& layer, std::span<const PlacedCrater> oldest_first,
                                std::span<const Vec3d> centers, std::span<const float> elevations,
                                double bound_before, ArrayStore& arrays);

// A tree of the boxes that the craters reach, in their order.
BoxTree crater_tree(std::span<const CraterKernel> craters);

// The elevation at a point p of the bare surface after the craters with the given numbers, which ascend. They
// must include all craters that reach p.
ASTROLITH_HD inline float cratered_elevation(const CraterRelief& relief, const ArrayView& arrays,
                                             const std::uint32_t* numbers, std::uint32_t count,
                                             const Vec3f& p, float elevation) {
  const CraterKernel* craters = arrays[relief.craters];
  for (std::uint32_t k = 0; k < count; ++k) {
    const CraterKernel& crater = craters[numbers[k]];
    elevation = cratered(crater, crater_distance_squared(crater, p.x, p.y, p.z), elevation);
  }
  const float clip = static_cast<float>(relief.elevation_bound);
  return math::clamp(elevation, -clip, clip);
}

// Replaces elevation[i] at n points of the bare surface by the elevation after the layer: the vectorised
// cratered_elevation, with its bits. `tree` is the crater_tree() of the craters.
void apply_craters(const CraterRelief& relief, const ArrayView& arrays, const BoxTree& tree, int n,
                   const float* x, const float* y, const float* z, float* elevation);

// Bounds of the elevations after the layer over a box, from bounds of the elevations before it.
// `for_each_reaching(visit)` calls visit(number) for every crater that reaches the box, in ascending order.
template <class ForEachReaching>
ASTROLITH_HD Interval bound_cratered_elevation(const CraterRelief& relief, const ArrayView& arrays,
                                               const ForEachReaching& for_each_reaching, const Box& box,
                                               Interval elevation) {
  const CraterKernel* craters = arrays[relief.craters];
  for_each_reaching(
      [&](std::uint32_t number) { elevation = bound_cratered(craters[number], box, elevation); });
  const double most = relief.elevation_bound;
  return {clamped(elevation.low, -most, most), clamped(elevation.high, -most, most)};
}

}  // namespace astrolith
