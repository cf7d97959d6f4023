// The boulders of a recipe, placed on the surface that its other layers make and joined to it.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "numerics/box_tree.h"
#include "recipe/recipe.h"
#include "synthesis/landforms/bare_surface.h"
#include "synthesis/landforms/boulder_shape.h"

namespace astrolith {

// A boulder as it lies on a body; lengths in the recipe's unit, angles in degrees.
struct PlacedBoulder {
  Vec3d center;
  Vec3d directions[3];  // unit, of the axes
  Vec3d axes;           // full lengths
  double heading = 0.0, tilt = 0.0, burial = 0.0;
  std::uint32_t noise_seed = 0;
};

struct LayerBoulders {
  int layer = 0;  // number in the recipe
  std::vector<PlacedBoulder> boulders;
};

// F of the surface without boulders, and how far that lies from the bare surface at most.
struct Terrain {
  std::function<double(const Vec3d&)> field;
  double height_bound = 0.0;
};

// The layer's listed boulders and its drawn ones. Throws InputError, naming `where` in the recipe, for a
// boulder that is nowhere on the body or longer than it.
std::vector<PlacedBoulder> place_boulders(const BoulderLayer& layer, const BareSurface& surface,
                                          const Terrain& terrain, std::uint64_t seed, int layer_index,
                                          const std::string& where);

class BoulderField {
 public:
  void add(const BoulderLayer& layer, std::span<const PlacedBoulder> boulders);
  // Call it once all are there.
  void finish();

  bool empty() const { return boulders_.empty(); }
  // Of what boulders reach.
  const Box& bounds() const { return tree_.bounds(); }
  bool touches(const Box& box) const { return tree_.any_touching(box); }

  // In the order in which they join, and the box that each reaches.
  const std::vector<BoulderKernel>& kernels() const { return boulders_; }
  const std::vector<Box>& boxes() const { return boxes_; }
  std::vector<std::uint32_t> reaching(const Box& box) const { return tree_.touching(box); }

  // Numbers of the boulders that may change F at the points.
  std::vector<std::uint32_t> near(int n, const float* x, const float* y, const float* z) const;
  // Whether one of them may change it at this point.
  bool reach(std::span<const std::uint32_t> boulders, float x, float y, float z) const;
  // F of the union. Elsewhere the boulders change nothing.
  void join(std::span<const std::uint32_t> boulders, int n, const float* x, const float* y, const float* z,
            float* field) const;

 private:
  std::vector<BoulderKernel> boulders_;
  std::vector<Box> boxes_;  // that each reaches
  BoxTree tree_;
};

}  // namespace astrolith
