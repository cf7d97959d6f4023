#include "cuda/mesher/gpu_mesher.h"

#include "cuda/device_backend.h"
#include "cuda/mesher/backend_mesher.h"

namespace astrolith {

MeshStatistics mesh_field_on_gpu(const ImplicitField& field, const Box& bounds, int resolution,
                                 MeshSink& sink, const Progress& progress, MeshTile tile) {
  DeviceBackend backend;
  return mesh_field_on(backend, field, bounds, resolution, sink, progress, tile);
}

MeshStatistics mesh_patch_on_gpu(const PatchField& field, double size, int resolution, MeshSink& sink,
                                 const Progress& progress) {
  DeviceBackend backend;
  return mesh_patch_on(backend, field, size, resolution, sink, progress);
}

}  // namespace astrolith
