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
  // The distances of the histograms of both surfaces, evened at as many points each
  // (descriptor/surface/evened_surface.h), and the similarities of two samplings of each mesh, as a floor:
  // more cannot be expected. Then those of the surfaces as they stand, or with b moved onto a. Neither is
  // scaled. Distances are fractions of the diagonal of a's box, but for those "in_units_of_the_files".
  nlohmann::ordered_json figures;
  std::vector<std::string> remarks;  // on the meshes, with their names
};

struct ComparisonOptions {
  DescriptionOptions description;
  std::int64_t samples = 100000;  // of each surface, for the distances between them
  bool align = false;  // moves and turns b onto a before distances are measured; "alignment" says how
};

// Compares two meshes. Throws InputError for a mesh without area, and WorkError when progress asks to stop.
Comparison compare_meshes(const NamedMesh& a, const NamedMesh& b, const ComparisonOptions& options,
                          const StageProgress& progress);

}  // namespace astrolith
