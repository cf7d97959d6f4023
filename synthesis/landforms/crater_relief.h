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
#include "synthesis/body/metaball_box.h"
#include "synthesis/landforms/bare_surface.h"
#include "synthesis/landforms/crater_profile.h"
#include "synthesis/landforms/population.h"
#include "synthesis/noise/noise_traits.h"

namespace astrolith {

inline constexpr double kCraterSlack = 1e-5;  // relative rounding of positions and heights

// A box outside of which a crater changes no elevation.
ASTROLITH_HD inline Box crater_reach(const CraterKernel& c) {
  const double reach =
      std::sqrt(double{c.extent_squared} / double{c.inverse_radius_squared}) * (1.0 + kCraterSlack);
  const Vec3d center{double{c.x}, double{c.y}, double{c.z}};
  const Box box{center, center};
  return widened(box, reach + 1e-6 * largest_coordinate(box));
}

// Bounds of x^2 over a box, with x = distance from the centre / radius.
ASTROLITH_HD inline Interval crater_squares(const CraterKernel& c, const Box& box) {
  const MetaballSphere<float> sphere{{c.x, c.y, c.z}, 0.0f};
  const SquaredDistances range = squared_distances(sphere, box);
  const double scale = double{c.inverse_radius_squared};
  const double rounding = 2e-6 * std::sqrt(scale) * largest_coordinate(box);  // rounding of x
  const double near = std::max(0.0, std::sqrt(range.nearest * scale) * (1.0 - kCraterSlack) - rounding);
  const double far = std::sqrt(range.farthest * scale) * (1.0 + kCraterSlack) + rounding;
  return {near * near, far * far};
}

// Bounds of crater_height(). The cavity rises with x, while rim and peak fall with x.
ASTROLITH_HD inline Interval bound_crater_height(const CraterKernel& c, const Interval& x_squared) {
  const float low = static_cast<float>(x_squared.low), high = static_cast<float>(x_squared.high);
  const float cavity_low = crater_cavity(c, low), cavity_high = crater_cavity(c, high);
  const float rim_low = crater_rim(c, high), rim_high = crater_rim(c, low);
  const double k = double{c.smoothing} / 4.0, floor = -double{c.depth};
  const double pit_low =
      double{math::min(math::min(cavity_low, rim_high), math::min(cavity_high, rim_low))} - k;
  const double pit_high = double{math::min(math::min(cavity_high, rim_high), c.rim_height)};
  const double peak_low = double{crater_peak(c, high)}, peak_high = double{crater_peak(c, low)};
  const double slack = kCraterSlack * (double{c.depth} + double{c.rim_height} + double{c.peak_height});
  const Interval height{std::max(pit_low, floor) + peak_low - slack,
                        std::max(pit_high, floor) + k + peak_high + slack};
  if (high < c.extent_squared) return height;
  return {std::min(height.low, 0.0), std::max(height.high, 0.0)};
}

// Bounds of cratered() over a box, from bounds of the elevations before the crater.
ASTROLITH_HD inline Interval bound_cratered(const CraterKernel& c, const Box& box, const Interval& before) {
  const Interval x_squared = crater_squares(c, box);
  const double least = std::min(x_squared.low, 1.0), most = std::min(x_squared.high, 1.0);
  const double base = double{c.base};
  const Interval height = bound_crater_height(c, x_squared);
  const double slack =
      kCraterSlack * (std::fabs(base) + std::max(std::fabs(before.low), std::fabs(before.high)));
  const auto kept = [&](double elevation, double share) { return base + (elevation - base) * share; };
  return {std::min(kept(before.low, least), kept(before.low, most)) + height.low - slack,
          std::max(kept(before.high, least), kept(before.high, most)) + height.high + slack};
}

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
double largest_rise(const CraterLayer& layer);

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
