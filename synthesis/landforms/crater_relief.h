// The craters of a layer, placed on a body and ready for evaluation over many points.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "numerics/box_tree.h"
#include "numerics/interval.h"
#include "recipe/recipe.h"
#include "synthesis/landforms/bare_surface.h"
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

class CraterRelief {
 public:
  // `centers` are the craters' places among the points that heights are taken at, `elevations` what layers
  // before made there, never beyond +-`bound_before`.
  CraterRelief(const CraterLayer& layer, std::span<const PlacedCrater> oldest_first,
               std::span<const Vec3d> centers, std::span<const float> elevations, double bound_before);

  // Lets the craters fall on the elevations made by the layers before, at points of the bare surface.
  void apply(int n, const float* x, const float* y, const float* z, float* elevation) const;

  // |elevation| never exceeds this after the layer: relief is cut where craters pile up beyond twice the
  // greatest depth or height of one.
  double elevation_bound() const { return elevation_bound_; }

  // Elevations after the layer at every point of a box, from those before.
  Interval bound(const Box& box, const Interval& before) const;

  // Oldest first, and the numbers of those that reach a box, ascending.
  const std::vector<CraterKernel>& kernels() const { return craters_; }
  std::vector<std::uint32_t> reaching(const Box& box) const { return tree_.touching(box); }

 private:
  void find_bases(std::span<const PlacedCrater> craters, std::span<const float> elevations);

  std::vector<CraterKernel> craters_;  // oldest first
  BoxTree tree_;                       // of what they reach
  double elevation_bound_ = 0.0;
};

}  // namespace astrolith
