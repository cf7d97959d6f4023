// Layers that a mesh cannot show, in synth's summary and on stderr.
#pragma once

#include <filesystem>

#include "apps/program.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {

// Lists what the field leaves out of its layers as "layers_left_out" in the summary, and says so in one line
// on stderr. `file` is the recipe's file; `is_patch` tells whether the field is meshed in a patch.
void report_layers_left_out(Program& program, const ImplicitField& field, const Recipe& recipe,
                            const std::filesystem::path& file, bool is_patch);

}  // namespace astrolith
