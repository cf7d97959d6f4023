// What a repair did, in words and as fields of a summary.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tasks/repair/mesh_repair.h"

namespace astrolith {

// "stitched 412 edges, filled 3 holes (largest 2.1 % of the surface), nothing moved by more than 0.3 m". An
// empty `unit` gives the distance in percent of the diagonal. Empty where nothing was done and the mesh is
// one part.
std::string repair_words(const MeshRepair& repair, const std::string& unit,
                         const RepairOptions& options = {});

// Whether the mesh has several parts, of which the words say how they lie.
bool says_of_parts(const MeshRepair& repair);

// The fields repair.* of apps/summary_fields.json.
nlohmann::ordered_json repair_json(const MeshRepair& repair);

}  // namespace astrolith
