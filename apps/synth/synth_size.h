// The resolution of synth's mesh, and the memory it needs.
#pragma once

#include <filesystem>

#include "apps/program.h"
#include "tasks/prediction/mesh_prediction.h"

namespace astrolith {

struct MeshSizeRequest {
  int resolution = 256;
  double triangles = 0.0;      // 0 = as the resolution gives
  double max_memory_gb = 0.0;  // 0 = three quarters of the machine's
  bool only_predict = false;
};

void declare_size_options(Program& program, MeshSizeRequest& request);

// Returns the cells along the longest side. Large meshes are announced with triangles, bytes and seconds,
// and stand as "predicted" in the summary. Throws InputError when the mesh needs more memory than allowed.
int choose_resolution(Program& program, const MeshSizeRequest& request, const PlannedMesh& mesh);

// Throws the InputError of a mesh that took more memory than predicted, and more than allowed.
[[noreturn]] void fail_memory(const Program& program, const MeshSizeRequest& request,
                              const std::filesystem::path& output);

}  // namespace astrolith
