// What a mesh will take: its estimate, and constants for each triangle of what becomes of it.
#pragma once

#include "tasks/job/job.h"
#include "tasks/synth/mesh_estimate.h"
#include "tasks/synth/mesh_job.h"

namespace astrolith {

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

// Predicts the mesh of a part of the body with the resolution or the triangles of its spec. Memory and
// seconds are those of this process, with what it has taken so far. Throws what MeshEstimator throws.
MeshPrediction predict_mesh(const MeshJob& mesh, const MeshPart& part, const PlannedRun& run);

// Throws InputError where a prediction needs more memory than these bytes.
void require_memory(const MeshJob& mesh, const Recipe& recipe, const MeshPrediction& predicted, double limit);

// Returns the cells along the longest side. Large meshes are announced with triangles, bytes and seconds,
// and stand as "predicted" in the summary. Throws InputError when the mesh needs more memory than allowed.
int choose_resolution(Job& job, const MeshJob& mesh, const MeshPart& part);

// Throws the InputError of a mesh that took more memory than predicted, and more than allowed.
[[noreturn]] void fail_memory(const Job& job, const MeshJob& mesh);

}  // namespace astrolith
