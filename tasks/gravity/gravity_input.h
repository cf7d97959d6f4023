// The body of a file, and the parts that --density-of names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tasks/gravity/compute_gravity.h"
#include "tasks/gravity/gravity_body.h"
#include "tasks/job/job.h"
#include "tasks/repair/mesh_unit.h"
#include "tasks/repair/shape_repair.h"

namespace astrolith {

// The files of words such as FILE=DENSITY,FILE=DENSITY.
std::vector<std::filesystem::path> part_files(const std::vector<std::string>& words);

// Reads parts given as FILE=DENSITY,FILE=DENSITY. A file is a closed mesh in the body's unit and frame, or a
// recipe of that unit; `unit` is that of --unit, or empty. Throws InputError for a word of another form, a
// negative density, and a part whose box leaves that of the body. All bodies of a file count.
std::vector<BodyPart> read_parts(const Job& job, const std::string& words, const std::string& unit,
                                 const GravityBody& whole, double density, int resolution,
                                 ShapeRepair repair);

// Reads a shape model in `unit`, or a recipe (.json or .astro), which states its own unit and is meshed with
// `resolution` cells along its longest side. A mesh that is no closed body is repaired as `repair` says;
// `figures` are those of the repair. Throws InputError for files that are no closed body and cannot become
// one.
GravityBody read_gravity_body(const Job& job, const std::filesystem::path& file, const UnitChoice& unit,
                              int resolution, const ShapeRepair& repair, nlohmann::ordered_json& figures);

}  // namespace astrolith
