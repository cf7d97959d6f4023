// The craters of a layer: placed on a body, and what they make of elevations at one point, over many points,
// and over boxes.
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
// `where` in the recipe, for a crater that is nowhere on the body or wider than it.
std::vector<PlacedCrater> place_craters(const CraterLayer& layer, const BareSurface& surface,
                                        std::uint64_t seed, int layer_index, const std::string& where);

// The craters of a layer, oldest first, as they fall on the elevations that the layers before them made.
struct CraterRelief {
  ArrayRange<CraterKernel> craters;
  // |elevation| never exceeds this after the layer, length units: relief is cut where craters pile up beyond
  // twice the greatest depth or height of one.
  double elevation_bound = 0.0;
  std::uint32_t list = 0;  // number of the list of craters that reach a block
};

// `centers` are the craters' places among the points that heights are taken at, `elevations` what the layers
// before made there, never beyond +-`bound_before`.
CraterRelief make_crater_relief(const CraterLayer& layer, std::span<const PlacedCrater> oldest_first,
                                std::span<const Vec3d> centers, std::span<const float> elevations,
                                double bound_before, ArrayStore& arrays);

// The boxes that craters reach, as a tree that finds those of a box.
BoxTree crater_tree(std::span<const CraterKernel> craters);

// The elevation at a point of the bare surface after the craters of a list of numbers, ascending.
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

// Lets the craters fall on elevations at points of the bare surface: the bits of cratered_elevation,
// vectorised.
void apply_craters(const CraterRelief& relief, const ArrayView& arrays, const BoxTree& tree, int n,
                   const float* x, const float* y, const float* z, float* elevation);

// Elevations after the layer at every point of a box, from those before. `for_each_reaching(visit)` calls
// visit(number) for every crater that reaches the box, ascending.
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
