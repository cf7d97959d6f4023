// Reads the parts that --density-of names.
#pragma once

#include <string>
#include <vector>

#include "tasks/gravity/body_parts.h"
#include "tasks/job/job.h"
#include "tasks/repair/shape_repair.h"

namespace astrolith {

// The files of words such as FILE=DENSITY,FILE=DENSITY.
std::vector<std::filesystem::path> files_of_parts(const std::vector<std::string>& words);

// Reads parts given as FILE=DENSITY,FILE=DENSITY. A file is a closed mesh in the body's unit and frame, or a
// recipe of that unit; `unit` is that of --unit, or empty. Throws InputError for a word of another form, a
// negative density, and a part whose box leaves that of the body. All bodies of a file count.
std::vector<BodyPart> read_parts(const Job& job, const std::string& words, const std::string& unit,
                                 const GravityBody& whole, double density, int resolution,
                                 ShapeRepair repair);

}  // namespace astrolith
