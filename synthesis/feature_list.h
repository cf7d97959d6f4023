// The list of what stands on a body one by one, for whoever needs the truth about a synthesised surface.
#pragma once

#include <filesystem>
#include <string>

#include "synthesis/implicit_field.h"

namespace astrolith {

// One row a crater, in the order in which they fell: layer (number in the recipe), kind ("simple crater" or
// "complex crater"), x, y, z (centre on the bare surface), diameter, depth, rim_height and age. Lengths are
// in the recipe's unit. .json holds {"length_unit", "features": [objects]}, anything else is CSV with a
// header.
void write_feature_list(const ImplicitField& field, const std::string& length_unit,
                        const std::filesystem::path& file);

}  // namespace astrolith
