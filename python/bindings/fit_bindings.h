// The fits of shapes and photos in the module astrolith._estimation.
#pragma once

#include <nanobind/nanobind.h>

namespace astrolith::python {

void declare_fits(nanobind::module_& module);

}  // namespace astrolith::python
