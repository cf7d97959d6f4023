// Meshes of an ImplicitField and of a PatchField. These functions instantiate the templates of
// synthesis/mesh/mesher.h once. A file that includes this header need not compile the mesher, which takes
// about six seconds.
#pragma once

#include "synthesis/field/implicit_field.h"
#include "synthesis/field/patch_field.h"
#include "synthesis/mesh/even_mesh.h"
#include "synthesis/mesh/mesher.h"
#include "synthesis/mesh/surface_probes.h"

namespace astrolith {

MeshStatistics mesh_field(const ImplicitField& field, const Box& bounds, int resolution, MeshSink& sink,
                          const Progress& progress = {}, MeshTile tile = {});

MeshStatistics mesh_patch(const PatchField& field, double size, int resolution, MeshSink& sink,
                          const Progress& progress = {});

// Makes the triangles of such a mesh, whose cells have this side, more even (synthesis/mesh/even_mesh.h).
EvenStatistics even_mesh(const ImplicitField& field, double step, RecordedMesh& mesh,
                         const Progress& progress = {});
EvenStatistics even_mesh(const PatchField& field, double step, RecordedMesh& mesh,
                         const Progress& progress = {});

// A coarse mesh of a field, as a place for probes: whole, and of a patch. `made`, if given, gets its counts.
TriangleMesh coarse_mesh_of(const ImplicitField& field, int resolution, MeshStatistics* made = nullptr);
TriangleMesh coarse_mesh_of(const PatchField& field, double patch_size, int resolution,
                            MeshStatistics* made = nullptr);

// The mean of `count` probes of a mesh (synthesis/mesh/surface_probes.h).
ProbeFigures probe_surface(const ImplicitField& field, const ProbedMesh& mesh, int count);
ProbeFigures probe_surface(const PatchField& field, const ProbedMesh& mesh, int count);

}  // namespace astrolith
