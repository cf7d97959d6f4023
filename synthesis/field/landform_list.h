// The list of what stands on a body one by one, for whoever needs the truth about a synthesised surface.
#pragma once

#include <filesystem>
#include <string>

#include "synthesis/field/implicit_field.h"

namespace astrolith {

// One row a crater, in the order in which they fell, then one a boulder: layer (number in the recipe, from
// 0), kind ("simple crater", "complex crater" or "boulder"), x, y, z (a crater's centre on the bare surface,
// a boulder's own centre), diameter (a boulder's axis a); depth, rim_height and age of craters; axis_b,
// axis_c, heading, tilt and burial of boulders. Lengths are in the recipe's unit, angles in degrees. .json
// holds
// {"length_unit", "features": [objects]}, anything else is CSV with a header.
void write_landform_list(const ImplicitField& field, const std::string& length_unit,
                         const std::filesystem::path& file);

}  // namespace astrolith
