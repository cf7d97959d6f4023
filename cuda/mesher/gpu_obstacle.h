// What keeps a field from being meshed on a GPU.
#pragma once

#include <string>

#include "synthesis/field/field_tables.h"

namespace astrolith {

// The obstacle for blocks with sides so long (length units), in a few words ("masks by ..."); empty where
// there is none.
std::string obstacle_on_gpu(const FieldView& field, double block_side);

}  // namespace astrolith
