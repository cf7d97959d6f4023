// What the mesh of a recipe will take, from the estimate of its blocks and the costs of its uses.
#pragma once

#include <filesystem>

#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "tasks/prediction/mesh_cost.h"
#include "tasks/prediction/mesh_estimate.h"
#include "tasks/synthesis/mesh_region.h"

namespace astrolith {

// A mesh that is to be made.
struct PlannedMesh {
  const ImplicitField& field;
  const Recipe& recipe;
  Region region;
  std::filesystem::path output;  // its extension tells the format
  MeshUse use;
};

// The run that will make the mesh.
struct PlannedRun {
  int threads;           // 0 = all
  double seconds = 0.0;  // on the clock, that the run has taken before the mesh is predicted
};

struct MeshPrediction {
  double triangles = 0.0, file_bytes = 0.0, peak_bytes = 0.0, seconds = 0.0;
  double own_seconds = 0.0;      // that the prediction itself took
  double own_evaluations = 0.0;  // of the field, by the estimate of its blocks and triangles
};

// Predicts the mesh of this resolution. Memory and seconds are those of this process, with what it has taken
// so far. Throws what mesh_region throws.
MeshPrediction predict_mesh(const PlannedMesh& mesh, int resolution, const PlannedRun& run,
                            const EstimateBudget& budget);

// Throws InputError where a prediction needs more memory than these bytes.
void require_memory(const PlannedMesh& mesh, int resolution, const MeshPrediction& predicted, double limit);

}  // namespace astrolith
