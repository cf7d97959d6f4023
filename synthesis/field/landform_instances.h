// Which crater or boulder a point of the surface shows.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "numerics/box_tree.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/field/listed_landforms.h"
#include "synthesis/landforms/bare_surface.h"

namespace astrolith {

// A point shows a boulder where the rock stands out of the ground there: of several boulders the one whose
// surface is outermost. Elsewhere it shows the last crater within whose rim it lies: its projection onto the
// bare body is nearer to the crater's centre than half the diameter, in a straight line. Craters of a later
// layer come after those of an earlier one. Landforms that the mesh does not resolve are left out: their
// ground shows what is beneath them.
class LandformInstances {
 public:
  // `field` is the recipe's, made for the same patch, and must outlive this object. `cell` is the side of the
  // mesh's cells, length units (is_resolved()).
  LandformInstances(const ImplicitField& field, const Recipe& recipe, const std::optional<PatchCube>& patch,
                    double cell);

  // The row of the feature list that a point shows, from 0 after its header (landform_list.h); -1 for none.
  // The point lies on the surface, in the recipe's frame. `ground` is F without boulders there, length units.
  // It may be called from many threads.
  std::int32_t row_at(const Vec3d& p, float ground) const;

 private:
  struct Rock {
    std::int32_t row;
    BoulderKernel kernel;
  };
  std::int32_t boulder_at(const Vec3d& p, float ground) const;
  std::int32_t crater_at(const Vec3d& p) const;

  BareBody bare_;
  Vec3d origin_;  // of the coordinates of rocks
  std::vector<ListedLandform> listed_;
  std::vector<Rock> rocks_;         // boulders
  std::vector<std::int32_t> rims_;  // the rows of the craters
  BoxTree rock_tree_, rim_tree_;    // in the order of rocks_ and rims_
};

}  // namespace astrolith
