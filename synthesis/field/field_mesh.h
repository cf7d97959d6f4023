// Meshes of an ImplicitField and of a PatchField. The templates of synthesis/mesh/mesher.h are instantiated
// once for them. A file that includes this header need not compile the mesher, which takes about six seconds.
#pragma once

#include "synthesis/field/implicit_field.h"
#include "synthesis/field/patch_field.h"
#include "synthesis/mesh/even_mesh.h"
#include "synthesis/mesh/mesher.h"
#include "synthesis/mesh/surface_probes.h"

namespace astrolith {

extern template MeshStatistics mesh_field<kBlockCells>(const ImplicitField&, const Box&, int, MeshSink&,
                                                       const Progress&, MeshTile);
extern template MeshStatistics mesh_patch<kBlockCells>(const PatchField&, double, int, MeshSink&,
                                                       const Progress&);
extern template EvenStatistics even_mesh(const ImplicitField&, double, RecordedMesh&, const Progress&);
extern template EvenStatistics even_mesh(const PatchField&, double, RecordedMesh&, const Progress&);
extern template ProbeFigures probe_surface<kBlockCells>(const ImplicitField&, const ProbedMesh&, int);
extern template ProbeFigures probe_surface<kBlockCells>(const PatchField&, const ProbedMesh&, int);

// Meshes what a cube holds of a patch's surface. Its grid lies anywhere in the patch, and has a layer of
// cells below each lower side of the cube, as make_patch_grid() makes it. The mesh is open where the cube
// cuts it.
MeshStatistics mesh_part(const PatchField& field, const SampleGrid& grid, MeshSink& sink);

// A coarse mesh of a field, as a place for probes: whole, and of a patch. `made`, if given, gets its counts.
TriangleMesh make_coarse_mesh(const ImplicitField& field, int resolution, MeshStatistics* made = nullptr);
TriangleMesh make_coarse_mesh(const PatchField& field, double patch_size, int resolution,
                              MeshStatistics* made = nullptr);

}  // namespace astrolith
