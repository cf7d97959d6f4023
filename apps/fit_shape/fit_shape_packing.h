// fit_shape --packing-only: the body filled with spheres that do not overlap, as a table.
#pragma once

#include "apps/fit_shape/fit_shape_options.h"
#include "apps/program.h"
#include "estimation/shape/target/target_body.h"

namespace astrolith {

void write_packing(Program& program, const FitArguments& arguments, const TargetBody& target);

}  // namespace astrolith
