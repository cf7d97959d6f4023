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
  int threads;  // 0 = all
  // What the run has taken before the mesh is predicted.
  double clock_seconds = 0.0, processor_seconds = 0.0;
  bool goes_on = false;  // this process makes the mesh next, with the memory that the prediction has taken
};

struct MeshPrediction {
  double triangles = 0.0, file_bytes = 0.0, peak_bytes = 0.0;
  double seconds = 0.0;            // on the clock, with all threads on cores that do nothing else
  double processor_seconds = 0.0;  // of all threads together
  double own_seconds = 0.0;        // that the prediction itself took
  double own_evaluations = 0.0;    // of the field, by the estimate of its blocks and triangles
};

// What a prediction may take. The figures that a user asks for are worth 3 % of the mesh and at least some 30
// milliseconds. Figures that guard the memory of a mesh should hardly keep it waiting.
inline constexpr EstimateBudget kForFigures{0.025, 0.01, 96, 32, 32, 0.1},
    kForMemory{0.015, 0.01, 24, 2, 12, 0.03};

// Predicts the mesh of this resolution. Memory and seconds are those of this process, with what it has taken
// so far. Throws what mesh_region throws.
MeshPrediction predict_mesh(const PlannedMesh& mesh, int resolution, const PlannedRun& run,
                            const EstimateBudget& budget);

// Throws InputError where a prediction needs more memory than these bytes.
void require_memory(const PlannedMesh& mesh, int resolution, const MeshPrediction& predicted, double limit);

}  // namespace astrolith
