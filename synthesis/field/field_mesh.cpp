#include "synthesis/field/field_mesh.h"

#include <utility>

namespace astrolith {
namespace {

// Coarse meshes have smaller blocks, whose lists of craters and boulders are shorter.
constexpr int kCoarseBlockCells = 4;

template <BlockField Field>
void probe_mesh(const Field& field, const ProbedMesh& mesh, int first, int count, ProbeSums& sums) {
  SurfaceProber<kBlockCells, Field>(field, mesh.surface, mesh.step, mesh.reach, mesh.with_neighbour,
                                    mesh.warm_up, mesh.costs)
      .add(first, count, sums);
}

}  // namespace

MeshStatistics mesh_field(const ImplicitField& field, const Box& bounds, int resolution, MeshSink& sink,
                          const Progress& progress, MeshTile tile) {
  return mesh_field<kBlockCells>(field, bounds, resolution, sink, progress, tile);
}

MeshStatistics mesh_patch(const PatchField& field, double size, int resolution, MeshSink& sink,
                          const Progress& progress) {
  return mesh_patch<kBlockCells>(field, size, resolution, sink, progress);
}

EvenStatistics even_mesh(const ImplicitField& field, double step, RecordedMesh& mesh,
                         const Progress& progress) {
  return even_mesh<ImplicitField>(field, step, mesh, progress);
}

EvenStatistics even_mesh(const PatchField& field, double step, RecordedMesh& mesh, const Progress& progress) {
  return even_mesh<PatchField>(field, step, mesh, progress);
}

MeshEstimate sample_field(const ImplicitField& field, const Box& bounds, int resolution, MeshTile tile,
                          const SampleSize& size) {
  return sample_field<kBlockCells>(field, bounds, resolution, tile, size);
}

MeshEstimate sample_patch(const PatchField& field, double patch_size, int resolution,
                          const SampleSize& size) {
  return sample_patch<kBlockCells>(field, patch_size, resolution, size);
}

TriangleMesh coarse_mesh_of(const ImplicitField& field, int resolution, MeshStatistics* made) {
  MeshCollector collector;
  const MeshStatistics statistics =
      mesh_field<kCoarseBlockCells>(field, field.bounds(), resolution, collector);
  if (made != nullptr) *made = statistics;
  return std::move(collector.mesh);
}

TriangleMesh coarse_mesh_of(const PatchField& field, double patch_size, int resolution,
                            MeshStatistics* made) {
  MeshCollector collector;
  const MeshStatistics statistics = mesh_patch<kCoarseBlockCells>(field, patch_size, resolution, collector);
  if (made != nullptr) *made = statistics;
  return std::move(collector.mesh);
}

void probe(const ImplicitField& field, const ProbedMesh& mesh, int first, int count, ProbeSums& sums) {
  probe_mesh(field, mesh, first, count, sums);
}

void probe(const PatchField& field, const ProbedMesh& mesh, int first, int count, ProbeSums& sums) {
  probe_mesh(field, mesh, first, count, sums);
}

}  // namespace astrolith
