// The body of a file.
#pragma once

#include <filesystem>
#include <string>

#include "apps/program.h"
#include "tasks/gravity/gravity_body.h"

namespace astrolith {

// Reads a shape model, whose unit the caller states, or a recipe (.json or .astro), which states its own and
// is meshed with `resolution` cells along its longest side. An empty unit stands for that of the recipe, or
// km. Throws InputError for files that are no closed body.
GravityBody read_gravity_body(const Program& program, const std::filesystem::path& file,
                              const std::string& unit, int resolution);

}  // namespace astrolith
