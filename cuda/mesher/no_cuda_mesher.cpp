// The meshers of a build without a CUDA compiler. Callers must ask probe_device() (cuda/device.h) first, so
// that they are never called.
#include "cuda/mesher/gpu_mesher.h"
#include "numerics/errors.h"

namespace astrolith {

MeshStatistics mesh_field_on_gpu(const ImplicitField&, const Box&, int, MeshSink&, const Progress&,
                                 MeshTile) {
  throw WorkError("GPU: this program was built without CUDA");
}

MeshStatistics mesh_patch_on_gpu(const PatchField&, double, int, MeshSink&, const Progress&) {
  throw WorkError("GPU: this program was built without CUDA");
}

}  // namespace astrolith
