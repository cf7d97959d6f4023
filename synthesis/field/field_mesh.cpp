#include "synthesis/field/field_mesh.h"

#include <utility>

namespace astrolith {
namespace {

// Coarse meshes have smaller blocks, whose lists of craters and boulders are shorter.
constexpr int kCoarseBlockCells = 4;

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

ProbeFigures probe_surface(const ImplicitField& field, const ProbedMesh& mesh, int count) {
  return probe_surface<kBlockCells>(field, mesh, count);
}

ProbeFigures probe_surface(const PatchField& field, const ProbedMesh& mesh, int count) {
  return probe_surface<kBlockCells>(field, mesh, count);
}

}  // namespace astrolith
