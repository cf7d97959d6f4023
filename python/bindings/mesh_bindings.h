// Meshes of recipes, and mesh files.
#pragma once

#include <nanobind/nanobind.h>

namespace astrolith::python {

void bind_meshes(nanobind::module_& module);

}  // namespace astrolith::python
