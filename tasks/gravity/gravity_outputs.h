// The tables and pictures that gravity writes.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tasks/gravity/gravity_body.h"
#include "tasks/gravity/gravity_table.h"
#include "tasks/gravity/landing_sites.h"
#include "tasks/job/job.h"
#include "tasks/job/picture_options.h"

namespace astrolith {

// .csv: a line of names and then numbers that read back as the same doubles; .npy: (points x columns)
// float64; .ply: the mesh with the columns behind z as properties of its vertices; .vtp: the mesh with them
// as values of its facets or vertices.
void write_gravity(const std::vector<GravityColumn>& columns, const GravityBody& body, bool at_facets,
                   const std::filesystem::path& file, const std::string& tool);

// The harmonics of the figures of compute_gravity(), 4 pi normalised: .gfc (ICGEM; m and m3/s2) or .sha and
// .tab (SHADR of the Planetary Data System; km and km3/s2, no row of degree 0).
void write_harmonics(const nlohmann::ordered_json& figures, const std::filesystem::path& file,
                     const std::string& name);

// The mesh in the colours of one column, which has a value for each vertex, or for each facet. Sites, if any,
// are orange, and the first nine are each seen from above unless there are cameras.
void write_gravity_preview(const Job& job, const GravityBody& body, const GravityColumn& column,
                           const std::vector<LandingSite>& sites, const PictureOptions& look,
                           const std::filesystem::path& file);

}  // namespace astrolith
