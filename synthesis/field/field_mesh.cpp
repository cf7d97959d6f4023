#include "synthesis/field/field_mesh.h"

namespace astrolith {

MeshStatistics mesh_field(const ImplicitField& field, const Box& bounds, int resolution, MeshSink& sink,
                          const Progress& progress, MeshTile tile) {
  return mesh_field<kBlockCells>(field, bounds, resolution, sink, progress, tile);
}

MeshStatistics mesh_patch(const PatchField& field, double size, int resolution, MeshSink& sink,
                          const Progress& progress) {
  return mesh_patch<kBlockCells>(field, size, resolution, sink, progress);
}

MeshEstimate sample_field(const ImplicitField& field, const Box& bounds, int resolution, MeshTile tile,
                          const SampleSize& size) {
  return sample_field<kBlockCells>(field, bounds, resolution, tile, size);
}

MeshEstimate sample_patch(const PatchField& field, double patch_size, int resolution,
                          const SampleSize& size) {
  return sample_patch<kBlockCells>(field, patch_size, resolution, size);
}

}  // namespace astrolith
