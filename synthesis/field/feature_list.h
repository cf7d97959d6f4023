// The features of a body: its craters and boulders, one by one. They make the ground truth of a synthesised
// surface: a list of all of them, and which of them a point of the surface shows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "numerics/box_tree.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/landforms/bare_surface.h"
#include "synthesis/landforms/boulder_field.h"
#include "synthesis/landforms/crater_relief.h"

namespace astrolith {

// A crater or a boulder. The other pointer is null. Both point into the field's tables.
struct Feature {
  int layer = 0;  // number in the recipe
  const PlacedCrater* crater = nullptr;
  const PlacedBoulder* boulder = nullptr;
};

// Whether a mesh whose cells have this side, in length units, shows the landform: two cells or more lie
// across the rim of a crater, or across the second axis of a boulder, and the landform rises or sinks by a
// tenth of a cell or more. A crater's floor lies depth + rim_height below its rim; a boulder stands (1 -
// burial) axis_c above the ground, as if it lay flat.
bool is_resolved(const Feature& landform, double cell);

// All craters, in the order in which they fell, and then all boulders. For a patch those whose rim or rock
// reaches into the cube. The result lives as long as the field.
std::vector<Feature> list_features(const ImplicitField& field, const std::optional<PatchCube>& patch);

// `cell` is the side of the mesh's cells, length units. The list has one row for each crater, in the order in
// which craters fell, and then one for each boulder. For a patch it has those whose rim or rock reaches into
// the cube. Lengths are in the recipe's unit, angles in degrees. The columns are:
//   layer                       number of the layer in the recipe, from 0
//   kind                        "simple crater", "complex crater" or "boulder"
//   x, y, z                     a point of the finished surface in the recipe's frame: where the normal of
//                               the bare body through the centre of the crater, or of the boulder, crosses
//                               it; absent where nothing is left there
//   mesh_x, mesh_y, mesh_z      the same point in the frame of the mesh: relative to the centre of a patch
//   center_x, center_y, center_z    in the recipe's frame, a crater's centre on the bare surface, a boulder's
//                               own centre
//   diameter                    the rim's diameter of a crater, axis a of a boulder
//   depth, rim_height, age      craters only
//   axis_b, axis_c, heading, tilt, burial    boulders only
//   length_unit                 the recipe's unit
//   resolved                    1 or true where the mesh shows the landform, as is_resolved() says, and a
//                               boulder's rock stands out of the ground at x, y, z
// A .json file holds {"length_unit", "frame", "origin" of the mesh in the recipe's frame, "features":
// [objects]}. Any other file is CSV with a header. The file is whole or absent; throws what OutputFile
// throws.
void write_feature_list(const ImplicitField& field, const Recipe& recipe,
                        const std::optional<PatchCube>& patch, double cell,
                        const std::filesystem::path& file);

// The crossing of the line from + t direction, |t| <= reach, that lies nearest to t = 0, to reach / 2^18.
// `direction` has unit length, reach > 0 is a length. None where no two of 65 points along the line lie on
// different sides: crossings nearer to each other than reach / 32 can be missed.
std::optional<Vec3d> nearest_crossing(const ImplicitField& field, const Vec3d& from, const Vec3d& direction,
                                      double reach);

// A point shows a boulder where the rock stands out of the ground there: of several boulders the one whose
// surface is outermost. Elsewhere it shows the last crater within whose rim it lies: its projection onto the
// bare body is nearer to the crater's centre than half the diameter, in a straight line. Craters of a later
// layer come after those of an earlier one. Landforms that the mesh does not resolve are left out: their
// ground shows what is beneath them.
class FeatureFinder {
 public:
  // `field` is the recipe's, made for the same patch, and must outlive this object. `cell` is the side of the
  // mesh's cells, length units (is_resolved()).
  FeatureFinder(const ImplicitField& field, const Recipe& recipe, const std::optional<PatchCube>& patch,
                double cell);

  // The row of the feature list that a point shows, from 0 after its header (feature_list.h); -1 for none.
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
  std::vector<Feature> listed_;
  std::vector<Rock> rocks_;         // boulders
  std::vector<std::int32_t> rims_;  // the rows of the craters
  BoxTree rock_tree_, rim_tree_;    // in the order of rocks_ and rims_
};

}  // namespace astrolith
