// The body to fit of a mesh that may need a repair.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "estimation/shape/target/target_body.h"
#include "numerics/progress.h"
#include "tasks/repair/mesh_repair.h"

namespace astrolith {

struct RepairedTarget {
  TargetBody target;
  std::vector<std::string> words;  // what the repair did, in lengths of `unit`
  nlohmann::ordered_json figures;  // the fields repair.*; null where nothing was done
};

// Repairs the mesh, unless `strict`, and prepares it. Where it then passes through itself, it is repaired
// once more. Throws what repair_mesh and prepare_target throw.
RepairedTarget repaired_target(TriangleMesh mesh, const std::string& name, const std::string& unit,
                               bool strict, RepairOptions options, const Progress& repairing,
                               const Progress& preparing);

}  // namespace astrolith
