// The region that synth's options name.
#pragma once

#include <string>
#include <vector>

#include "tasks/synthesis/mesh_region.h"

namespace astrolith {

// Reads a tile such as "3/16", the third of sixteen, or a patch's centre and side; `aligned` turns its cube
// to the ground. Empty arguments stand for
// the whole surface. Throws InputError for anything else.
Region parse_region(const std::string& tile, const std::vector<double>& patch, bool aligned);

}  // namespace astrolith
