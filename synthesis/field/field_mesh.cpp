#include "synthesis/field/field_mesh.h"

#include <utility>

namespace astrolith {
namespace {

// Coarse meshes have smaller blocks, whose lists of craters and boulders are shorter.
constexpr int kCoarseBlockCells = 4;

}  // namespace

template MeshStatistics mesh_field<kBlockCells>(const ImplicitField&, const Box&, int, MeshSink&,
                                                const Progress&, MeshTile);
template MeshStatistics mesh_patch<kBlockCells>(const PatchField&, double, int, MeshSink&, const Progress&);
template EvenStatistics even_mesh(const ImplicitField&, double, RecordedMesh&, const Progress&);
template EvenStatistics even_mesh(const PatchField&, double, RecordedMesh&, const Progress&);
template ProbeFigures probe_surface<kBlockCells>(const ImplicitField&, const ProbedMesh&, int);
template ProbeFigures probe_surface<kBlockCells>(const PatchField&, const ProbedMesh&, int);

MeshStatistics mesh_part(const PatchField& field, const SampleGrid& grid, MeshSink& sink) {
  return LayeredMesher<kBlockCells, PatchField>(field, {grid, patch_window(grid), false}, sink).run({});
}

TriangleMesh make_coarse_mesh(const ImplicitField& field, int resolution, MeshStatistics* made) {
  MeshCollector collector;
  const MeshStatistics statistics =
      mesh_field<kCoarseBlockCells>(field, field.bounds(), resolution, collector);
  if (made != nullptr) *made = statistics;
  return std::move(collector.mesh);
}

TriangleMesh make_coarse_mesh(const PatchField& field, double patch_size, int resolution,
                              MeshStatistics* made) {
  MeshCollector collector;
  const MeshStatistics statistics = mesh_patch<kCoarseBlockCells>(field, patch_size, resolution, collector);
  if (made != nullptr) *made = statistics;
  return std::move(collector.mesh);
}

}  // namespace astrolith
