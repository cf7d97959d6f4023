// The resolution of synth's mesh, and the memory it needs.
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

// The uses of a mesh that need it in memory, and the noise that its prediction leaves out.
struct MeshUse {
  bool preview = false;
  bool erosion = false;
  bool gabor_noise = false;
};

void declare_size_options(Program& program, MeshSizeRequest& request);

// Returns the cells along the longest side. `mesh` makes the mesh at a resolution and discards it. `tiles` is
// the number of slabs that the mesh is cut into; one of them is made. Large meshes are announced with
// triangles, bytes and seconds, and stand as "predicted" in the summary. Throws InputError when the mesh
// needs more memory than allowed.
int choose_resolution(Program& program, const MeshSizeRequest& request,
                      const std::function<MeshStatistics(int resolution)>& mesh,
                      const std::filesystem::path& output, MeshUse use, int tiles);

}  // namespace astrolith
