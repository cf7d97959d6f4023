// The body of a file.
#pragma once

#include <filesystem>
#include <string>

#include "tasks/gravity/gravity_body.h"
#include "tasks/job/job.h"
#include "tasks/repair/mesh_unit.h"
#include "tasks/repair/shape_repair.h"

namespace astrolith {

// Reads a shape model in `unit`, or a recipe (.json or .astro), which states its own unit and is meshed with
// `resolution` cells along its longest side. A mesh that is no closed body is repaired as `repair` says;
// `figures` are those of the repair. Throws InputError for files that are no closed body and cannot become
// one.
GravityBody read_gravity_body(const Job& job, const std::filesystem::path& file, const UnitChoice& unit,
                              int resolution, const ShapeRepair& repair, nlohmann::ordered_json& figures);

}  // namespace astrolith
