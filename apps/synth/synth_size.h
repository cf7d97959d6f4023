// How fine synth's mesh is to be, and whether there is room for it.
#pragma once

#include <filesystem>
#include <functional>

#include "apps/program.h"
#include "synthesis/mesh/mesher.h"

namespace astrolith {

struct MeshSizeRequest {
  int resolution = 256;
  double triangles = 0.0;      // 0 = as the resolution gives
  double max_memory_gb = 0.0;  // 0 = three quarters of the machine's
  bool only_predict = false;
};

// What a mesh is held in memory for, and what its prediction leaves out.
struct MeshUse {
  bool preview = false;
  bool erosion = false;
  bool gabor_noise = false;
};

void declare_size_options(Program& program, MeshSizeRequest& request);

// Cells along the longest side; `mesh` makes the mesh at one number of them, to no avail. `tiles` is how many
// slabs the mesh is cut into, of which one is made. Large meshes are announced with triangles, bytes and
// seconds, and stand as "predicted" in the summary. Throws InputError when the mesh needs more memory than
// allowed.
int choose_resolution(Program& program, const MeshSizeRequest& request,
                      const std::function<MeshStatistics(int resolution)>& mesh,
                      const std::filesystem::path& output, MeshUse use, int tiles);

}  // namespace astrolith
