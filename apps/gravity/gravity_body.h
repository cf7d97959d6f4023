// The body of a file.
#pragma once

#include <filesystem>
#include <string>

#include "apps/program.h"
#include "apps/shape_repair.h"
#include "tasks/gravity/gravity_body.h"

namespace astrolith {

// Reads a shape model, whose unit the caller states, or a recipe (.json or .astro), which states its own and
// is meshed with `resolution` cells along its longest side. An empty unit stands for that of the recipe, or
// km. A mesh that is no closed body is repaired as `repair` says; `figures` are those of the repair. Throws
// InputError for files that are no closed body and cannot become one.
GravityBody read_gravity_body(const Program& program, const std::filesystem::path& file,
                              const std::string& unit, int resolution, const ShapeRepair& repair,
                              nlohmann::ordered_json& figures);

}  // namespace astrolith
