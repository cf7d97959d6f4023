// Meshes of an ImplicitField and of a PatchField. These functions instantiate the templates of
// synthesis/mesh/mesher.h once. A file that includes this header need not compile the mesher, which takes
// about six seconds.
#pragma once

#include "synthesis/field/implicit_field.h"
#include "synthesis/field/patch_field.h"
#include "synthesis/mesh/mesh_sample.h"
#include "synthesis/mesh/mesher.h"

namespace astrolith {

MeshStatistics mesh_field(const ImplicitField& field, const Box& bounds, int resolution, MeshSink& sink,
                          const Progress& progress = {}, MeshTile tile = {});

MeshStatistics mesh_patch(const PatchField& field, double size, int resolution, MeshSink& sink,
                          const Progress& progress = {});

// The estimates of these meshes from samples of their blocks (synthesis/mesh/mesh_sample.h).
MeshEstimate sample_field(const ImplicitField& field, const Box& bounds, int resolution, MeshTile tile,
                          const SampleSize& size);
MeshEstimate sample_patch(const PatchField& field, double patch_size, int resolution, const SampleSize& size);

}  // namespace astrolith
