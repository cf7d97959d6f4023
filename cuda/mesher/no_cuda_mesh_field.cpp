// The mesher of a build that found no CUDA compiler: calling it is an error of the caller, who did not probe.
#include "cuda/mesher/mesh_field.h"
#include "numerics/errors.h"

namespace astrolith {

MeshStatistics mesh_field_on_gpu(const ImplicitField&, const Box&, int, MeshSink&, const Progress&,
                                 MeshTile) {
  throw WorkError("GPU: this program was built without CUDA");
}

}  // namespace astrolith
