// The mesh of a recipe's body: whole, a tile or a patch, checked to be a closed manifold.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "numerics/progress.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/mesh/manifold_check.h"
#include "tasks/synth/mesh_region.h"

namespace astrolith {

struct BodyMeshJob {
  const Recipe& recipe;
  const ImplicitField& field;         // of the recipe
  const std::filesystem::path& file;  // the recipe's file, for messages
  const Region& region;
  int resolution;                // cells along the longest side of the body, or of the patch
  double least_component = 0.0;  // share of the largest piece's volume that a piece needs; 0: all stay
  MeshingDevice device = MeshingDevice::kCpu;
  bool may_be_empty = false;  // a tile need not hold any of the surface
  bool even = false;          // triangles are made more even, for which the mesh is kept in memory
};

struct BodyMeshReport {
  MeshStatistics statistics;
  ManifoldReport manifold;
  std::int64_t dropped_components = 0;  // pieces and cavities that were too small
  std::optional<EvenStatistics> even;   // where triangles were made more even
};

// Passes the mesh on to the sink. The mesh is made twice where small pieces are left out; the stages are then
// "pieces" and "mesh", else "mesh" alone, and "even" may follow. Throws InputError for a region without
// surface, unless it may be empty, and WorkError for a mesh that is not manifold, or open elsewhere than
// where it was cut; the sink has been filled by then.
BodyMeshReport make_body_mesh(const BodyMeshJob& job, MeshSink& sink, const StageProgress& progress);

// Throws InputError for a recipe of layers alone. `file` is the recipe's.
void require_body(const Recipe& recipe, const std::filesystem::path& file);

// The field of a recipe's body in a region. Throws InputError for a body that no point of space reaches, and
// what ImplicitField throws.
ImplicitField field_of_region(const Recipe& recipe, const std::filesystem::path& file, const Region& region,
                              const Progress& progress = {});

}  // namespace astrolith
