// Writes a list of all craters and boulders of a body: the ground truth of a synthesised surface.
#pragma once

#include <filesystem>
#include <string>

#include "synthesis/field/implicit_field.h"

namespace astrolith {

// The list has one row for each crater, in the order in which craters fell, and then one for each boulder.
// Lengths are in the recipe's unit, angles in degrees. The columns are:
//   layer                            number of the layer in the recipe, from 0
//   kind                             "simple crater", "complex crater" or "boulder"
//   x, y, z                          a crater's centre on the bare surface, a boulder's own centre
//   diameter                         the rim's diameter of a crater, axis a of a boulder
//   depth, rim_height, age           craters only
//   axis_b, axis_c, heading, tilt, burial    boulders only
// A .json file holds {"length_unit", "features": [objects]}. Any other file is CSV with a header. The file is
// whole or absent; throws what OutputFile throws.
void write_landform_list(const ImplicitField& field, const std::string& length_unit,
                         const std::filesystem::path& file);

}  // namespace astrolith
