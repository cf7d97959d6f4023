// The mesher on a GPU: mesh_field of synthesis/mesh/mesher.h, byte for byte.
#pragma once

#include "synthesis/field/implicit_field.h"
#include "synthesis/mesh/mesher.h"

namespace astrolith {

// Expects a field without obstacle_on_gpu() (gpu_obstacle.h). Throws as mesh_field
// does, and WorkError, with CUDA's words, when the device fails or has too little memory for one layer of
// blocks; see probe_device().
MeshStatistics mesh_field_on_gpu(const ImplicitField& field, const Box& bounds, int resolution,
                                 MeshSink& sink, const Progress& progress = {}, MeshTile tile = {});

}  // namespace astrolith
