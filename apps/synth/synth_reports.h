// What steps of synth did to its mesh, in the summary and in lines on stderr.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "apps/program.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/finish/erosion.h"
#include "synthesis/mesh/even_mesh.h"

namespace astrolith {

// What the field leaves out of the recipe's layers, as "layers_left_out". `file` is the recipe's file;
// `is_patch` tells whether the field is meshed in a patch.
void report_layers_left_out(Program& program, const ImplicitField& field, const Recipe& recipe,
                            const std::filesystem::path& file, bool is_patch);

// What erosion did to a mesh of so many vertices.
void report_erosion(Program& program, const Erosion& erosion, const ErosionStatistics& done,
                    std::size_t vertices);

// What evening did to the triangles. `unit` is the recipe's length unit.
void report_even(Program& program, const EvenStatistics& done, const std::string& unit);

}  // namespace astrolith
