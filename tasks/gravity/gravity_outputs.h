// The tables and pictures that gravity writes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tasks/gravity/gravity_body.h"
#include "tasks/gravity/gravity_table.h"
#include "tasks/gravity/landing_sites.h"
#include "tasks/job/job.h"
#include "tasks/job/picture_options.h"

namespace astrolith {

// .csv: a line of names and then numbers that read back as the same doubles; .npy: (points x columns)
// float64; .ply: the mesh with the columns behind z as properties of its vertices.
void write_gravity(const std::vector<GravityColumn>& columns, const GravityBody& body,
                   const std::filesystem::path& file, const std::string& tool);

// The mesh in the colours of one column, which has a value for each vertex, or for each facet. Sites, if any,
// are orange, and the first nine are each seen from above unless there are cameras.
void write_gravity_preview(const Job& job, const GravityBody& body, const GravityColumn& column,
                           const std::vector<LandingSite>& sites, const PictureOptions& look,
                           const std::filesystem::path& file);

}  // namespace astrolith
