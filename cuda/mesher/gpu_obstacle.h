// Whether a field can be meshed on a GPU, and if not, why.
#pragma once

#include <string>

#include "synthesis/field/field_tables.h"

namespace astrolith {

// The reason why the field cannot be meshed on a GPU in blocks with sides of `block_side` (length units), in
// a few words ("masks by more than four layers at a time"). Empty if it can.
std::string obstacle_on_gpu(const FieldView& field, double block_side);

}  // namespace astrolith
