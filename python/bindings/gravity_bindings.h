// The gravity of meshes and of the bodies of recipes.
#pragma once

#include <nanobind/nanobind.h>

namespace astrolith::python {

void bind_gravity(nanobind::module_& module);

}  // namespace astrolith::python
