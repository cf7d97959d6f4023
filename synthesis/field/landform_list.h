// Writes a list of the craters and boulders of a body: the ground truth of a synthesised surface.
#pragma once

#include <filesystem>
#include <optional>

#include "synthesis/field/implicit_field.h"

namespace astrolith {

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
//   resolved                    1 or true where the mesh shows the landform, as is_resolved() says; others
//                               are in no map of instances
// A .json file holds {"length_unit", "frame", "origin" of the mesh in the recipe's frame, "features":
// [objects]}. Any other file is CSV with a header. The file is whole or absent; throws what OutputFile
// throws.
void write_landform_list(const ImplicitField& field, const Recipe& recipe,
                         const std::optional<PatchCube>& patch, double cell,
                         const std::filesystem::path& file);

}  // namespace astrolith
