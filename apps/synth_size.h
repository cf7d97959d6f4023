// How fine synth's mesh is to be, and whether there is room for it.
#pragma once

#include <filesystem>

#include "apps/program.h"
#include "synthesis/implicit_field.h"

namespace astrolith {

struct MeshSizeRequest {
  int resolution = 256;
  double triangles = 0.0;      // 0 = as the resolution gives
  double max_memory_gb = 0.0;  // 0 = three quarters of the machine's
};

void declare_size_options(Program& program, MeshSizeRequest& request);

// Cells along the longest side. `tiles` is how many slabs the mesh is cut into, of which one is made. Large
// meshes are announced with triangles, bytes and seconds, and stand as "predicted" in the summary. Throws
// InputError when the mesh needs more memory than allowed.
int choose_resolution(Program& program, const MeshSizeRequest& request, const ImplicitField& field,
                      const std::filesystem::path& output, bool preview, int tiles);

}  // namespace astrolith
