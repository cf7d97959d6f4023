// Field: the field of a recipe, evaluated at many points.
#pragma once

#include <nanobind/nanobind.h>

namespace astrolith::python {

void bind_field(nanobind::module_& module);

}  // namespace astrolith::python
