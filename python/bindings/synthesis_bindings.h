// What declares the functions of the module _synthesis.
#pragma once

#include <nanobind/nanobind.h>

namespace astrolith::python {

void bind_field(nanobind::module_& module);        // the field of a recipe at many points
void bind_gravity(nanobind::module_& module);      // of meshes and of the bodies of recipes
void bind_height_maps(nanobind::module_& module);  // patches as heights over their mean plane
void bind_meshes(nanobind::module_& module);       // of recipes and of files
void bind_scene(nanobind::module_& module);        // bodies that stay, their pictures and ranges
void bind_synth(nanobind::module_& module);        // the job of the program

}  // namespace astrolith::python
