// What the mesh of a recipe will take: its estimate, and constants for each triangle of its uses.
#pragma once

#include <filesystem>

#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "tasks/synth/mesh_estimate.h"
#include "tasks/synth/mesh_region.h"

namespace astrolith {

// The uses of a mesh that cost more than the mesh.
struct MeshUse {
  bool preview = false;
  bool erosion = false;
  bool twice = false;  // small pieces are left out, for which the mesh is made twice
  bool gravity = false;
  bool labels = false;
  bool texture_coordinates = false;
  bool even = false;
  int map_side = 0;  // of maps that are baked, texels; 0: none
};

// A mesh that is to be made.
struct PlannedMesh {
  const ImplicitField& field;
  const Recipe& recipe;
  Region region;
  std::filesystem::path output;  // its extension tells the format
  MeshUse use;
  MeshingDevice device = MeshingDevice::kCpu;  // that counts small meshes
};

// The run that will make the mesh.
struct PlannedRun {
  int threads;  // 0 = all
  // What the run has taken before the mesh is predicted.
  double clock_seconds = 0.0, processor_seconds = 0.0;
  bool goes_on = false;  // this process makes the mesh next, with the memory that the prediction has taken
};

struct MeshPrediction {
  int resolution = 0;
  double triangles = 0.0, file_bytes = 0.0, peak_bytes = 0.0;
  double seconds = 0.0;            // on the clock, with all threads on cores that do nothing else
  double processor_seconds = 0.0;  // of all threads together
  double own_seconds = 0.0;        // of all threads together, that the prediction itself took
  double own_evaluations = 0.0;    // of the field, by the estimate
};

// Predicts the mesh of this resolution, or of about so many triangles where these are above 0. Memory and
// seconds are those of this process, with what it has taken so far. Throws what MeshEstimator throws.
MeshPrediction predict_mesh(const PlannedMesh& mesh, int resolution, double triangles, const PlannedRun& run);

// Throws InputError where a prediction needs more memory than these bytes.
void require_memory(const PlannedMesh& mesh, const MeshPrediction& predicted, double limit);

}  // namespace astrolith
