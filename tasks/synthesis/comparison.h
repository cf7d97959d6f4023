// How alike two shapes are, and how far apart their surfaces lie.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "descriptor/shape_description.h"
#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

// A mesh and what messages call it.
struct NamedMesh {
  const std::string& name;
  const TriangleMesh& mesh;
};

// The check takes an assertion in the move constructor of nlohmann's JSON for an exception.
// NOLINTNEXTLINE(bugprone-exception-escape)
struct Comparison {
  // The distances of the histograms, then those of the surfaces as they stand: neither is moved, turned or
  // scaled. Distances are fractions of the diagonal of a's box, but for those "in_units_of_the_files".
  nlohmann::ordered_json figures;
  std::vector<std::string> remarks;  // on the meshes, with their names
};

// Compares two meshes. `samples` points of each surface measure the distances between them. `with_floor` adds
// the similarities of two samplings of each mesh: more cannot be expected. Throws InputError for a mesh
// without area, and WorkError when progress asks to stop.
Comparison compare_meshes(const NamedMesh& a, const NamedMesh& b, const DescriptionOptions& options,
                          std::int64_t samples, bool with_floor, const StageProgress& progress);

}  // namespace astrolith
