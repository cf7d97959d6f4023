// What evening did to the triangles of synth's mesh, in the summary and on stderr.
#pragma once

#include <string>

#include "apps/program.h"
#include "synthesis/mesh/even_mesh.h"

namespace astrolith {

// `unit` is the recipe's length unit.
void report_even(Program& program, const EvenStatistics& done, const std::string& unit);

}  // namespace astrolith
