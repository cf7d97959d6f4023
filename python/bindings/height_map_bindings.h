// Patches as heights over their mean plane.
#pragma once

#include <nanobind/nanobind.h>

namespace astrolith::python {

void bind_height_maps(nanobind::module_& module);

}  // namespace astrolith::python
